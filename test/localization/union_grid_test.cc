// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/union_grid.h"

#include <cmath>
#include <optional>

#include "gtest/gtest.h"
#include "test/testing/ascii_grid.h"

namespace cartographer_sdf::union_grid_test {
namespace {

using testing::AsciiGrid;

std::optional<OccupancyGrid> Unite(
    const std::vector<std::pair<OccupancyGrid, Rigid2>>& submaps) {
  std::vector<GridFootprint> footprints;
  for (const auto& [grid, pose] : submaps) {
    footprints.push_back({grid.geometry, pose});
  }
  UnionGrid united(footprints);
  for (const auto& [grid, pose] : submaps) united.Add(grid, pose);
  return united.Finish();
}

// '#' wall, '.' free, ' ' unknown or outside.
char At(const OccupancyGrid& grid, const double x, const double y) {
  const Eigen::Array2i cell = grid.geometry.CellAt({x, y});
  if (!grid.geometry.Contains(cell) || !grid.known(cell.x(), cell.y())) {
    return ' ';
  }
  return grid.probability(cell.x(), cell.y()) > 0.5f ? '#' : '.';
}

TEST(UnionGridTest, PutsSubmapsWhereTheyAre) {
  const OccupancyGrid grid = AsciiGrid({"..#", "..."}, 1.);
  const auto united =
      Unite({{grid, Rigid2()}, {grid, Rigid2(10., 5., 0.5 * M_PI)}});
  ASSERT_TRUE(united);
  EXPECT_EQ(At(*united, 2.5, 1.5), '#');
  EXPECT_EQ(At(*united, 0.5, 0.5), '.');
  // (2.5, 1.5) turned to (-1.5, 2.5).
  EXPECT_EQ(At(*united, 8.5, 7.5), '#');
  EXPECT_EQ(At(*united, 9.5, 5.5), '.');
  EXPECT_EQ(At(*united, 5., 5.), ' ');
}

TEST(UnionGridTest, AWallIsWhatHalfOfTheSubmapsSee) {
  const OccupancyGrid wall = AsciiGrid({"#"}, 1.), free = AsciiGrid({"."}, 1.);
  const Rigid2 pose;
  EXPECT_EQ(At(*Unite({{wall, pose}, {free, pose}}), 0.5, 0.5), '#');
  EXPECT_EQ(At(*Unite({{wall, pose}, {free, pose}, {free, pose}}), 0.5, 0.5),
            '.');
}

TEST(UnionGridTest, LeavesOutWhatIsAbsurd) {
  const OccupancyGrid grid = AsciiGrid({".#"}, 1.);
  const auto united = Unite({{grid, Rigid2()},
                             {grid, Rigid2(1e300, 0., 0.)},
                             {grid, Rigid2(NAN, 0., 0.)},
                             {AsciiGrid({}), Rigid2()}});
  ASSERT_TRUE(united);
  EXPECT_LE(united->geometry.size.maxCoeff(), 3);
  EXPECT_FALSE(Unite({}));
  EXPECT_FALSE(Unite({{grid, Rigid2(NAN, 0., 0.)}}));
  EXPECT_FALSE(Unite({{AsciiGrid({"  "}), Rigid2()}}));
}

TEST(UnionGridTest, ALargeMapGetsLargerCellsAndKeepsItsThinWalls) {
  // 6 m of free space with a wall of one cell in the middle.
  OccupancyGrid grid = UnknownGrid({{120, 60}, 0.05, Rigid2()});
  grid.known.setConstant(true);
  grid.probability.setConstant(0.1f);
  grid.probability.row(60).setConstant(0.9f);
  const auto united =
      Unite({{grid, Rigid2()}, {grid, Rigid2(2000., 2000., 0.)}});
  ASSERT_TRUE(united);
  EXPECT_LE(united->known.size(), UnionGrid::kMaxNumCells);
  EXPECT_GT(united->geometry.resolution, 0.2);
  EXPECT_EQ(At(*united, 1., 1.5), '.');
  EXPECT_EQ(At(*united, 3.02, 1.5), '#');
  EXPECT_EQ(At(*united, 5., 1.5), '.');
}

}  // namespace
}  // namespace cartographer_sdf::union_grid_test
