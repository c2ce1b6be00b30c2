// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A saved map as one grid, for localising scans in it.

#ifndef CARTOGRAPHER_SDF_APPS_MAP_GRID_H_
#define CARTOGRAPHER_SDF_APPS_MAP_GRID_H_

#include <Eigen/Core>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/execution/progress.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/pbstream/map_file.h"

namespace cartographer_sdf {

struct MapGrid {
  // The submap frame is the map frame.
  OccupancyGrid grid;
  // Of the nodes; where the robot was [m, map frame].
  std::vector<Eigen::Vector2d> driven_positions;
};

// Reads the file twice, so that memory holds one submap at a time. Fails as
// ReadMap does, and where nothing is known of the map.
[[nodiscard]] absl::StatusOr<MapGrid> ReadMapGrid(
    const MapSource& source, const ProgressCallback& on_progress = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_APPS_MAP_GRID_H_
