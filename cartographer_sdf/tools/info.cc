// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <iostream>

#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/map_summary.h"
#include "cartographer_sdf/tools/progress.h"
#include "cartographer_sdf/tools/subcommand.h"

namespace cartographer_sdf {
namespace {

absl::StatusOr<MapState> ReadWithProgress(const std::string& path) {
  Progress progress("read");
  return ReadMap(path, {}, progress.Callback());
}

absl::Status RunInfo() {
  const absl::StatusOr<MapState> map = ReadWithProgress(FLAGS_input);
  if (!map.ok()) return map.status();
  std::cout << DescribeMap(FLAGS_input, *map);
  return absl::OkStatus();
}

}  // namespace

Subcommand Info() {
  return Subcommand{
      "info",
      "what is in a map",
      "--input A.pbstream",
      "Prints format, trajectories, submaps, constraints and records of a "
      "serialized state of Cartographer 2D. Nothing is changed.",
      {"input"},
      {},
      &RunInfo};
}

}  // namespace cartographer_sdf
