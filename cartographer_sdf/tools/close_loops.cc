// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <iostream>
#include <map>
#include <set>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/evaluation/match_table.h"
#include "cartographer_sdf/loop_closing/loop_closing.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/tools/close_loops_report.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/stages.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"

DEFINE_string(closures, "",
              "CSV file for the closures that went into the graph, with their "
              "evidence. None if empty.");

namespace cartographer_sdf {
namespace {

absl::Status WriteClosures(const std::string& path,
                           const std::vector<ClosureOutcome>& closures) {
  std::vector<MatchRow> rows;
  for (const ClosureOutcome& outcome : closures) {
    if (outcome.fate != Fate::kInGraph) continue;
    rows.push_back(
        ToRow(outcome.match, true, VerdictName(outcome.match.verdict)));
  }
  return WriteMatches(path, rows);
}

void PrintSummary(const LoopClosingResult& result) {
  std::map<Fate, int> fates;
  for (const ClosureOutcome& outcome : result.closures) ++fates[outcome.fate];
  std::cout << absl::StrFormat(
      "%d submaps, %d matches accepted by verification\n", result.num_places,
      result.closures.size());
  for (const auto& [fate, count] : fates) {
    std::cout << absl::StrFormat("  %5d %s\n", count, FateName(fate));
  }
  if (!result.torn_submaps.empty()) {
    std::cout << absl::StrFormat("%d submaps are torn inside:\n",
                                 result.torn_submaps.size());
    for (const auto& [id, tear] : result.torn_submaps) {
      std::cout << "  " << DescribeTear(id, tear) << "\n";
    }
  }
  if (result.closures.empty()) {
    std::cout << "No loop closure was found; the map is as it was.\n";
  }
  for (const auto& [stage, seconds] : result.stage_seconds) {
    std::cout << absl::StrFormat("  %7.2f s %s\n", seconds, stage);
  }
  if (!result.optimizations.empty() && !result.optimizations.back().converged) {
    std::cout << "The optimisation did not converge: "
              << result.optimizations.back().message << "\n";
  }
}

absl::Status RunCloseLoops() {
  const absl::StatusOr<Options> options = LoadOptionsOfFlags();
  if (!options.ok()) return options.status();
  if (options->loop_closing.match.method != Method::kSdf) {
    return absl::InvalidArgumentError(
        "close_loops needs match.method = \"sdf\": the number of inliers is no "
        "verification");
  }
  const absl::StatusOr<int> num_threads = NumThreadsOfFlags();
  if (!num_threads.ok()) return num_threads.status();
  const absl::StatusOr<std::set<int>> frozen = FrozenTrajectoriesOfFlags();
  if (!frozen.ok()) return frozen.status();

  StageProgress progress;
  const absl::StatusOr<LoopClosingResult> result =
      CloseLoops(options->loop_closing, FLAGS_input, *frozen,
                 MakeExecutor(*num_threads), progress.Callback());
  if (!result.ok()) return result.status();
  // The map last: it stands for all having gone well.
  absl::Status status;
  if (!FLAGS_closures.empty()) {
    status = WriteClosures(FLAGS_closures, result->closures);
  }
  if (status.ok() && !FLAGS_report.empty()) {
    status = WriteCloseLoopsReport(FLAGS_report, FLAGS_input, *options, *result,
                                   progress.Begin("report"));
  }
  if (status.ok()) {
    status = WriteMap(FLAGS_input, FLAGS_output, result->pose_graph,
                      progress.Begin("write"));
  }
  if (!status.ok()) return status;
  PrintSummary(*result);
  std::cout << FLAGS_output << "\n";
  if (!FLAGS_report.empty()) std::cout << FLAGS_report << "/index.html\n";
  return absl::OkStatus();
}

}  // namespace

Subcommand CloseLoopsSubcommand() {
  return Subcommand{
      "close_loops",
      "find the loop closures of a map and optimise it",
      "--input A.pbstream --output B.pbstream [--closures C.csv] "
      "[--report DIR]",
      "Compares every pair of submaps by the shape of their free space, "
      "without "
      "a pose prior; verifies what matches; keeps a mutually consistent set; "
      "adds it to the pose graph as inter-submap constraints; optimises; and "
      "writes a map that Cartographer's own tools load. Everything else in the "
      "file stays as it is.\n\n"
      "A map in which nothing is found comes out as it went in.",
      {"input", "output"},
      {"closures", "report", "frozen_trajectories", "configuration_directory",
       "configuration_basename", "threads"},
      &RunCloseLoops};
}

}  // namespace cartographer_sdf
