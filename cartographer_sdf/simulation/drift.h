// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// How a robot that drives in the dark loses its way: systematic errors per
// metre that add up, of odometry and of what local SLAM leaves of them.

#ifndef CARTOGRAPHER_SDF_SIMULATION_DRIFT_H_
#define CARTOGRAPHER_SDF_SIMULATION_DRIFT_H_

#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/simulation/drive.h"
#include "cartographer_sdf/simulation/random_numbers.h"

namespace cartographer_sdf {

// The defaults: a submap holds about 20 m of driving, of which a point is seen
// from some 10 m. A yaw rate error b bends walls seen over s metres by b s^2/2,
// 2 cm there after local SLAM, less than a cell; 300 m turn by 0.12 rad, which
// displaces rooms 30 m away by more than 3 m.
struct DriftOptions {
  // Signs are drawn once per drive.
  double odometry_scale_error = 0.006;
  double odometry_yaw_bias = 1.5e-3;  // [rad/m]
  // Standard deviation after one metre [rad/sqrt(m)].
  double odometry_yaw_noise = 1.5e-3;
  // Scan matching leaves this fraction of odometry's errors.
  double local_slam_fraction = 1. / 3.;
  // Standard deviations of each pose of local SLAM by itself [m, rad].
  double local_slam_noise_translation = 0.004;
  double local_slam_noise_rotation = 7e-4;
};

[[nodiscard]] std::string Validate(const DriftOptions& options);

struct DriftedPose {
  // From the start of the drive.
  Rigid2 T_odometry_robot;
  Rigid2 T_local_robot;
};

// One for each driven pose. Both frames coincide with the robot's first one,
// up to the noise of local SLAM.
[[nodiscard]] std::vector<DriftedPose> AddDrift(
    const std::vector<DrivenPose>& drive, const DriftOptions& options,
    RandomNumbers* random);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SIMULATION_DRIFT_H_
