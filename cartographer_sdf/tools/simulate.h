// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_TOOLS_SIMULATE_H_
#define CARTOGRAPHER_SDF_TOOLS_SIMULATE_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/simulation/drive.h"
#include "cartographer_sdf/simulation/lidar.h"
#include "cartographer_sdf/simulation/office.h"
#include "cartographer_sdf/simulation/people.h"

namespace cartographer_sdf {

struct SimulateArguments {
  std::string output_path;
  std::string truth_path;
  // A floor plan (PGM) and the side of its pixels [m]; absent: an invented
  // office.
  std::optional<std::string> plan_path;
  double plan_resolution = 0.05;
  OfficeOptions office;
  LidarOptions lidar;
  PeopleOptions people;
  // Way to go [m].
  double length = DriveOptions().length;
  // Of the office; and of the drive, drift and noise: sessions in one building
  // share the first and differ in the second.
  uint32_t plan_seed = 1;
  uint32_t drive_seed = 1;
};

// Writes a map with unclosed loops, and its truth.
[[nodiscard]] absl::Status RunSimulate(
    const SimulateArguments& arguments,
    const ProgressCallback& on_progress = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_SIMULATE_H_
