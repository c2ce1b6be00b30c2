// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A recording of a wheeled robot with a planar laser, as plain data.

#ifndef CARTOGRAPHER_SDF_RECORDING_RECORDING_H_
#define CARTOGRAPHER_SDF_RECORDING_RECORDING_H_

#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/scan.h"

namespace cartographer_sdf {

struct LaserScan {
  // Unix time [s].
  double time = 0.;
  // Robot pose by wheel odometry; drifts.
  Rigid2 T_odometry_robot;
  // One per beam, in beam order, non-negative [m]. Where nothing was hit, laser
  // scanners report a range beyond their maximum.
  std::vector<double> ranges;
};

struct Recording {
  // Direction of the first beam in the robot frame, and the angle between
  // consecutive beams [rad]. The laser is assumed to be at the centre of the
  // robot.
  double first_angle = 0.;
  double angle_increment = 0.;
  // In time order, with distinct times; all have the same number of beams.
  std::vector<LaserScan> scans;
  // Scans of the file that were dropped because they were not later than their
  // predecessors.
  int num_dropped_scans = 0;
  // Whether the file has measured times; if false, they were derived from scan
  // numbers.
  bool has_clock = false;
};

// Returns the scans from `start` seconds after the first one, for `duration`
// seconds.
[[nodiscard]] Recording Cut(const Recording& recording, double start,
                            double duration);

// Cartographer's pose extrapolator expects wheel odometry and a gyroscope at a
// far higher rate than the laser. Where a recording has odometry only at its
// scans, MotionBetween interpolates.
struct MotionSample {
  double time = 0.;
  Rigid2 T_odometry_robot;
  // [rad/s], counterclockwise.
  double yaw_rate = 0.;
};

// Returns evenly spaced samples from after `first` up to and including
// `second`, at constant velocity and yaw rate, at most 0.05 s and a quarter of
// the interval apart. Intervals of more than a minute get no more samples than
// one minute.
[[nodiscard]] std::vector<MotionSample> MotionBetween(const LaserScan& first,
                                                      const LaserScan& second);

// Returns the length of the odometry path [m] up to each scan.
[[nodiscard]] std::vector<double> MetersDriven(const Recording& recording);

// Returns the scans as points. The range that a scanner reports where it met
// nothing is the greatest of the recording, if one in a thousand beams and more
// have it: such beams met nothing up to the greatest other range.
[[nodiscard]] std::vector<OdometryScan> OdometryScansOf(
    const Recording& recording);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECORDING_RECORDING_H_
