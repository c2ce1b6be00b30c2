// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Scans -> a submap's probability grid, by the host's rules: each scan changes
// the odds of a cell once, as a hit if it holds one of the scan's points, else
// as a miss if a beam crosses it.

#ifndef CARTOGRAPHER_SDF_SIMULATION_SUBMAP_GRID_H_
#define CARTOGRAPHER_SDF_SIMULATION_SUBMAP_GRID_H_

#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/simulation/lidar.h"

namespace cartographer_sdf {

// The defaults are the host's.
struct SubmapGridOptions {
  double resolution = 0.05;
  double hit_probability = 0.55;
  double miss_probability = 0.49;
  // How far a beam without an echo is believed to have seen free space [m].
  double empty_beam_length = 5.;
};

[[nodiscard]] std::string Validate(const SubmapGridOptions& options);

struct PosedScan {
  Rigid2 T_submap_robot;
  // Not null; must outlive the call.
  const Scan* scan = nullptr;
};

// Cropped to the known cells; one unknown cell where nothing was seen. Cell
// borders lie on multiples of the resolution in the submap frame; probabilities
// are clamped to [0.1, 0.9].
[[nodiscard]] OccupancyGrid BuildSubmapGrid(const std::vector<PosedScan>& scans,
                                            const SubmapGridOptions& options);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SIMULATION_SUBMAP_GRID_H_
