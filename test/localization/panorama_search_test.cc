// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/panorama_search.h"

#include <algorithm>
#include <cmath>

#include "gtest/gtest.h"
#include "test/testing/drawn_map.h"

namespace cartographer_sdf::panorama_search_test {
namespace {

constexpr double kResolution = 0.05;

class PanoramaSearchTest : public ::testing::Test {
 protected:
  PanoramaSearchTest() : map_(*MakeRayMap(testing::TwoRoomsGrid())) {
    viewpoints_ = MakeViewpoints({}, map_, ReachableCells(map_, 0.15, {}));
  }
  [[nodiscard]] std::vector<Rigid2> Search(const RobotScan& scan,
                                           const size_t max_num_poses) const {
    std::vector<Rigid2> poses =
        SearchPanoramas(viewpoints_, kResolution,
                        MakeSweep({scan}, kNumDirections, 60.), max_num_poses);
    for (Rigid2& pose : poses) pose = map_.geometry().T_submap_grid * pose;
    return poses;
  }
  RayMap map_;
  Viewpoints viewpoints_;
};

TEST_F(PanoramaSearchTest, TheRightPoseIsAmongTheFirst) {
  for (const Rigid2& truth : {Rigid2(2., 1.7, 0.3), Rigid2(12.2, 3.1, 1.)}) {
    EXPECT_TRUE(testing::HasPoseNear(
        Search(testing::ScanFrom(testing::TwoRooms(), truth), 5), truth))
        << truth;
  }
}

TEST_F(PanoramaSearchTest, SensorsBesideTheCentreOfTheRobotAreNoMatter) {
  const Rigid2 truth(2., 1.7, 0.3), T_robot_sensor(0.8, -0.3, 1.2);
  RobotScan scan =
      testing::ScanFrom(testing::TwoRooms(), truth * T_robot_sensor);
  scan.T_robot_sensor = T_robot_sensor;
  const Rigid2 best = Search(scan, 1).at(0);
  EXPECT_LT((best.translation() - truth.translation()).norm(), 0.4);
  EXPECT_LT(std::abs(NormalizeAngle(best.rotation() - truth.rotation())), 0.1);
}

// They may have met glass.
TEST_F(PanoramaSearchTest, BeamsWithoutEchoSayNothing) {
  const RobotScan scan =
      testing::ScanFrom(testing::TwoRooms(), Rigid2(2., 1.7, 0.3));
  RobotScan with_silent = scan;
  for (int k = 0; k < 1000; ++k) {
    const float angle = 0.00628f * static_cast<float>(k);
    with_silent.scan.misses.emplace_back(50.f * std::cos(angle),
                                         50.f * std::sin(angle));
  }
  const std::vector<Rigid2> poses = Search(scan, 10),
                            same_poses = Search(with_silent, 10);
  ASSERT_EQ(same_poses.size(), poses.size());
  for (size_t k = 0; k < poses.size(); ++k) {
    EXPECT_EQ(same_poses[k].translation(), poses[k].translation());
    EXPECT_EQ(same_poses[k].rotation(), poses[k].rotation());
  }
}

TEST_F(PanoramaSearchTest, FewerPosesAreTheFirstOfMore) {
  const RobotScan scan =
      testing::ScanFrom(testing::TwoRooms(), Rigid2(2., 1.7, 0.3));
  const std::vector<Rigid2> many = Search(scan, 50), few = Search(scan, 10);
  EXPECT_EQ(few.size(), 10u);
  EXPECT_TRUE(testing::AreFirstOf(few, many));
}

TEST_F(PanoramaSearchTest, NothingIsFoundWithoutBeamsOrPlaces) {
  EXPECT_TRUE(Search(RobotScan(), 10).empty());
  const Sweep sweep =
      MakeSweep({testing::ScanFrom(testing::TwoRooms(), Rigid2(2., 1.7, 0.3))},
                kNumDirections, 60.);
  EXPECT_TRUE(SearchPanoramas(Viewpoints(), kResolution, sweep, 10).empty());
}

}  // namespace
}  // namespace cartographer_sdf::panorama_search_test
