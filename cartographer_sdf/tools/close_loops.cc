// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/close_loops.h"

#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/report/map_summary.h"
#include "cartographer_sdf/report/match_table.h"
#include "cartographer_sdf/report/reports.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/stages.h"
#include "cartographer_sdf/tools/subcommand.h"

DEFINE_string(closures, "",
              "CSV file to write the closures in the pose graph to, with their "
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

void RecordClosing(const LoopClosingResult& result, RunRecord* const record) {
  RecordMap(result.state, record);
  record->Count("places", result.num_places);
  record->Count("matches", result.num_matches);
  record->Count("accepted", result.closed.closures.size());
  const std::map<std::string, int> statuses =
      CountStatuses(result.closed.closures);
  const auto in_graph =
      statuses.find(ClosureStatusName(ClosureStatus::kInGraph));
  const int num_closures = in_graph == statuses.end() ? 0 : in_graph->second;
  record->Count("closures", static_cast<size_t>(num_closures));
  RecordTornSubmaps(result.closed.torn_submaps, record);
  RecordSlips(result.closed.slips, result.state.pose_graph, record);
  RecordConvergence(result.closed.optimizations, record);
  record->answer["closures"] = Json(statuses);
  if (num_closures == 0) {
    record->End(Outcome::kNothing, "no new loop closure was found; " +
                                       DescribeWithoutClosures(result));
  }
}

void PrintSummary(const LoopClosingResult& result) {
  PrintRepair(result.state);
  std::cout << absl::StrFormat("%d submaps, %d matches passed verification\n",
                               result.num_places,
                               result.closed.closures.size());
  PrintStatuses("", result.closed.closures);
  if (!result.closed.torn_submaps.empty()) {
    std::cout << absl::StrFormat("%d submaps are torn inside:\n",
                                 result.closed.torn_submaps.size());
    for (const auto& [id, tear] : result.closed.torn_submaps) {
      std::cout << "  " << DescribeTear(id, tear) << "\n";
    }
  }
  if (!result.closed.slips.empty()) {
    std::cout << DescribeSlips(result.closed.slips, result.state.pose_graph)
              << "; where closures ask for it, the map gives way.\n";
  }
  if (result.closed.closures.empty()) {
    std::cout << "No loop closure was found; "
              << DescribeWithoutClosures(result) << ".\n";
  }
  PrintStages(result.stage_seconds);
  PrintConvergence(result.closed.optimizations);
  PrintPaths();
}

absl::Status RunCloseLoops(RunRecord* const record) {
  const absl::StatusOr<MapTask> task = MapTaskOfFlags("close_loops");
  if (!task.ok()) return task.status();
  StageProgress progress(record);
  const absl::StatusOr<LoopClosingResult> result =
      CloseLoops(task->options.loop_closing, SourceOfFlags(FLAGS_input),
                 task->frozen_trajectories, task->executor, progress.Callback(),
                 DescriberOfFlags(*task, {FLAGS_input}, record));
  if (!result.ok()) return result.status();
  absl::Status status;
  if (!FLAGS_closures.empty()) {
    status = WriteClosures(FLAGS_closures, result->closed.closures);
  }
  if (status.ok()) {
    status = WriteMapAndReport(
        result->state, result->closed.pose_graph,
        [&](const SubmapsReader& read_submaps) {
          return WriteCloseLoopsReport(
              ReportRequestOfFlags(task->options, record->run),
              task->options.loop_closing, FLAGS_input, *result, read_submaps);
        },
        &progress);
  }
  RecordClosing(*result, record);
  if (!status.ok()) return status;
  PrintSummary(*result);
  WarnOfHostMotion(task->options.loop_closing.closing, result->optimization,
                   result->closed.pose_graph, record);
  return absl::OkStatus();
}

}  // namespace

Subcommand CloseLoopsSubcommand() {
  Subcommand subcommand{
      "close_loops",
      "find the loop closures of a map and optimise it",
      "A.pbstream (--output B.pbstream | --in_place) [--closures C.csv] "
      "[--report DIR] [--places P.places] [--result R.json] [--repair] "
      "[--drop_odometry]",
      "Finds submaps that see the same place by their walls and the shape of "
      "their free space, without a pose prior; verifies the matches; keeps a "
      "mutually consistent set; adds it to the pose graph as inter-submap "
      "constraints; optimises; and writes a map that Cartographer's own tools "
      "load. Every other record of the file stays as it is.\n\n"
      "A map without new closures is copied, byte for byte.\n\n"
      "Cartographer optimises a map again that it loads unfrozen, with the "
      "odometry weights of its configuration. If that would bend the map, the "
      "last lines say how far; --drop_odometry keeps it from doing so.",
      {{"input", FileUse::kRead},
       {"output", FileUse::kCopyMap, {}, "Map to write, a .pbstream."}},
      {{"closures", FileUse::kWriteText},
       {"report", FileUse::kWriteInto, {"index.html"}},
       {"picture", FileUse::kWriteText},
       "picture_pixels",
       {"places", FileUse::kCache},
       "in_place",
       "backup",
       "repair",
       "drop_odometry",
       "frozen_trajectories",
       "configuration_directory",
       "configuration_basename",
       "threads"},
      &RunCloseLoops};
  subcommand.check_flags = &CheckPictureFlags;
  subcommand.positional_flags = {"input"};
  return subcommand;
}

}  // namespace cartographer_sdf
