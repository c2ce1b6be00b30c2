// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Drift of a simulated robot: errors per metre that accumulate, in odometry
// and, reduced by scan matching, in local SLAM.

#ifndef CARTOGRAPHER_SDF_SIMULATION_DRIFT_H_
#define CARTOGRAPHER_SDF_SIMULATION_DRIFT_H_

#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/simulation/drive.h"
#include "cartographer_sdf/simulation/random_numbers.h"

namespace cartographer_sdf {

// Rationale of the defaults: a submap covers about 22 m of driving, so walls
// near its middle are seen from up to 11 m to either side. A yaw error of b per
// metre displaces walls seen over s metres by b s^2 / 2: after local SLAM by 3
// cm, less than a cell. Over 360 m it rotates the map by 0.18 rad, which shifts
// parts of a 40 m building by metres.
struct DriftOptions {
  // Signs are drawn once per drive.
  double odometry_scale_error = 0.004;
  double odometry_yaw_bias = 1e-3;  // [rad/m]
  // Standard deviation after one metre [rad/sqrt(m)].
  double odometry_yaw_noise = 1e-3;
  // Fraction of odometry's errors that remains after scan matching.
  double local_slam_fraction = 0.5;
  // Standard deviations of the independent noise of each local SLAM pose [m,
  // rad].
  double local_slam_noise_translation = 0.004;
  double local_slam_noise_rotation = 7e-4;
};

[[nodiscard]] std::string Validate(const DriftOptions& options);

struct DriftedPose {
  // Poses since the start of the drive.
  Rigid2 T_odometry_robot;
  Rigid2 T_local_robot;
};

// Returns one pose for each driven pose. Both frames coincide with the robot's
// first frame, up to the noise of local SLAM.
[[nodiscard]] std::vector<DriftedPose> AddDrift(
    const std::vector<DrivenPose>& drive, const DriftOptions& options,
    RandomNumbers* random);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SIMULATION_DRIFT_H_
