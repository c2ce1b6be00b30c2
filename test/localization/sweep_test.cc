// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/sweep.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_sdf::sweep_test {
namespace {

TEST(SweepTest, KeepsOneBeamOfEachDirection) {
  RobotScan scan;
  for (int k = 0; k < 1000; ++k) {
    const float angle = static_cast<float>(2. * M_PI * k / 1000.);
    scan.scan.returns.emplace_back(2.f * std::cos(angle),
                                   2.f * std::sin(angle));
  }
  const Sweep sweep = MakeSweep({scan}, 36, 10.);
  ASSERT_EQ(sweep.beams.size(), 36u);
  for (size_t k = 0; k < 36; ++k) {
    const Eigen::Vector2d& end = sweep.beams[k].end;
    const double turns = std::atan2(end.y(), end.x()) / (2. * M_PI);
    // The one nearest to the middle of its direction.
    EXPECT_NEAR((turns - std::floor(turns)) * 36., static_cast<double>(k) + 0.5,
                0.02);
    EXPECT_TRUE(sweep.beams[k].has_echo);
  }
  EXPECT_NEAR(sweep.widest_gap, 2. * M_PI / 36., 0.01);
}

TEST(SweepTest, LeavesOutWhatIsNoRange) {
  RobotScan scan;
  scan.scan.returns = {{NAN, 0.f}, {INFINITY, 0.f}, {0.01f, 0.f}, {11.f, 0.f}};
  EXPECT_TRUE(MakeSweep({scan}, 36, 10.).beams.empty());
  EXPECT_TRUE(MakeSweep({}, 36, 10.).beams.empty());
  scan.scan.misses = {{0.f, 9.f}};
  const Sweep sweep = MakeSweep({scan}, 36, 10.);
  ASSERT_EQ(sweep.beams.size(), 1u);
  EXPECT_FALSE(sweep.beams[0].has_echo);
}

TEST(SweepTest, LooksFromTheMiddleOfTheSensors) {
  RobotScan front, back;
  front.T_robot_sensor = Rigid2(0.5, 0., 0.);
  front.scan.returns = {{1.f, 0.f}};
  back.T_robot_sensor = Rigid2(-0.3, 0., M_PI);
  back.scan.returns = {{2.f, 0.f}};
  const Sweep sweep = MakeSweep({front, back}, 36, 10.);
  EXPECT_NEAR(sweep.centre.x(), 0.1, 1e-9);
  ASSERT_EQ(sweep.beams.size(), 2u);
  EXPECT_NEAR(sweep.beams[0].end.x(), 1.5, 1e-6);
  EXPECT_NEAR(sweep.beams[0].origin.x(), 0.5, 1e-6);
  EXPECT_NEAR(sweep.beams[1].end.x(), -2.3, 1e-6);
  EXPECT_NEAR(sweep.widest_gap, M_PI, 1e-6);
}

}  // namespace
}  // namespace cartographer_sdf::sweep_test
