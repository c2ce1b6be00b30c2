// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <iostream>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/evaluation/match_table.h"
#include "cartographer_sdf/loop_closing/described_map.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/stages.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"

DEFINE_string(method, "",
              "sdf or paper; if empty, that of the configuration file. paper "
              "reads paper.lua unless --configuration_basename is given.");

DEFINE_bool(retrieval, false,
            "Match only those pairs of submaps that an index of all features "
            "proposes: much faster on large maps, at the price of some pairs.");

DEFINE_string(places, "",
              "A file beside --input that holds what its submaps look like: "
              "read instead of describing them again, made where there is none "
              "or where it is of another map or other options.");

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

// A file of places is bound to all options: more than they depend on, but never
// too few.
absl::StatusOr<DescribedMap> DescribeInput(
    const Options& options, const Executor& executor,
    const ProgressCallback& on_progress) {
  const LoopClosingOptions& stages = options.loop_closing;
  if (FLAGS_places.empty()) {
    return DescribeMap(stages.place, stages.match, FLAGS_input, executor,
                       on_progress);
  }
  absl::StatusOr<RememberedMap> remembered =
      RememberMap(stages.place, stages.match, FormatOptions(options),
                  FLAGS_input, FLAGS_places, executor, on_progress);
  if (!remembered.ok()) return remembered.status();
  if (!remembered->complaint.empty()) {
    std::cerr << "--places: " << remembered->complaint << "\n";
  }
  return std::move(remembered->map);
}

absl::Status RunMatch() {
  const absl::StatusOr<Options> options = LoadOptionsOfMethod();
  if (!options.ok()) return options.status();
  const absl::StatusOr<int> num_threads = NumThreadsOfFlags();
  if (!num_threads.ok()) return num_threads.status();
  const LoopClosingOptions& stages = options->loop_closing;
  const Executor executor = MakeExecutor(*num_threads);
  const std::optional<RetrievalOptions> retrieval =
      FLAGS_retrieval ? std::make_optional(stages.retrieval) : std::nullopt;
  StageProgress progress;
  const absl::StatusOr<DescribedMap> map =
      DescribeInput(*options, executor, progress.Begin("read and describe"));
  if (!map.ok()) return map.status();
  std::vector<Match> matches;
  if (FLAGS_query.empty()) {
    matches =
        MatchWithin(stages.match, retrieval, map->places, stages.min_index_gap,
                    executor, progress.Begin("match and verify"));
  } else {
    const absl::StatusOr<DescribedMap> query =
        DescribeMap(stages.place, stages.match, FLAGS_query, executor,
                    progress.Begin("read and describe"));
    if (!query.ok()) return query.status();
    matches = MatchBetween(stages.match, retrieval, map->places, query->places,
                           executor, progress.Begin("match and verify"));
  }
  std::vector<MatchRow> rows;
  int num_accepted = 0;
  for (const Match& match : matches) {
    const bool accepted = match.verdict == Verdict::kAccepted;
    num_accepted += accepted;
    rows.push_back(ToRow(match, accepted, VerdictName(match.verdict)));
  }
  if (const absl::Status status = WriteMatches(FLAGS_output, rows);
      !status.ok()) {
    return status;
  }
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
      "[--method sdf|paper] [--retrieval] [--places P.places]",
      "Matches every pair of submaps without a pose prior and writes the best "
      "pose of each pair for which there is one, accepted or not, with its "
      "evidence. Nothing is optimised.\n\n"
      "The columns x, y, yaw are the pose of the query submap in the frame of "
      "the reference submap [m, rad]; a higher score is more certain (sdf: "
      "log-odds of being right; paper: number of inliers).",
      {"input", "output"},
      {"query", "method", "retrieval", "places", "configuration_directory",
       "configuration_basename", "threads"},
      &RunMatch};
}

}  // namespace cartographer_sdf
