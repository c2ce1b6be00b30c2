// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/drift.h"

#include <cmath>

#include "cartographer_sdf/geometry/number_range.h"
#include "glog/logging.h"

namespace cartographer_sdf {

std::string Validate(const DriftOptions& options) {
  return FirstOutside(
      {{"odometry_scale_error", options.odometry_scale_error, -0.5, 0.5},
       {"odometry_yaw_bias", options.odometry_yaw_bias, -1., 1.},
       {"odometry_yaw_noise", options.odometry_yaw_noise, 0., 1.},
       {"local_slam_fraction", options.local_slam_fraction, 0., 1.},
       {"local_slam_noise_translation", options.local_slam_noise_translation,
        0., 1.},
       {"local_slam_noise_rotation", options.local_slam_noise_rotation, 0.,
        1.}});
}

std::vector<DriftedPose> AddDrift(const std::vector<DrivenPose>& drive,
                                  const DriftOptions& options,
                                  RandomNumbers* const random) {
  CHECK_EQ(Validate(options), "");
  const double scale_error = random->Chance(0.5)
                                 ? options.odometry_scale_error
                                 : -options.odometry_scale_error;
  const double yaw_bias = random->Chance(0.5) ? options.odometry_yaw_bias
                                              : -options.odometry_yaw_bias;
  Rigid2 T_odometry_robot, T_local_robot;
  std::vector<DriftedPose> drifted;
  for (size_t k = 0; k != drive.size(); ++k) {
    if (k != 0) {
      const Rigid2 T_previous_robot =
          drive[k - 1].T_world_robot.Inverse() * drive[k].T_world_robot;
      const double distance = T_previous_robot.translation().norm();
      const double yaw_error =
          yaw_bias * distance +
          options.odometry_yaw_noise * std::sqrt(distance) * random->Normal();
      const auto disturb = [&](const double fraction) {
        return Rigid2(
            (1. + fraction * scale_error) * T_previous_robot.translation(),
            T_previous_robot.rotation() + fraction * yaw_error);
      };
      T_odometry_robot = T_odometry_robot * disturb(1.);
      T_local_robot = T_local_robot * disturb(options.local_slam_fraction);
    }
    const double x = options.local_slam_noise_translation * random->Normal();
    const double y = options.local_slam_noise_translation * random->Normal();
    const double yaw = options.local_slam_noise_rotation * random->Normal();
    drifted.push_back({T_odometry_robot, T_local_robot * Rigid2(x, y, yaw)});
  }
  return drifted;
}

}  // namespace cartographer_sdf
