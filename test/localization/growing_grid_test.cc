// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/growing_grid.h"

#include <vector>

#include "gtest/gtest.h"

namespace cartographer_sdf::growing_grid_test {
namespace {

constexpr double kWindow = 4.;

// Drives a metre straight on between scans. The sensor is mounted backwards,
// ahead of the node; it sees a wall 2 m behind the node and nothing on the
// left.
const Rigid2 kNodeSensor(0.21, 0.02, M_PI);  // T_node_sensor
DrivenScan MakeScan(const int k, const Rigid2& T_local_start = Rigid2()) {
  DrivenScan scan;
  scan.node = {3, k};
  scan.T_local_node = T_local_start * Rigid2(k, 0., 0.);
  scan.T_local_sensor = scan.T_local_node * kNodeSensor;
  scan.scan.returns = {{2.19f, 0.f}, {2.19f, 0.1f}};
  scan.scan.misses = {{0.f, -1.5f}};
  scan.distance_driven = k;
  return scan;
}

bool IsWall(const OccupancyGrid& grid, const Eigen::Vector2d& p_submap) {
  const Eigen::Array2i cell = grid.geometry.CellAt(p_submap);
  return grid.geometry.Contains(cell) && grid.known(cell.x(), cell.y()) &&
         grid.probability(cell.x(), cell.y()) > 0.5f;
}

TEST(GrowingGridTest, LiesInTheFrameOfTheOldestNode) {
  for (const Rigid2& T_local_start : {Rigid2(), Rigid2(40., -7., 2.)}) {
    GrowingGrid growing(ScanGridOptions(), kWindow);
    for (const int k : {0, 1}) growing.Insert(MakeScan(k, T_local_start));
    EXPECT_EQ(growing.T_local_submap().translation(),
              T_local_start.translation());
    const std::optional<OccupancyGrid> grid = growing.Copy();
    ASSERT_TRUE(grid);
    // Cells follow the local frame.
    EXPECT_NEAR(grid->geometry.T_submap_grid.rotation(),
                -T_local_start.rotation(), 1e-12);
    EXPECT_TRUE(IsWall(*grid, {-1.98, 0.02}));
    EXPECT_TRUE(IsWall(*grid, {-0.98, 0.02}));
    EXPECT_FALSE(IsWall(*grid, {-1.48, 0.02}));
  }
}

TEST(GrowingGridTest, LetsTheOlderHalfGo) {
  GrowingGrid growing(ScanGridOptions(), kWindow);
  for (int k = 0; k <= 4; ++k) growing.Insert(MakeScan(k));
  EXPECT_EQ(growing.scans().size(), 5u);
  EXPECT_TRUE(IsWall(*growing.Copy(), {-1.98, 0.02}));

  growing.Insert(MakeScan(5));
  ASSERT_EQ(growing.scans().size(), 3u);
  EXPECT_EQ(growing.scans().front().node, (NodeId{3, 3}));
  EXPECT_EQ(growing.T_local_submap().translation().x(), 3.);
  // Nothing but the scans of nodes 3, 4 and 5.
  const std::optional<OccupancyGrid> grid = growing.Copy();
  ASSERT_TRUE(grid);
  GrowingGrid anew(ScanGridOptions(), kWindow);
  for (int k = 3; k <= 5; ++k) anew.Insert(MakeScan(k));
  const std::optional<OccupancyGrid> expected = anew.Copy();
  ASSERT_TRUE((grid->geometry.size == expected->geometry.size).all());
  EXPECT_TRUE((grid->known == expected->known).all());
  EXPECT_TRUE((grid->probability == expected->probability).all());
  EXPECT_TRUE(IsWall(*grid, {-1.98, 0.02}));
  EXPECT_TRUE(IsWall(*grid, {0.02, 0.02}));

  for (int k = 6; k <= 10; ++k) growing.Insert(MakeScan(k));
  // 0 to 4, 3 to 7, 6 to 10.
  EXPECT_EQ(growing.scans().front().node, (NodeId{3, 6}));
  EXPECT_EQ(growing.scans().size(), 5u);
}

TEST(GrowingGridTest, ALongLeapLeavesTheNewestScan) {
  GrowingGrid growing(ScanGridOptions(), kWindow);
  growing.Insert(MakeScan(0));
  growing.Insert(MakeScan(1000));
  ASSERT_EQ(growing.scans().size(), 1u);
  EXPECT_TRUE(IsWall(*growing.Copy(), {-1.98, 0.02}));
}

TEST(GrowingGridTest, WithoutPointsThereIsNoGrid) {
  GrowingGrid growing(ScanGridOptions(), kWindow);
  EXPECT_FALSE(growing.Copy());
  DrivenScan blind = MakeScan(0);
  blind.scan = Scan();
  growing.Insert(blind);
  EXPECT_EQ(growing.scans().size(), 1u);
  EXPECT_FALSE(growing.Copy());
  growing.Insert(MakeScan(1));
  EXPECT_TRUE(growing.Copy());
}

}  // namespace
}  // namespace cartographer_sdf::growing_grid_test
