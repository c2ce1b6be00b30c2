// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/grid/turned_grid.h"

#include <cmath>

#include "gtest/gtest.h"
#include "test/testing/world.h"

namespace cartographer_sdf::turned_grid_test {
namespace {

// A disc off the origin, in a grid that lies askew in its submap.
OccupancyGrid Disc() {
  CellGeometry geometry = testing::CentredGeometry(120, 0.05, 0.3);
  return testing::Rasterise(testing::SolidDisc({1., 0.5}, 0.6), geometry, {},
                            {10., 10.});
}

Eigen::Vector2d MeanOfWalls(const OccupancyGrid& grid, int* const count) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  *count = 0;
  for (int j = 0; j < grid.geometry.size.y(); ++j) {
    for (int i = 0; i < grid.geometry.size.x(); ++i) {
      if (!grid.known(i, j) || grid.probability(i, j) < 0.5f) continue;
      sum += grid.geometry.CellCentre({i, j});
      ++*count;
    }
  }
  return sum / *count;
}

TEST(TurnedGridTest, TurnsTheContentAboutTheOrigin) {
  const OccupancyGrid grid = Disc();
  int num_before = 0;
  const Eigen::Vector2d before = MeanOfWalls(grid, &num_before);
  for (const double angle : {-3., -M_PI_2, 0.1, 1.2, M_PI}) {
    const OccupancyGrid turned = TurnedGrid(grid, angle);
    EXPECT_NEAR(turned.geometry.T_submap_grid.rotation(), 0.3, 1e-12);
    int num_after = 0;
    const Eigen::Vector2d after = MeanOfWalls(turned, &num_after);
    // Errors of some 450 cells' places are far below one cell in the mean.
    EXPECT_LT((after - Rigid2(0., 0., angle) * before).norm(), 0.02);
    // The area is kept, up to the disc's edge.
    EXPECT_NEAR(num_after, num_before, 0.01 * num_before);
    const int known_before = static_cast<int>(grid.known.count());
    const int known_after = static_cast<int>(turned.known.count());
    EXPECT_NEAR(known_after, known_before, 0.002 * known_before);
  }
}

TEST(TurnedGridTest, ByNothingItStaysAsItIs) {
  const OccupancyGrid grid = Disc();
  const OccupancyGrid same = TurnedGrid(grid, 0.);
  for (int j = 0; j < grid.geometry.size.y(); ++j) {
    for (int i = 0; i < grid.geometry.size.x(); ++i) {
      const Eigen::Array2i cell =
          same.geometry.CellAt(grid.geometry.CellCentre({i, j}));
      ASSERT_TRUE(same.geometry.Contains(cell));
      EXPECT_EQ(same.known(cell.x(), cell.y()), grid.known(i, j));
      EXPECT_EQ(same.probability(cell.x(), cell.y()), grid.probability(i, j));
    }
  }
}

TEST(TurnedGridTest, AnEmptyGridStaysEmpty) {
  const OccupancyGrid turned = TurnedGrid(UnknownGrid(CellGeometry()), 1.);
  EXPECT_EQ(turned.known.count(), 0);
}

}  // namespace
}  // namespace cartographer_sdf::turned_grid_test
