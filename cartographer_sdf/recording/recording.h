// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What a robot with wheels and a planar laser recorded, as plain data.

#ifndef CARTOGRAPHER_SDF_RECORDING_RECORDING_H_
#define CARTOGRAPHER_SDF_RECORDING_RECORDING_H_

#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"

namespace cartographer_sdf {

struct LaserScan {
  // Seconds of Unix time.
  double time = 0.;
  // Where the wheels' odometry saw the robot; drifts.
  Rigid2 T_odometry_robot;
  // Of the beams in their order, not negative. Where nothing was hit, laser
  // scanners report a range beyond their reach.
  std::vector<double> ranges;
};

struct Recording {
  // Direction of the first beam against the robot's, and from one beam to the
  // next [rad]. The laser is taken to be in the middle of the robot.
  double first_angle = 0.;
  double angle_increment = 0.;
  // In order of time, no two at the same time; all of one number of beams.
  std::vector<LaserScan> scans;
  // Scans of the file that are not here, because they were not later than the
  // ones before.
  int num_dropped_scans = 0;
  // The times are the recording's own; else its scans were only counted.
  bool has_clock = false;
};

// The scans from `start` seconds after the first one on, for `duration`
// seconds.
[[nodiscard]] Recording Cut(const Recording& recording, double start,
                            double duration);

// Cartographer's pose extrapolator expects wheels and gyroscope to report far
// more often than the laser. Where a recording has odometry with its scans
// only, what lies between is interpolated.
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

// The length of the odometry's path [m] until each scan.
[[nodiscard]] std::vector<double> MetersDriven(const Recording& recording);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECORDING_RECORDING_H_
