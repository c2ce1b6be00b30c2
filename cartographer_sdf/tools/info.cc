// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <iostream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/apps/map_examination.h"
#include "cartographer_sdf/closing/torn_submaps.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "cartographer_sdf/pose_graph/slips.h"
#include "cartographer_sdf/report/json.h"
#include "cartographer_sdf/report/map_summary.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/progress.h"
#include "cartographer_sdf/tools/stages.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"

DEFINE_bool(torn_submaps, false,
            "Also look for submaps that local SLAM tore; reads all scans, "
            "which takes some seconds for a hundred submaps.");

DEFINE_bool(quality, false,
            "Also measure how well the map agrees with itself, and say what is "
            "wrong with it and what improves it; includes --torn_submaps.");

namespace cartographer_sdf {
namespace {

std::string DescribeTornSubmaps(const std::map<SubmapId, Tear>& torn_submaps) {
  std::string text =
      absl::StrFormat("\nTorn submaps: %d\n", torn_submaps.size());
  for (const auto& [id, tear] : torn_submaps) {
    absl::StrAppend(&text, "  ", DescribeTear(id, tear), "\n");
  }
  return text;
}

std::string SlipLine(const Slips& slips, const PoseGraph& pose_graph) {
  if (slips.empty()) return "";
  return DescribeSlips(slips, pose_graph) + "\n";
}

// Only this and the quality need the options; a map's contents can be described
// without.
absl::StatusOr<std::string> ExamineTears(
    const MapState& state, const std::map<NodeId, PointCloud2>& scans,
    StageProgress* const progress, RunRecord* const record) {
  const absl::StatusOr<Options> options = LoadOptionsOfFlags();
  if (!options.ok()) return options.status();
  const absl::StatusOr<int> num_threads = NumThreadsOfFlags();
  if (!num_threads.ok()) return num_threads.status();
  const ClosingOptions& closing = options->loop_closing.closing;
  const std::map<SubmapId, Tear> torn_submaps = FindTornSubmaps(
      closing.tear, state.pose_graph, scans, MakeExecutor(*num_threads),
      progress->Begin("find torn submaps"));
  const Slips slips =
      FindSlips(closing.optimization.min_slip_angle, state.pose_graph);
  RecordTornSubmaps(torn_submaps, record);
  RecordSlips(slips, state.pose_graph, record);
  return absl::StrCat(DescribeTornSubmaps(torn_submaps),
                      SlipLine(slips, state.pose_graph));
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

std::string DescribeWalls(const std::string& what, const MapQuality& quality) {
  if (quality.num_pairs == 0) return absl::StrCat("  ", what, ": none\n");
  return absl::StrFormat(
      "  %s (%d pairs): %.1f %% of their walls agree, to %.3f m; %.2f %% stand "
      "in free space\n",
      what, quality.num_pairs, 100. * quality.hit_ratio, quality.wall_distance,
      100. * quality.contradiction_ratio);
}

std::string DescribeQuality(const MapExamination& map) {
  std::string text = "\nQuality\n";
  absl::StrAppend(
      &text, DescribeWalls("places seen twice", map.whole),
      DescribeWalls("submaps two apart in local SLAM", map.along_trajectories),
      absl::StrFormat("  links of local SLAM that walls contradict: %d\n",
                      map.broken_links.size()));
  for (const SubmapId& id : map.broken_links) {
    absl::StrAppend(&text, "    behind submap ", id.trajectory, ",", id.index,
                    "\n");
  }
  absl::StrAppend(&text, "  submaps that resemble themselves in another pose: ",
                  map.num_self_similar, " of ", map.num_places, "\n");
  const std::vector<std::string> advice = AdviseOnMap(map);
  if (advice.empty()) absl::StrAppend(&text, "  nothing to improve\n");
  for (const std::string& sentence : advice) {
    absl::StrAppend(&text, "  - ", sentence, "\n");
  }
  return text;
}

void RecordQuality(const MapExamination& map, RunRecord* const record) {
  Json broken_links = Json::array();
  for (const SubmapId& id : map.broken_links)
    broken_links.push_back(ToJson(id));
  record->answer["quality"] = {
      {"walls", ToJson(map.whole)},
      {"walls_along_trajectories", ToJson(map.along_trajectories)},
      {"broken_links", std::move(broken_links)},
      {"self_similar", map.num_self_similar},
      {"places", map.num_places},
      {"mean_area", map.mean_area},
      {"advice", Json(AdviseOnMap(map))}};
}

// For --quality.
absl::StatusOr<std::string> Examine(StageProgress* const progress,
                                    RunRecord* const record) {
  const absl::StatusOr<Options> options = LoadOptionsOfFlags();
  if (!options.ok()) return options.status();
  const absl::StatusOr<int> num_threads = NumThreadsOfFlags();
  if (!num_threads.ok()) return num_threads.status();
  const LoopClosingOptions& loop_closing = options->loop_closing;
  const Executor executor = MakeExecutor(*num_threads);
  const absl::StatusOr<DescribedMap> map =
      DescribeMap(loop_closing.place, loop_closing.recognition.match,
                  {FLAGS_input, MissingRecords::kDrop}, executor,
                  progress->Begin("read and describe"), PointClouds::kKeep);
  if (!map.ok()) return map.status();
  const MapExamination examination =
      ExamineMap(loop_closing, *map, executor, progress->Callback());
  RecordTornSubmaps(examination.torn_submaps, record);
  RecordQuality(examination, record);
  RecordSlips(examination.slips, map->state.pose_graph, record);
  return absl::StrCat(DescribeTornSubmaps(examination.torn_submaps),
                      SlipLine(examination.slips, map->state.pose_graph),
                      DescribeQuality(examination));
}

absl::Status RunInfo(RunRecord* const record) {
  StageProgress progress(record);
  std::map<NodeId, PointCloud2> scans;
  MapVisitor visitor;
  const bool only_tears = FLAGS_torn_submaps && !FLAGS_quality;
  if (only_tears) {
    visitor.on_point_cloud = [&scans](const NodeId& id, PointCloud2 scan) {
      scans.emplace(id, std::move(scan));
    };
  }
  const absl::StatusOr<MapState> state = ReadMap(
      {FLAGS_input, MissingRecords::kKeep}, visitor, progress.Begin("read"));
  if (!state.ok()) return state.status();
  RecordContents(*state, record);
  std::string text = DescribeMap(FLAGS_input, *state);
  if (only_tears) {
    const absl::StatusOr<std::string> examined =
        ExamineTears(*state, scans, &progress, record);
    if (!examined.ok()) return examined.status();
    text += *examined;
  } else if (FLAGS_quality) {
    const absl::StatusOr<std::string> examined = Examine(&progress, record);
    if (!examined.ok()) return examined.status();
    text += *examined;
  }
  std::cout << text;
  return absl::OkStatus();
}

}  // namespace

Subcommand Info() {
  Subcommand subcommand{
      "info",
      "describe the contents of a map",
      "A.pbstream [--torn_submaps | --quality] [--result R.json]",
      "Prints the format, trajectories, submaps, constraints and records of a "
      "map of Cartographer 2D and, with --torn_submaps, the submaps that local "
      "SLAM tore. --quality measures, without a truth, whether places that "
      "were seen twice agree, how noisy local SLAM is and where it slipped, "
      "and how many submaps resemble themselves, and advises. Does not change "
      "the map.",
      {{"input", FileUse::kRead}},
      {"torn_submaps", "quality", "configuration_directory",
       "configuration_basename", "threads"},
      &RunInfo};
  subcommand.positional_flags = {"input"};
  return subcommand;
}

}  // namespace cartographer_sdf
