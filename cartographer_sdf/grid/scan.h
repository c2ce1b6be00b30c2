// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_GRID_SCAN_H_
#define CARTOGRAPHER_SDF_GRID_SCAN_H_

#include <Eigen/Core>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"

namespace cartographer_sdf {

// One scan of a planar range sensor, in the sensor frame [m]. Lost beams are
// absent.
struct Scan {
  // Points hit.
  std::vector<Eigen::Vector2f> returns;
  // End points of beams without an echo, at the range of the sensor.
  std::vector<Eigen::Vector2f> misses;
};

// A scan and the pose at which it was inserted into a submap.
struct PlacedScan {
  Rigid2 T_submap_sensor;
  Scan scan;
};

// A scan of one of the sensors of a robot.
struct RobotScan {
  Rigid2 T_robot_sensor;
  Scan scan;
};

// What the sensors of a robot see at one time.
struct OdometryScan {
  double time = 0.;  // [s], of any origin
  // Of wheels or of local SLAM; drifts.
  Rigid2 T_odometry_robot;
  std::vector<RobotScan> scans;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_GRID_SCAN_H_
