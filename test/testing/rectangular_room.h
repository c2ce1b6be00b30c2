// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef TEST_TESTING_RECTANGULAR_ROOM_H_
#define TEST_TESTING_RECTANGULAR_ROOM_H_

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "cartographer_sdf/grid/occupancy_grid.h"

// A rectangular room around the origin of the submap frame, `width` x `height`
// [m] inside, with walls of `wall` [m]; unknown beyond its walls.
inline cartographer_sdf::OccupancyGrid RectangularRoom(
    const double width, const double height, const double wall,
    const cartographer_sdf::CellGeometry& geometry) {
  cartographer_sdf::OccupancyGrid grid =
      cartographer_sdf::UnknownGrid(geometry);
  for (int j = 0; j < geometry.size.y(); ++j) {
    for (int i = 0; i < geometry.size.x(); ++i) {
      const Eigen::Vector2d p = geometry.CellCentre({i, j});
      const double outside = std::max(std::abs(p.x()) - 0.5 * width,
                                      std::abs(p.y()) - 0.5 * height);
      if (outside > wall) continue;
      grid.known(i, j) = true;
      grid.probability(i, j) = outside > 0. ? 0.9f : 0.1f;
    }
  }
  return grid;
}

#endif  // TEST_TESTING_RECTANGULAR_ROOM_H_
