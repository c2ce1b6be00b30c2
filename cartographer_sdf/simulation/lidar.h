// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A planar lidar in a floor plan. Exact in the raster: a range is the distance
// to the side of the first occupied cell, plus noise.

#ifndef CARTOGRAPHER_SDF_SIMULATION_LIDAR_H_
#define CARTOGRAPHER_SDF_SIMULATION_LIDAR_H_

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/scan.h"
#include "cartographer_sdf/simulation/floor_plan.h"
#include "cartographer_sdf/simulation/people.h"
#include "cartographer_sdf/simulation/random_numbers.h"

namespace cartographer_sdf {

struct LidarOptions {
  int num_beams = 360;
  // Centred on the direction of travel [rad].
  double field_of_view = 1.5 * M_PI;
  double max_range = 20.;
  // Standard deviation [m].
  double range_noise = 0.015;
  // Fraction of beams that are lost.
  double drop_outs = 0.005;
  // Fraction of the beams on glass that return from it; the others pass
  // through. Independent of the angle.
  double glass_echo = 0.3;
};

[[nodiscard]] std::string Validate(const LidarOptions& options);

// Distance from a point to the first occupied cell in a direction (of unit
// norm). Skips unseen cells and, if `through_glass`, glass. None if there is no
// such cell within `max_range` and the plan.
[[nodiscard]] std::optional<double> CastRay(const FloorPlan& plan,
                                            const Eigen::Vector2d& p_world,
                                            const Eigen::Vector2d& direction,
                                            double max_range,
                                            bool through_glass = false);

// In the robot frame; misses end at the largest range. `people` occlude walls.
[[nodiscard]] Scan TakeScan(const FloorPlan& plan,
                            const std::vector<Person>& people,
                            const Rigid2& T_world_robot,
                            const LidarOptions& options, RandomNumbers* random);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SIMULATION_LIDAR_H_
