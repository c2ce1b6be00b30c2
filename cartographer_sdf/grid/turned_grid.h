// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_GRID_TURNED_GRID_H_
#define CARTOGRAPHER_SDF_GRID_TURNED_GRID_H_

#include "cartographer_sdf/grid/occupancy_grid.h"

namespace cartographer_sdf {

// Returns the grid rotated about the submap's origin, on cells with unchanged
// axes, as if the submap had been built with another heading. Each cell copies
// probability and knowledge from the source cell that contains its centre
// (nearest neighbour). A point p of the source moves to
// Rigid2(0, 0, angle) * p, to within half the diagonal of a cell.
[[nodiscard]] OccupancyGrid TurnedGrid(const OccupancyGrid& source,
                                       double angle);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_GRID_TURNED_GRID_H_
