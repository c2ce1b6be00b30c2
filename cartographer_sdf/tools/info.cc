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
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"

DEFINE_bool(torn_submaps, false,
            "Also look for submaps that local SLAM tore; reads all scans, "
            "which takes some seconds for a hundred submaps.");

namespace cartographer_sdf {
namespace {

// Lines about the torn submaps. Only they need the options; a map's contents
// can be described without.
absl::StatusOr<std::string> DescribeTornSubmaps(
    const MapState& state, const std::map<NodeId, PointCloud2>& scans,
    StageProgress* const progress) {
  const absl::StatusOr<Options> options = LoadOptionsOfFlags();
  if (!options.ok()) return options.status();
  const absl::StatusOr<int> num_threads = NumThreadsOfFlags();
  if (!num_threads.ok()) return num_threads.status();
  const std::map<SubmapId, Tear> torn_submaps = FindTornSubmaps(
      options->loop_closing.closing.tear, state.pose_graph, scans,
      MakeExecutor(*num_threads), progress->Begin("find torn submaps"));
  std::string text =
      absl::StrFormat("\nTorn submaps: %d\n", torn_submaps.size());
  for (const auto& [id, tear] : torn_submaps) {
    absl::StrAppend(&text, "  ", DescribeTear(id, tear), "\n");
  }
  return text;
}

absl::Status RunInfo() {
  StageProgress progress;
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
  absl::StatusOr<std::string> torn_submaps;
  if (FLAGS_torn_submaps) {
    torn_submaps = DescribeTornSubmaps(*state, scans, &progress);
    if (!torn_submaps.ok()) return torn_submaps.status();
  }
  std::cout << DescribeMap(FLAGS_input, *state) << torn_submaps.value_or("");
  return absl::OkStatus();
}

}  // namespace

Subcommand Info() {
  return Subcommand{
      "info",
      "describe the contents of a map",
      "--input A.pbstream [--torn_submaps]",
      "Prints the format, trajectories, submaps, constraints and records of a "
      "map of Cartographer 2D and, with --torn_submaps, the submaps that local "
      "SLAM tore. Does not change the map.",
      {{"input", FileUse::kRead}},
      {"torn_submaps", "configuration_directory", "configuration_basename",
       "threads"},
      &RunInfo};
}

}  // namespace cartographer_sdf
