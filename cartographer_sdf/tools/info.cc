// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <iostream>
#include <map>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/loop_closing/torn_submaps.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/map_summary.h"
#include "cartographer_sdf/tools/progress.h"
#include "cartographer_sdf/tools/stages.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"

DEFINE_bool(torn_submaps, false,
            "Look for submaps that local SLAM tore inside too: reads all "
            "scans, some seconds for a hundred submaps.");

namespace cartographer_sdf {
namespace {

absl::StatusOr<MapState> ReadWithProgress(const std::string& path) {
  Progress progress("read");
  return ReadMap(path, {}, progress.Callback());
}

absl::Status PrintTornSubmaps(const MapState& map) {
  const absl::StatusOr<Options> options = LoadOptionsOfFlags();
  if (!options.ok()) return options.status();
  const absl::StatusOr<int> num_threads = NumThreadsOfFlags();
  if (!num_threads.ok()) return num_threads.status();
  StageProgress progress;
  const absl::StatusOr<std::map<SubmapId, Tear>> torn = FindTornSubmaps(
      options->loop_closing.tear, FLAGS_input, map.pose_graph,
      MakeExecutor(*num_threads), progress.Begin("find torn submaps"));
  if (!torn.ok()) return torn.status();
  std::cout << absl::StrFormat("\nTorn submaps: %d\n", torn->size());
  for (const auto& [id, tear] : *torn) {
    std::cout << "  " << DescribeTear(id, tear) << "\n";
  }
  return absl::OkStatus();
}

absl::Status RunInfo() {
  const absl::StatusOr<MapState> map = ReadWithProgress(FLAGS_input);
  if (!map.ok()) return map.status();
  std::cout << DescribeMap(FLAGS_input, *map);
  return FLAGS_torn_submaps ? PrintTornSubmaps(*map) : absl::OkStatus();
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
