// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <iostream>
#include <map>
#include <utility>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/closing/torn_submaps.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/report/map_summary.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/stages.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"

DEFINE_bool(torn_submaps, false,
            "Look for submaps that local SLAM tore inside too: reads all "
            "scans, some seconds for a hundred submaps.");

namespace cartographer_sdf {
namespace {

struct MapInfo {
  MapState state;
  std::map<SubmapId, Tear> torn_submaps;  // where they were asked for
};

absl::StatusOr<MapInfo> ReadInfo(const TearOptions& options,
                                 const int num_threads) {
  StageProgress progress;
  std::map<NodeId, PointCloud2> scans;
  MapVisitor visitor;
  if (FLAGS_torn_submaps) {
    visitor.on_point_cloud = [&scans](const NodeId& id, PointCloud2 scan) {
      scans.emplace(id, std::move(scan));
    };
  }
  absl::StatusOr<MapState> state =
      ReadMap(FLAGS_input, visitor, progress.Begin("read"));
  if (!state.ok()) return state.status();
  MapInfo info{*std::move(state), {}};
  if (FLAGS_torn_submaps) {
    info.torn_submaps = FindTornSubmaps(options, info.state.pose_graph, scans,
                                        MakeExecutor(num_threads),
                                        progress.Begin("find torn submaps"));
  }
  return info;
}

absl::Status RunInfo() {
  TearOptions tear;
  int num_threads = 1;
  // Only then: without them, no options are needed.
  if (FLAGS_torn_submaps) {
    const absl::StatusOr<Options> options = LoadOptionsOfFlags();
    if (!options.ok()) return options.status();
    tear = options->loop_closing.closing.tear;
    const absl::StatusOr<int> threads = NumThreadsOfFlags();
    if (!threads.ok()) return threads.status();
    num_threads = *threads;
  }
  const absl::StatusOr<MapInfo> info = ReadInfo(tear, num_threads);
  if (!info.ok()) return info.status();
  std::cout << DescribeMap(FLAGS_input, info->state);
  if (!FLAGS_torn_submaps) return absl::OkStatus();
  std::cout << absl::StrFormat("\nTorn submaps: %d\n",
                               info->torn_submaps.size());
  for (const auto& [id, tear] : info->torn_submaps) {
    std::cout << "  " << DescribeTear(id, tear) << "\n";
  }
  return absl::OkStatus();
}

}  // namespace

Subcommand Info() {
  return Subcommand{
      "info",
      "what is in a map",
      "--input A.pbstream [--torn_submaps]",
      "Prints format, trajectories, submaps, constraints and records of a "
      "serialized state of Cartographer 2D, and on demand which submaps "
      "contradict themselves. Nothing is changed.",
      {"input"},
      {"torn_submaps", "configuration_directory", "configuration_basename",
       "threads"},
      &RunInfo};
}

}  // namespace cartographer_sdf
