// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_GRID_SCAN_H_
#define CARTOGRAPHER_SDF_GRID_SCAN_H_

#include <Eigen/Core>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"

namespace cartographer_sdf {

// What a planar range sensor sees at once, in its own frame [m]. Beams that
// were lost are absent.
struct Scan {
  // Points hit.
  std::vector<Eigen::Vector2f> returns;
  // Where the beams without an echo end: as far as the sensor looks.
  std::vector<Eigen::Vector2f> misses;
};

// A scan as it was inserted into a submap.
struct PlacedScan {
  Rigid2 T_submap_sensor;
  Scan scan;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_GRID_SCAN_H_
