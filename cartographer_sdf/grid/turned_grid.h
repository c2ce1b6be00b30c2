// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_GRID_TURNED_GRID_H_
#define CARTOGRAPHER_SDF_GRID_TURNED_GRID_H_

#include "cartographer_sdf/grid/occupancy_grid.h"

namespace cartographer_sdf {

// The content of a grid turned about the submap's origin, in cells that keep
// their direction, as if the submap had been built from there on another
// heading: each cell takes over the cell of the source that holds its centre
// (nearest sampling, probability and knowledge alike). A point p of the source
// is found at Rigid2(0, 0, angle) * p, to half the diagonal of a cell.
[[nodiscard]] OccupancyGrid TurnedGrid(const OccupancyGrid& source,
                                       double angle);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_GRID_TURNED_GRID_H_
