// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <iostream>
#include <map>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/evaluation/learning_tables.h"
#include "cartographer_sdf/evaluation/match_table.h"
#include "cartographer_sdf/evaluation/shape_context.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/loop_closing/described_map.h"
#include "cartographer_sdf/loop_closing/loop_closing.h"
#include "cartographer_sdf/loop_closing/neighbours.h"
#include "cartographer_sdf/loop_closing/selection_between.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/method_options.h"
#include "cartographer_sdf/tools/stages.h"
#include "cartographer_sdf/tools/subcommand.h"

DEFINE_string(
    method, "",
    "sdf, paper or shape_context; if empty, that of the configuration "
    "file. paper reads paper.lua, shape_context shape_context.lua, "
    "unless --configuration_basename is given.");
DEFINE_string(options_in_force, "",
              "The file to write all options to that the matches were made "
              "with, as Lua.");
DEFINE_string(terms, "",
              "The file to write the terms of every pair's score to. Only "
              "method sdf.");
DEFINE_string(neighbour_terms, "",
              "The file to write the terms of every pair's score in its "
              "neighbourhood to. Only method sdf, not with --alone.");
DEFINE_bool(alone, false,
            "Judge each pair of submaps by itself, without its neighbours. "
            "Only method sdf.");
DEFINE_bool(agree, false,
            "Whether accepted matches must agree with each other, as in "
            "close_loops. Only method sdf.");

DEFINE_bool(retrieval, false,
            "Match only those pairs of submaps that an index of all features "
            "proposes: much faster on large maps, at the price of some pairs.");

namespace cartographer_sdf {
namespace {

// Takes back the acceptance of rows whose matches the others do not bear out.
// `query` is null where a map is matched with itself.
void RefuseInconsistent(const ConsistencyOptions& options, const MapState& map,
                        const MapState* const query,
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
      query != nullptr
          ? SelectConsistentBetween(options, map, *query, closures)
          : SelectConsistent(options, OdometryPoses(map), closures);
  for (size_t k = 0; k < results.size(); ++k) {
    if (results[k].selection == Selection::kSelected) continue;
    closure_rows[k]->accepted = false;
    closure_rows[k]->verdict = SelectionName(results[k].selection);
  }
}

bool AsksNeighbours(const LoopClosingOptions& options) {
  return options.ask_neighbours && !FLAGS_alone &&
         options.match.method == Method::kSdf;
}

// `query` is null where a map is matched with itself.
void AskNeighbours(const LoopClosingOptions& options, const DescribedMap& map,
                   const DescribedMap* const query, const Executor& executor,
                   const ProgressCallback& on_progress,
                   std::vector<Match>* const matches) {
  const std::map<SubmapId, OdometryPose> odometry = OdometryPoses(map.state);
  const PlacesAlongTrajectories references{&map.places, &odometry};
  if (query == nullptr) {
    JudgeByNeighbours(options.neighbourhood, options.match, references,
                      references, options.min_index_gap, executor, on_progress,
                      matches);
    return;
  }
  const std::map<SubmapId, OdometryPose> query_odometry =
      OdometryPoses(query->state);
  JudgeByNeighbours(options.neighbourhood, options.match, references,
                    {&query->places, &query_odometry}, std::nullopt, executor,
                    on_progress, matches);
}

absl::StatusOr<DescribedMap> Describe(const MethodOptions& method,
                                      const std::string& path,
                                      const Executor& executor,
                                      const ProgressCallback& on_progress) {
  const LoopClosingOptions& stages = method.options.loop_closing;
  return method.describes_clouds
             ? DescribeMapByShapeContexts(method.options.shape_context, path,
                                          executor, on_progress)
             : DescribeMap(stages.place, stages.match, path, executor,
                           on_progress);
}

absl::Status RunMatch() {
  const absl::StatusOr<MethodOptions> method =
      LoadOptionsOfMethod(FLAGS_method);
  if (!method.ok()) return method.status();
  if (method->options.loop_closing.match.method != Method::kSdf &&
      (FLAGS_agree || FLAGS_alone || !FLAGS_terms.empty())) {
    return UsageError("--agree, --alone and --terms need method sdf");
  }
  if (!FLAGS_neighbour_terms.empty() &&
      !AsksNeighbours(method->options.loop_closing)) {
    return UsageError(
        "--neighbour_terms needs method sdf, and neighbours that are asked");
  }
  if (method->describes_clouds && !FLAGS_places.empty()) {
    return UsageError("--places needs method sdf or paper");
  }
  const absl::StatusOr<int> num_threads = NumThreadsOfFlags();
  if (!num_threads.ok()) return num_threads.status();
  const LoopClosingOptions& stages = method->options.loop_closing;
  const Executor executor = MakeExecutor(*num_threads);
  const std::optional<RetrievalOptions> retrieval =
      FLAGS_retrieval ? std::make_optional(stages.retrieval) : std::nullopt;
  StageProgress progress;
  const ProgressCallback on_describe = progress.Begin("read and describe");
  const absl::StatusOr<DescribedMap> map =
      method->describes_clouds
          ? Describe(*method, FLAGS_input, executor, on_describe)
          : DescribeMapOfFlags(method->options, FLAGS_input, executor,
                               on_describe);
  if (!map.ok()) return map.status();
  std::vector<Match> matches;
  std::optional<DescribedMap> query;
  if (FLAGS_query.empty()) {
    matches =
        MatchWithin(stages.match, retrieval, map->places, stages.min_index_gap,
                    executor, progress.Begin("match and verify"));
  } else {
    absl::StatusOr<DescribedMap> described = Describe(
        *method, FLAGS_query, executor, progress.Begin("read and describe"));
    if (!described.ok()) return described.status();
    query = *std::move(described);
    matches = MatchBetween(stages.match, retrieval, map->places, query->places,
                           executor, progress.Begin("match and verify"));
  }
  if (AsksNeighbours(stages)) {
    AskNeighbours(stages, *map, query ? &*query : nullptr, executor,
                  progress.Begin("ask neighbours"), &matches);
  }
  std::vector<MatchRow> rows;
  for (const Match& match : matches) {
    rows.push_back(ToRow(match, match.verdict == Verdict::kAccepted,
                         VerdictName(match.verdict)));
  }
  if (FLAGS_agree) {
    RefuseInconsistent(stages.consistency, map->state,
                       query ? &query->state : nullptr, matches, &rows);
  }
  if (const absl::Status status = WriteMatches(FLAGS_output, rows);
      !status.ok()) {
    return status;
  }
  if (!FLAGS_terms.empty()) {
    const absl::Status status = WriteScoreTerms(FLAGS_terms, matches);
    if (!status.ok()) return status;
  }
  if (!FLAGS_neighbour_terms.empty()) {
    const absl::Status status = WriteNeighbourhoodTerms(
        FLAGS_neighbour_terms, stages.neighbourhood, matches);
    if (!status.ok()) return status;
  }
  if (!FLAGS_options_in_force.empty()) {
    const absl::Status status =
        WriteWholeFile(FLAGS_options_in_force, FormatOptions(method->options));
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
      "[--method sdf|paper|shape_context] [--retrieval] [--places P.places] "
      "[--alone] "
      "[--agree]",
      "Matches every pair of submaps without a pose prior and writes the best "
      "pose of each pair for which there is one, accepted or not, with its "
      "evidence. Nothing is optimised.\n\n"
      "The columns x, y, yaw are the pose of the query submap in the frame of "
      "the reference submap [m, rad]; a higher score is more certain (sdf: "
      "log-odds of being right; paper and shape_context: number of "
      "inliers).\n\n"
      "Each pair is judged together with the neighbours of both submaps on "
      "their trajectories; with --alone, by itself.\n\n"
      "With --agree, an accepted match that weightier ones contradict by the "
      "odometry between them, or that is uncertain and stands alone, is "
      "accepted no more, and its verdict says which.",
      {"input", "output"},
      {"query", "method", "retrieval", "places", "alone", "agree", "terms",
       "neighbour_terms", "options_in_force", "configuration_directory",
       "configuration_basename", "threads"},
      &RunMatch};
}

}  // namespace cartographer_sdf
