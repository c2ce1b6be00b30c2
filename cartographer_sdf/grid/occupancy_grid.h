// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_GRID_OCCUPANCY_GRID_H_
#define CARTOGRAPHER_SDF_GRID_OCCUPANCY_GRID_H_

#include <Eigen/Core>

#include "cartographer_sdf/grid/cell_geometry.h"

namespace cartographer_sdf {

using BoolArray = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

// The occupancy probability of each cell of a submap, and whether the cell was
// observed at all. Both arrays have the size of the geometry.
struct OccupancyGrid {
  CellGeometry geometry;
  // In (0, 1) where known; meaningless elsewhere.
  Eigen::ArrayXXf probability;
  BoolArray known;
};

// Returns a grid of the given geometry with all cells unknown.
[[nodiscard]] inline OccupancyGrid UnknownGrid(const CellGeometry& geometry) {
  return OccupancyGrid{
      geometry,
      Eigen::ArrayXXf::Constant(geometry.size.x(), geometry.size.y(), 0.5f),
      BoolArray::Constant(geometry.size.x(), geometry.size.y(), false)};
}

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_GRID_OCCUPANCY_GRID_H_
