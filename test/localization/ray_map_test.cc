// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/ray_map.h"

#include <cmath>

#include "gtest/gtest.h"
#include "test/testing/drawn_map.h"

namespace cartographer_sdf::ray_map_test {
namespace {

// 4 m x 2 m at 0.1 m, free but for a wall of one cell at its right end, and
// unknown space behind a line at half of the height.
class RayMapTest : public ::testing::Test {
 protected:
  RayMapTest() {
    OccupancyGrid grid = UnknownGrid({{40, 20}, 0.1, Rigid2()});
    grid.known.leftCols(10).setConstant(true);
    grid.probability.leftCols(10).setConstant(0.1f);
    grid.probability.block(39, 0, 1, 10).setConstant(0.9f);
    map_ = *MakeRayMap(grid);
  }
  // Position in metres of the grid; range in metres.
  [[nodiscard]] Ray Cast(const double x, const double y, const double angle,
                         const double max_range = 10.,
                         const bool stops_at_grazed = false) const {
    const Eigen::Vector2d begin =
        map_.geometry().GridToCells(map_.geometry().T_submap_grid.Inverse() *
                                    Eigen::Vector2d(x, y)) +
        Eigen::Vector2d::Constant(0.5);
    Ray ray = CastRay(map_, begin, {std::cos(angle), std::sin(angle)},
                      max_range / 0.1, stops_at_grazed);
    ray.range *= 0.1;
    return ray;
  }
  RayMap map_;
};

TEST_F(RayMapTest, EndsAtAWall) {
  const Ray ray = Cast(1., 0.5, 0.);
  EXPECT_EQ(ray.end, RayEnd::kWall);
  EXPECT_NEAR(ray.range, 2.9, 0.06);
}

TEST_F(RayMapTest, EndsWhereTheMapIsUnknown) {
  const Ray up = Cast(1., 0.5, 0.5 * M_PI);
  EXPECT_EQ(up.end, RayEnd::kUnknown);
  EXPECT_NEAR(up.range, 0.5, 0.06);
  const Ray outside = Cast(1., 0.5, M_PI);
  EXPECT_EQ(outside.end, RayEnd::kUnknown);
  EXPECT_NEAR(outside.range, 1., 0.06);
}

TEST_F(RayMapTest, EndsAtItsGreatestRange) {
  const Ray ray = Cast(1., 0.5, 0., 2.);
  EXPECT_EQ(ray.end, RayEnd::kOpen);
  EXPECT_DOUBLE_EQ(ray.range, 2.);
}

TEST(RayMapOfBuildingTest, ARayAlongAWallPassesIt) {
  // A wall along x from 1 to 3 m, of one cell, and one across at 6 m.
  OccupancyGrid grid = UnknownGrid({{140, 40}, 0.05, Rigid2()});
  grid.known.setConstant(true);
  grid.probability.setConstant(0.1f);
  grid.probability.block(20, 20, 40, 1).setConstant(0.9f);
  grid.probability.block(120, 0, 1, 40).setConstant(0.9f);
  const std::optional<RayMap> map = MakeRayMap(grid);
  ASSERT_TRUE(map);
  const auto cast = [&](const double y, const double angle,
                        const bool stops_at_grazed) {
    const Eigen::Vector2d p = map->geometry().T_submap_grid.Inverse() *
                              Eigen::Vector2d(1.8, y) / 0.05;
    Ray ray = CastRay(*map, p, {std::cos(angle), std::sin(angle)}, 200.,
                      stops_at_grazed);
    ray.range *= 0.05;
    return ray;
  };
  // It comes in flat over the wall's middle, and leaves on the other side.
  const Ray grazing = cast(0.965, 0.2, false);
  EXPECT_EQ(grazing.end, RayEnd::kWall);
  EXPECT_GT(grazing.range, 3.5);
  EXPECT_LT(cast(0.965, 0.2, true).range, 0.5);
  // Straight across it is a wall.
  const Eigen::Vector2d below = map->geometry().T_submap_grid.Inverse() *
                                Eigen::Vector2d(2.5, 0.3) / 0.05;
  EXPECT_NEAR(0.05 * CastRay(*map, below, {0., 1.}, 200., false).range, 0.7,
              0.06);
}

TEST(RayMapOfBuildingTest, NeedsWallsAndFreeSpace) {
  OccupancyGrid grid = UnknownGrid({{4, 4}, 0.1, Rigid2()});
  EXPECT_FALSE(MakeRayMap(grid));
  grid.known.setConstant(true);
  grid.probability.setConstant(0.9f);
  EXPECT_FALSE(MakeRayMap(grid));
  grid.probability(1, 1) = 0.1f;
  EXPECT_TRUE(MakeRayMap(grid));
}

// The distance to where a ray enters a wall.
TEST(RayMapOfBuildingTest, AgreesWithTheBuilding) {
  const testing::Building building = testing::TwoRooms();
  const OccupancyGrid grid = testing::TwoRoomsGrid();
  const std::optional<RayMap> map = MakeRayMap(grid);
  ASSERT_TRUE(map);
  const Eigen::Vector2d position(3., 2.);
  int num_agreeing = 0, num_beams = 0;
  for (const testing::Beam& beam :
       testing::CastBeams(building, position, 200)) {
    if (!beam.range) continue;
    const Eigen::Vector2d begin =
        map->geometry().T_submap_grid.Inverse() * position / 0.05;
    const Ray ray = CastRay(*map, begin, beam.direction, 1e3, true);
    ++num_beams;
    num_agreeing += ray.end == RayEnd::kWall &&
                    std::abs(0.05 * ray.range - *beam.range) < 0.12;
  }
  EXPECT_GT(num_agreeing, 0.93 * num_beams);
}

}  // namespace
}  // namespace cartographer_sdf::ray_map_test
