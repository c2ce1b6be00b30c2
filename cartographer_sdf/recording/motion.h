// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Cartographer's pose extrapolator expects wheels and gyroscope to report far
// more often than the laser. Where a recording has odometry with its scans
// only, what lies between is interpolated.

#ifndef CARTOGRAPHER_SDF_RECORDING_MOTION_H_
#define CARTOGRAPHER_SDF_RECORDING_MOTION_H_

#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/recording/recording.h"

namespace cartographer_sdf {

struct MotionSample {
  double time = 0.;
  Rigid2 T_odometry_robot;
  // [rad/s], counterclockwise.
  double yaw_rate = 0.;
};

// From after `first` to the time of `second`, evenly, at a constant velocity
// and yaw rate, at most 0.05 s and a quarter of the interval apart. In
// intervals of more than a minute there are no more samples than in one.
[[nodiscard]] std::vector<MotionSample> MotionBetween(const LaserScan& first,
                                                      const LaserScan& second);

// The length of the odometry's path [m]
// until each scan.
[[nodiscard]] std::vector<double> DrivenDistances(const Recording& recording);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECORDING_MOTION_H_
