// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef TEST_TESTING_ASCII_GRID_H_
#define TEST_TESTING_ASCII_GRID_H_

#include <string>
#include <vector>

#include "cartographer_sdf/grid/occupancy_grid.h"

namespace cartographer_sdf::testing {

// A grid as it is drawn: x to the right, y upwards; '#' is occupied, '.' free,
// anything else unknown.
inline OccupancyGrid AsciiGrid(const std::vector<std::string>& rows,
                               const double resolution = 0.05) {
  CellGeometry geometry;
  geometry.resolution = resolution;
  const int height = static_cast<int>(rows.size());
  geometry.size = {rows.empty() ? 0 : static_cast<int>(rows[0].size()), height};
  OccupancyGrid grid = UnknownGrid(geometry);
  for (int j = 0; j < height; ++j) {
    const std::string& row = rows[height - 1 - j];
    for (int i = 0; i < geometry.size.x(); ++i) {
      grid.known(i, j) = row.at(i) == '#' || row.at(i) == '.';
      grid.probability(i, j) = row.at(i) == '#' ? 0.9f : 0.1f;
    }
  }
  return grid;
}

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_ASCII_GRID_H_
