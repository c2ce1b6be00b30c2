// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <iostream>
#include <map>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/closing/torn_submaps.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/report/map_summary.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/progress.h"
#include "cartographer_sdf/tools/stages.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"

DEFINE_bool(torn_submaps, false,
            "Also look for submaps that local SLAM tore; reads all scans, "
            "which takes some seconds for a hundred submaps.");

namespace cartographer_sdf {
namespace {

// Only they need the options; a map's contents can be described without.
absl::StatusOr<std::map<SubmapId, Tear>> TornSubmapsOf(
    const MapState& state, const std::map<NodeId, PointCloud2>& scans,
    StageProgress* const progress) {
  const absl::StatusOr<Options> options = LoadOptionsOfFlags();
  if (!options.ok()) return options.status();
  const absl::StatusOr<int> num_threads = NumThreadsOfFlags();
  if (!num_threads.ok()) return num_threads.status();
  return FindTornSubmaps(options->loop_closing.closing.tear, state.pose_graph,
                         scans, MakeExecutor(*num_threads),
                         progress->Begin("find torn submaps"));
}

std::string DescribeTornSubmaps(const std::map<SubmapId, Tear>& torn_submaps) {
  std::string text =
      absl::StrFormat("\nTorn submaps: %d\n", torn_submaps.size());
  for (const auto& [id, tear] : torn_submaps) {
    absl::StrAppend(&text, "  ", DescribeTear(id, tear), "\n");
  }
  return text;
}

Json TrajectoriesJson(const MapState& state) {
  Json json = Json::array();
  for (const auto& [id, summary] : SummarizeTrajectories(state)) {
    json.push_back({{"trajectory", id},
                    {"submaps", summary.num_submaps},
                    {"nodes", summary.num_nodes},
                    {"begin", FormatUniversalTime(summary.begin_time)},
                    {"duration_seconds", summary.duration_seconds},
                    {"length_meters", summary.length}});
  }
  return json;
}

void RecordContents(const MapState& state, RunRecord* const record) {
  record->Count("trajectories", state.trajectories.size());
  record->Count("submaps", state.pose_graph.submap_poses.size());
  record->Count("nodes", state.pose_graph.nodes.size());
  record->Count("constraints", state.pose_graph.constraints.size());
  record->answer["format_version"] = state.format_version;
  record->answer["trajectories"] = TrajectoriesJson(state);
  record->answer["records"] = Json(state.num_records);
  if (state.num_unrecorded_submaps + state.num_unrecorded_nodes == 0) return;
  record->Warn(RunWarning::kIncomplete,
               absl::StrFormat("%d submaps and %d nodes have no data",
                               state.num_unrecorded_submaps,
                               state.num_unrecorded_nodes));
}

absl::Status RunInfo(RunRecord* const record) {
  StageProgress progress(record);
  std::map<NodeId, PointCloud2> scans;
  MapVisitor visitor;
  if (FLAGS_torn_submaps) {
    visitor.on_point_cloud = [&scans](const NodeId& id, PointCloud2 scan) {
      scans.emplace(id, std::move(scan));
    };
  }
  const absl::StatusOr<MapState> state = ReadMap(
      {FLAGS_input, MissingRecords::kKeep}, visitor, progress.Begin("read"));
  if (!state.ok()) return state.status();
  RecordContents(*state, record);
  std::string text = DescribeMap(FLAGS_input, *state);
  if (FLAGS_torn_submaps) {
    const absl::StatusOr<std::map<SubmapId, Tear>> torn_submaps =
        TornSubmapsOf(*state, scans, &progress);
    if (!torn_submaps.ok()) return torn_submaps.status();
    RecordTornSubmaps(*torn_submaps, record);
    text += DescribeTornSubmaps(*torn_submaps);
  }
  std::cout << text;
  return absl::OkStatus();
}

}  // namespace

Subcommand Info() {
  Subcommand subcommand{
      "info",
      "describe the contents of a map",
      "A.pbstream [--torn_submaps] [--result R.json]",
      "Prints the format, trajectories, submaps, constraints and records of a "
      "map of Cartographer 2D and, with --torn_submaps, the submaps that local "
      "SLAM tore. Does not change the map.",
      {{"input", FileUse::kRead}},
      {"torn_submaps", "configuration_directory", "configuration_basename",
       "threads"},
      &RunInfo};
  subcommand.positional_flags = {"input"};
  return subcommand;
}

}  // namespace cartographer_sdf
