// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/merge.h"

#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/pbstream/joined_map_file.h"
#include "cartographer_sdf/report/json.h"
#include "cartographer_sdf/report/reports.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/stages.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"

DEFINE_string(inputs, "",
              "Maps to merge, separated by commas; a comma in a path is "
              "written \\,. Maps that are given without a flag are taken as "
              "they are.");

namespace cartographer_sdf {
namespace {

void PrintSummary(const MergingResult& result) {
  PrintRepair(result.state);
  for (size_t k = 0; k < result.sessions.size(); ++k) {
    const MergedSession& session = result.sessions[k];
    std::cout << absl::StrFormat("%3d  %s: ", k + 1, session.path);
    if (session.T_merged_session) {
      std::cout << "at " << FormatPose(*session.T_merged_session) << "\n";
    } else {
      std::cout << "NOT in the merged map: " << session.left_out << "\n";
    }
  }
  for (const SessionLink& link : result.links) {
    const Localization& found = link.localization;
    std::cout << absl::StrFormat(
        "  %d and %d: %s, %s\n", link.first + 1, link.second + 1,
        LocalizationVerdictName(found.verdict), found.reason);
    if (found.T_map_query) {
      std::cout << "    " << DescribeChanges(found.changes) << "\n";
    }
  }
  PrintStatuses("closures ", result.closed.closures);
  std::cout << absl::StrFormat(
      "  %d pairs of submaps overlap, %d of them contradict each other\n",
      result.num_overlapping, result.contradictions.size());
  PrintStages(result.stage_seconds);
}

size_t NumMerged(const MergingResult& result) {
  return static_cast<size_t>(
      std::count_if(result.sessions.begin(), result.sessions.end(),
                    [](const MergedSession& session) {
                      return session.T_merged_session.has_value();
                    }));
}

void RecordMerging(const MergingResult& result, RunRecord* const record) {
  record->answer = ToJson(result);
  const size_t num_left_out = result.sessions.size() - NumMerged(result);
  RecordMap(result.state, record);
  record->Count("sessions", result.sessions.size());
  record->Count("sessions_left_out", num_left_out);
  record->Count("overlapping_pairs",
                static_cast<size_t>(result.num_overlapping));
  record->Count("contradicting_pairs", result.contradictions.size());
  if (num_left_out > 0) {
    record->Warn(RunWarning::kSessionsLeftOut,
                 absl::StrFormat("%d of %d maps are left out", num_left_out,
                                 result.sessions.size()));
  }
  if (!result.contradictions.empty()) {
    record->Warn(RunWarning::kContradictions,
                 absl::StrFormat("%d pairs of submaps contradict each other",
                                 result.contradictions.size()));
  }
  RecordConvergence(result.closed.optimizations, record);
}

absl::StatusOr<std::vector<MapSource>> InputsOfFlags() {
  std::vector<MapSource> inputs;
  for (const std::string& path : SplitPaths(FLAGS_inputs)) {
    inputs.push_back(SourceOfFlags(path));
  }
  if (inputs.size() < 2) {
    return UsageError("merge needs two maps at least");
  }
  return inputs;
}

absl::Status CheckFlagsOfMerge() {
  if (FLAGS_places.empty() ||
      SplitPaths(FLAGS_places).size() == SplitPaths(FLAGS_inputs).size()) {
    return absl::OkStatus();
  }
  return UsageError("--places takes as many files as there are inputs");
}

// Writes the files that the flags ask for. A refusal is an error, but still
// writes the report.
absl::Status WriteFiles(const Options& options, const MergingResult& result,
                        const RunDescription& run,
                        StageProgress* const progress) {
  absl::Status status;
  if (!FLAGS_report.empty()) {
    status = WriteMergingReport(ReportRequestOfFlags(options, run),
                                options.loop_closing, result,
                                progress->Begin("report"));
  }
  if (!status.ok()) return status;
  if (!result.refusal.empty()) {
    PrintSummary(result);
    return RefusalError(absl::StrCat("nothing is written to ", FLAGS_output,
                                     ": ", result.refusal));
  }
  return WriteJoinedMap(result.parts, result.closed.pose_graph, FLAGS_output,
                        progress->Begin("write"));
}

absl::Status RunMerge(RunRecord* const record) {
  const absl::StatusOr<MapTask> task = MapTaskOfFlags("merge");
  if (!task.ok()) return task.status();
  const absl::StatusOr<std::vector<MapSource>> inputs = InputsOfFlags();
  if (!inputs.ok()) return inputs.status();
  const Options& options = task->options;
  StageProgress progress(record);
  const absl::StatusOr<MergingResult> result = MergeSessions(
      options.fold_check, options.session_links, options.localization,
      options.scan_places, options.loop_closing, *inputs,
      task->frozen_trajectories, task->executor, progress.Callback(),
      DescriberOfFlags(*task, SplitPaths(FLAGS_inputs), record));
  if (!result.ok()) return result.status();
  RecordMerging(*result, record);
  const absl::Status status =
      WriteFiles(options, *result, record->run, &progress);
  if (!status.ok()) return status;
  PrintSummary(*result);
  PrintPaths();
  WarnOfHostMotion(options.loop_closing.closing,
                   options.loop_closing.closing.optimization,
                   result->closed.pose_graph, record);
  return absl::OkStatus();
}

}  // namespace

Subcommand MergeSubcommand() {
  Subcommand subcommand{
      "merge",
      "merge several maps of the same building into one",
      "A.pbstream B.pbstream... --output M.pbstream "
      "[--result R.json] [--report DIR]",
      "Localises the maps in each other, in any order and without a pose "
      "prior; adds the closures between them and within each; optimises, with "
      "odometry weights inferred from each map; and writes one map that "
      "Cartographer's own tools load. Trajectories are numbered in the order "
      "of the inputs; assets_writer takes one bag for each, in that order. All "
      "nodes, times and sensor data are kept.\n\n"
      "Merges the largest group of connected maps, in the frame of its first, "
      "and reports the other maps. Writes no map if none are connected, or if "
      "the merged map would be folded: the exit code is then 3.\n\n"
      "--frozen_trajectories refers to the first map.",
      {{"inputs", FileUse::kReadList},
       {"output", FileUse::kCopyMap, {}, "Map to write, a .pbstream."}},
      {{"report", FileUse::kWriteInto, {"index.html"}},
       {"places",
        FileUse::kCacheList,
        {},
        "Files that cache the descriptions of the submaps of the inputs, one "
        "for each in their order, separated by commas, so that later runs "
        "start faster. Written if missing or made for another map or other "
        "options."},
       "repair",
       "drop_odometry",
       "frozen_trajectories",
       "configuration_directory",
       "configuration_basename",
       "threads"},
      &RunMerge};
  subcommand.check_flags = &CheckFlagsOfMerge;
  subcommand.positional_flags = {"inputs"};
  return subcommand;
}

}  // namespace cartographer_sdf
