// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/echo_search.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gtest/gtest.h"
#include "test/testing/drawn_map.h"

namespace cartographer_sdf::echo_search_test {
namespace {

class EchoSearchTest : public ::testing::Test {
 protected:
  EchoSearchTest() : rays_(*MakeRayMap(testing::TwoRoomsGrid())) {
    viewpoints_ = MakeViewpoints({}, rays_, ReachableCells(rays_, 0.15, {}));
    map_ = MakeEchoMap(rays_, viewpoints_);
  }
  [[nodiscard]] std::vector<Rigid2> Search(const RobotScan& scan,
                                           const size_t max_num_poses) const {
    std::vector<Rigid2> poses = SearchEchoes(
        map_, MakeSweep({scan}, kNumDirections, 60.), max_num_poses);
    for (Rigid2& pose : poses) pose = rays_.geometry().T_submap_grid * pose;
    return poses;
  }
  [[nodiscard]] bool Finds(const RobotScan& scan, const Rigid2& truth,
                           const size_t max_num_poses) const {
    return testing::HasPoseNear(Search(scan, max_num_poses), truth);
  }
  RayMap rays_;
  Viewpoints viewpoints_;
  EchoMap map_;
};

TEST_F(EchoSearchTest, TheRightPoseIsAmongTheFirst) {
  for (const Rigid2& truth : {Rigid2(2., 1.7, 0.3), Rigid2(12.2, 3.1, 1.)}) {
    EXPECT_TRUE(Finds(testing::ScanFrom(testing::TwoRooms(), truth), truth, 5))
        << truth;
  }
}

TEST_F(EchoSearchTest, SensorsBesideTheCentreOfTheRobotAreNoMatter) {
  const Rigid2 truth(2., 1.7, 0.3), T_robot_sensor(0.8, -0.3, 1.2);
  RobotScan scan =
      testing::ScanFrom(testing::TwoRooms(), truth * T_robot_sensor);
  scan.T_robot_sensor = T_robot_sensor;
  EXPECT_TRUE(Finds(scan, truth, 5));
}

// Of every two beams one ends at a leg of a chair, where the map has none.
TEST_F(EchoSearchTest, FindsARobotAmongChairs) {
  const Rigid2 truth(12.2, 3.1, 1.);
  RobotScan scan = testing::ScanFrom(testing::TwoRooms(), truth);
  for (size_t k = 0; k < scan.scan.returns.size(); k += 2) {
    const float range = 0.5f + 0.1f * static_cast<float>(k % 7);
    scan.scan.returns[k] *= range / scan.scan.returns[k].norm();
  }
  EXPECT_TRUE(Finds(scan, truth, 20));
}

TEST_F(EchoSearchTest, FewerPosesAreTheFirstOfMore) {
  const RobotScan scan =
      testing::ScanFrom(testing::TwoRooms(), Rigid2(2., 1.7, 0.3));
  const std::vector<Rigid2> many = Search(scan, 50), few = Search(scan, 10);
  EXPECT_EQ(few.size(), 10u);
  EXPECT_TRUE(testing::AreFirstOf(few, many));
}

TEST_F(EchoSearchTest, PosesStandWhereARobotCan) {
  const RobotScan scan =
      testing::ScanFrom(testing::TwoRooms(), Rigid2(2., 1.7, 0.3));
  for (const Rigid2& pose : Search(scan, 100)) {
    const Eigen::Vector2d p_grid =
        rays_.geometry().T_submap_grid.Inverse() * pose.translation();
    const Eigen::Array2i square = (p_grid / map_.side).array().cast<int>();
    EXPECT_TRUE(map_.standing(square.x(), square.y())) << pose;
  }
}

TEST_F(EchoSearchTest, NothingIsFoundWithoutEchoesOrPlaces) {
  EXPECT_TRUE(Search(RobotScan(), 10).empty());
  const RobotScan scan =
      testing::ScanFrom(testing::TwoRooms(), Rigid2(2., 1.7, 0.3));
  EXPECT_TRUE(Search(scan, 0).empty());
  map_.standing.setConstant(false);
  EXPECT_TRUE(Search(scan, 10).empty());
}

TEST_F(EchoSearchTest, SquaresSayHowNearAWallIs) {
  EXPECT_NEAR(map_.side, 0.3, 1e-9);
  const auto square_at = [this](const double x, const double y) {
    return ((rays_.geometry().T_submap_grid.Inverse() * Eigen::Vector2d(x, y)) /
            map_.side)
        .array()
        .cast<int>()
        .eval();
  };
  // In the wall between the rooms, and in the middle of the corridor.
  const Eigen::Array2i wall = square_at(7., 2.5), corridor = square_at(1., 6.1);
  EXPECT_GE(map_.scores(wall.x(), wall.y()), EchoMap::kMaxScore - 1);
  EXPECT_FALSE(map_.standing(wall.x(), wall.y()));
  EXPECT_EQ(map_.scores(corridor.x(), corridor.y()), 0);
  EXPECT_TRUE(map_.standing(corridor.x(), corridor.y()));
}

// As a file may say.
TEST_F(EchoSearchTest, ViewpointsCloserThanCellsAreInSquaresOfACell) {
  viewpoints_.step = 1e-9;
  EXPECT_NEAR(MakeEchoMap(rays_, viewpoints_).side, 0.05, 1e-9);
  viewpoints_.step = 1e4;
  EXPECT_EQ(MakeEchoMap(rays_, viewpoints_).standing.count(), 1);
}

TEST_F(EchoSearchTest, WithMoreViewpointsSquaresAreLarger) {
  // Of a map of sixteen times as many places as there are squares at most.
  const std::vector<Eigen::Vector2d> positions = viewpoints_.positions;
  while (viewpoints_.positions.size() < 16 * 12000) {
    viewpoints_.positions.insert(viewpoints_.positions.end(), positions.begin(),
                                 positions.end());
  }
  const double side = MakeEchoMap(rays_, viewpoints_).side;
  EXPECT_GT(side, 1.1);
  EXPECT_LT(side, 1.4);
}

}  // namespace
}  // namespace cartographer_sdf::echo_search_test
