// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <iostream>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/evaluation/learning_tables.h"
#include "cartographer_sdf/evaluation/match_table.h"
#include "cartographer_sdf/loop_closing/described_map.h"
#include "cartographer_sdf/loop_closing/loop_closing.h"
#include "cartographer_sdf/loop_closing/selection_between.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/stages.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"

DEFINE_string(method, "",
              "sdf or paper; if empty, that of the configuration file. paper "
              "reads paper.lua unless --configuration_basename is given.");
DEFINE_string(terms, "",
              "The file to write the terms of every pair's score to. Only "
              "method sdf.");
DEFINE_bool(agree, false,
            "Whether accepted matches must agree with each other, as in "
            "close_loops. Only method sdf.");

DEFINE_bool(retrieval, false,
            "Match only those pairs of submaps that an index of all features "
            "proposes: much faster on large maps, at the price of some pairs.");

namespace cartographer_sdf {
namespace {

absl::StatusOr<Options> LoadOptionsOfMethod() {
  if (FLAGS_method == "paper" &&
      gflags::GetCommandLineFlagInfoOrDie("configuration_basename")
          .is_default) {
    FLAGS_configuration_basename = "paper.lua";
  }
  absl::StatusOr<Options> options = LoadOptionsOfFlags();
  if (!options.ok() || FLAGS_method.empty()) return options;
  if (FLAGS_method == "sdf") {
    options->loop_closing.match.method = Method::kSdf;
  } else if (FLAGS_method == "paper") {
    options->loop_closing.match.method = Method::kPaper;
  } else {
    return UsageError(
        absl::StrCat("--method must be sdf or paper, it is ", FLAGS_method));
  }
  return options;
}

// Takes back the acceptance of rows whose matches the others do not bear out.
// `query` is absent where a map is matched with itself.
void RefuseInconsistent(const ConsistencyOptions& options, const MapState& map,
                        const std::optional<MapState>& query,
                        const std::vector<Match>& matches,
                        std::vector<MatchRow>* const rows) {
  std::vector<LoopClosure> closures;
  std::vector<MatchRow*> closure_rows;
  for (size_t k = 0; k < matches.size(); ++k) {
    if (!(*rows)[k].accepted) continue;
    closures.push_back(matches[k].closure);
    closure_rows.push_back(&(*rows)[k]);
  }
  const std::vector<SelectionResult> results =
      query ? SelectConsistentBetween(options, map, *query, closures)
            : SelectConsistent(options, OdometryPoses(map), closures);
  for (size_t k = 0; k < results.size(); ++k) {
    if (results[k].selection == Selection::kSelected) continue;
    closure_rows[k]->accepted = false;
    closure_rows[k]->verdict = SelectionName(results[k].selection);
  }
}

absl::Status RunMatch() {
  const absl::StatusOr<Options> options = LoadOptionsOfMethod();
  if (!options.ok()) return options.status();
  if (options->loop_closing.match.method != Method::kSdf &&
      (FLAGS_agree || !FLAGS_terms.empty())) {
    return UsageError("--agree and --terms need method sdf");
  }
  const absl::StatusOr<int> num_threads = NumThreadsOfFlags();
  if (!num_threads.ok()) return num_threads.status();
  const LoopClosingOptions& stages = options->loop_closing;
  const Executor executor = MakeExecutor(*num_threads);
  const std::optional<RetrievalOptions> retrieval =
      FLAGS_retrieval ? std::make_optional(stages.retrieval) : std::nullopt;
  StageProgress progress;
  const absl::StatusOr<DescribedMap> map = DescribeMapOfFlags(
      *options, FLAGS_input, executor, progress.Begin("read and describe"));
  if (!map.ok()) return map.status();
  std::vector<Match> matches;
  std::optional<MapState> query_state;
  if (FLAGS_query.empty()) {
    matches =
        MatchWithin(stages.match, retrieval, map->places, stages.min_index_gap,
                    executor, progress.Begin("match and verify"));
  } else {
    absl::StatusOr<DescribedMap> query =
        DescribeMap(stages.place, stages.match, FLAGS_query, executor,
                    progress.Begin("read and describe"));
    if (!query.ok()) return query.status();
    matches = MatchBetween(stages.match, retrieval, map->places, query->places,
                           executor, progress.Begin("match and verify"));
    query_state = std::move(query->state);
  }
  std::vector<MatchRow> rows;
  for (const Match& match : matches) {
    rows.push_back(ToRow(match, match.verdict == Verdict::kAccepted,
                         VerdictName(match.verdict)));
  }
  if (FLAGS_agree) {
    RefuseInconsistent(stages.consistency, map->state, query_state, matches,
                       &rows);
  }
  if (const absl::Status status = WriteMatches(FLAGS_output, rows);
      !status.ok()) {
    return status;
  }
  if (!FLAGS_terms.empty()) {
    const absl::Status status = WriteScoreTerms(FLAGS_terms, matches);
    if (!status.ok()) return status;
  }
  const auto num_accepted =
      std::count_if(rows.begin(), rows.end(),
                    [](const MatchRow& row) { return row.accepted; });
  std::cout << rows.size() << " pairs of submaps with a pose, " << num_accepted
            << " accepted: " << FLAGS_output << "\n";
  return absl::OkStatus();
}

}  // namespace

Subcommand MatchSubcommand() {
  return Subcommand{
      "match",
      "the submaps of one or two maps that show the same place",
      "--input A.pbstream [--query B.pbstream] --output M.csv "
      "[--method sdf|paper] [--retrieval] [--places P.places] [--agree]",
      "Matches every pair of submaps without a pose prior and writes the best "
      "pose of each pair for which there is one, accepted or not, with its "
      "evidence. Nothing is optimised.\n\n"
      "The columns x, y, yaw are the pose of the query submap in the frame of "
      "the reference submap [m, rad]; a higher score is more certain (sdf: "
      "log-odds of being right; paper: number of inliers).\n\n"
      "With --agree, an accepted match that weightier ones contradict by the "
      "odometry between them, or that is uncertain and stands alone, is "
      "accepted no more, and its verdict says which.",
      {"input", "output"},
      {"query", "method", "retrieval", "places", "agree", "terms",
       "configuration_directory", "configuration_basename", "threads"},
      &RunMatch};
}

}  // namespace cartographer_sdf
