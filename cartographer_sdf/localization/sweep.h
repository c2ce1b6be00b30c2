// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What a robot sees from where it stands: one scan or a few, as beams that are
// spread evenly over all directions.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_SWEEP_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_SWEEP_H_

#include <Eigen/Core>
#include <vector>

#include "cartographer_sdf/grid/scan.h"

namespace cartographer_sdf {

// From a sensor to what it met, or, without an echo, as far as it would have
// seen something; robot frame [m].
struct RobotBeam {
  Eigen::Vector2d origin;
  Eigen::Vector2d end;
  bool has_echo;
};

// The beams of a robot that stands still, of each direction around the mean of
// the sensors at most one, in the order of directions.
struct Sweep {
  // Mean position of the sensors, robot frame [m].
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  std::vector<RobotBeam> beams;
  // Extent of the widest gap between the directions of two neighbouring beams
  // [rad].
  double widest_gap = 0.;
};

// Of points in one direction the nearest to the middle of the direction is
// kept, of echoes if there are any. Skips points that are not finite, nearer
// than 5 cm, or farther than `max_range` from the sensor.
[[nodiscard]] Sweep MakeSweep(const std::vector<RobotScan>& scans,
                              int num_directions, double max_range);

[[nodiscard]] int NumEchoes(const Sweep& sweep);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_SWEEP_H_
