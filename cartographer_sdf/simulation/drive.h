// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A tour of a robot through a floor plan that revisits places in the same and
// in the opposite direction.

#ifndef CARTOGRAPHER_SDF_SIMULATION_DRIVE_H_
#define CARTOGRAPHER_SDF_SIMULATION_DRIVE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/simulation/floor_plan.h"

namespace cartographer_sdf {

struct DriveOptions {
  // Length of the drive [m].
  double length = 360.;
  // Planned distance of the robot's centre to walls [m]. Following the path may
  // cut corners by up to 0.1 m.
  double clearance = 0.4;
  double speed = 0.5;      // [m/s]
  double turn_rate = 0.8;  // At most [rad/s].
  // Time between two poses [s].
  double time_step = 0.05;
};

[[nodiscard]] std::string Validate(const DriveOptions& options);

struct DrivenPose {
  double seconds = 0.;
  Rigid2 T_world_robot;
};

// Visits places far from each other on a round trip of 4/9 of the length, then
// drives its second half backwards and, after a short cut, its first half
// forwards again. Deterministic for a given seed. Fails if the plan has no room
// for a robot that keeps the clearance.
[[nodiscard]] absl::StatusOr<std::vector<DrivenPose>> Drive(
    const FloorPlan& plan, const DriveOptions& options, uint32_t seed);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SIMULATION_DRIVE_H_
