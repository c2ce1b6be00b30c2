// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/close_loops.h"

#include <iostream>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/report/close_loops_report.h"
#include "cartographer_sdf/report/match_table.h"
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
                           const std::vector<Closure>& closures) {
  std::vector<MatchRow> rows;
  for (const Closure& closure : closures) {
    if (closure.status != ClosureStatus::kInGraph) continue;
    rows.push_back(
        ToRow(closure.match, true, VerdictName(closure.match.verdict)));
  }
  return WriteMatches(path, rows);
}

void PrintSummary(const LoopClosingResult& result) {
  std::map<ClosureStatus, int> statuses;
  for (const Closure& closure : result.closed.closures)
    ++statuses[closure.status];
  std::cout << absl::StrFormat(
      "%d submaps, %d matches accepted by verification\n", result.num_places,
      result.closed.closures.size());
  for (const auto& [status, count] : statuses) {
    std::cout << absl::StrFormat("  %5d %s\n", count,
                                 ClosureStatusName(status));
  }
  if (!result.closed.torn_submaps.empty()) {
    std::cout << absl::StrFormat("%d submaps are torn inside:\n",
                                 result.closed.torn_submaps.size());
    for (const auto& [id, tear] : result.closed.torn_submaps) {
      std::cout << "  " << DescribeTear(id, tear) << "\n";
    }
  }
  if (result.closed.closures.empty()) {
    std::cout << "No loop closure was found; the map is as it was.\n";
  }
  for (const auto& [stage, seconds] : result.stage_seconds) {
    std::cout << absl::StrFormat("  %7.2f s %s\n", seconds, stage);
  }
  if (!result.closed.optimizations.empty() &&
      !result.closed.optimizations.back().converged) {
    std::cout << "The optimisation did not converge: "
              << result.closed.optimizations.back().message << "\n";
  }
}

// The map last: it stands for all having gone well.
absl::Status WriteFiles(const Options& options, const LoopClosingResult& result,
                        StageProgress* const progress) {
  absl::Status status;
  if (!FLAGS_closures.empty()) {
    status = WriteClosures(FLAGS_closures, result.closed.closures);
  }
  std::optional<RecordWriter> output;
  const auto write = [&](const SubmapCallback& on_submap) -> absl::Status {
    absl::StatusOr<RecordWriter> map =
        PrepareMap(FLAGS_input, FLAGS_output, result.closed.pose_graph,
                   {on_submap, {}}, progress->Begin("write"));
    if (map.ok()) output.emplace(*std::move(map));
    return map.status();
  };
  if (status.ok()) {
    // The report shows the grids of the map, which come by as it is written.
    status = FLAGS_report.empty()
                 ? write({})
                 : WriteCloseLoopsReport(ReportRequestOfFlags(options),
                                         FLAGS_input, result, write);
  }
  return status.ok() ? output->Commit() : status;
}

absl::Status RunCloseLoops() {
  const absl::StatusOr<Options> options = LoadOptionsOfFlags();
  if (!options.ok()) return options.status();
  if (absl::Status status =
          RequireVerification(options->loop_closing, "close_loops");
      !status.ok()) {
    return status;
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
  const absl::Status status = WriteFiles(*options, *result, &progress);
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
