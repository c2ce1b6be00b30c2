// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/map_grid.h"

#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/two_offices.h"

namespace cartographer_sdf::map_grid_test {
namespace {

using ::testing::HasSubstr;

TEST(MapGridTest, IsFreeWhereTheRobotDrove) {
  const testing::TemporaryDirectory directory;
  const std::string path = directory.File("map.pbstream");
  testing::WriteShortDrive(testing::MakeSmallOffice(1), 1, path);
  double progress = 0.;
  const absl::StatusOr<MapGrid> map =
      ReadMapGrid(path, [&](const double fraction) { progress = fraction; });
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_NEAR(progress, 1., 0.01);
  ASSERT_FALSE(map->driven_positions.empty());
  const OccupancyGrid& grid = map->grid;
  size_t num_free = 0;
  for (const Eigen::Vector2d& position : map->driven_positions) {
    const Eigen::Array2i cell = grid.geometry.CellAt(position);
    ASSERT_TRUE(grid.geometry.Contains(cell));
    num_free += grid.known(cell.x(), cell.y()) &&
                grid.probability(cell.x(), cell.y()) < 0.5f;
  }
  EXPECT_GT(static_cast<double>(num_free),
            0.95 * static_cast<double>(map->driven_positions.size()));
}

TEST(MapGridTest, FailsWithoutSubmaps) {
  const testing::TemporaryDirectory directory;
  const std::string path = directory.File("map.pbstream");
  testing::WriteShortDrive(testing::MakeSmallOffice(1), 1, path,
                           /*with_submaps=*/false);
  const absl::StatusOr<MapGrid> map = ReadMapGrid(path);
  ASSERT_FALSE(map.ok());
  EXPECT_THAT(std::string(map.status().message()), HasSubstr("no submap"));
  EXPECT_FALSE(ReadMapGrid(directory.File("absent")).ok());
}

}  // namespace
}  // namespace cartographer_sdf::map_grid_test
