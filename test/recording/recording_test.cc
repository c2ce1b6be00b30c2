// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recording/recording.h"

#include <cmath>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::motion_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kTolerance = 1e-9;

LaserScan Scan(const double time, const Rigid2& T_odometry_robot) {
  return LaserScan{time, T_odometry_robot, {}};
}

TEST(MotionTest, InterpolatesTheShorterWayAround) {
  const auto samples =
      MotionBetween(Scan(10., {0., 2., 3.}), Scan(10.1, {1., 4., -3.}));
  const double turn = 2. * M_PI - 6.;
  ASSERT_EQ(samples.size(), 4u);
  EXPECT_NEAR(samples[1].time, 10.05, kTolerance);
  EXPECT_NEAR(samples[1].T_odometry_robot.translation().x(), 0.5, kTolerance);
  EXPECT_NEAR(samples[1].T_odometry_robot.translation().y(), 3., kTolerance);
  for (size_t k = 0; k < samples.size(); ++k) {
    EXPECT_NEAR(NormalizeAngle(samples[k].T_odometry_robot.rotation() - 3.),
                turn * (static_cast<double>(k) + 1.) / 4., kTolerance);
    EXPECT_NEAR(samples[k].yaw_rate, turn / 0.1, 1e-6);
  }
  EXPECT_EQ(samples.back().time, 10.1);
}

TEST(MotionTest, IsDenseInLongIntervals) {
  // 20 Hz, whatever is left of the fractions of a date.
  EXPECT_EQ(MotionBetween(Scan(1e9 + 0.2, {}), Scan(1e9 + 0.4, {})).size(), 4u);
  EXPECT_EQ(MotionBetween(Scan(5., {}), Scan(6., {})).size(), 20u);
  EXPECT_EQ(MotionBetween(Scan(5., {}), Scan(6.01, {})).size(), 21u);
  // Memory does not grow with a clock that jumps.
  EXPECT_EQ(MotionBetween(Scan(5., {}), Scan(1e10, {})).size(), 1200u);
}

TEST(MotionTest, MeasuresThePath) {
  Recording recording;
  EXPECT_THAT(MetersDriven(recording), IsEmpty());
  recording.scans = {Scan(0., {}), Scan(1., {3., 4., 1.}),
                     Scan(2., {3., 3., 1.})};
  EXPECT_THAT(MetersDriven(recording), ElementsAre(0., 5., 6.));
}

TEST(MotionTest, CutsByTime) {
  Recording recording;
  recording.first_angle = 1.;
  for (int i = 0; i < 10; ++i) {
    recording.scans.push_back(Scan(100. + i, {}));
  }
  const Recording cut = Cut(recording, 2.5, 3.);
  EXPECT_EQ(cut.first_angle, 1.);
  ASSERT_EQ(cut.scans.size(), 3u);
  EXPECT_EQ(cut.scans.front().time, 103.);
  EXPECT_EQ(cut.scans.back().time, 105.);
  EXPECT_THAT(Cut(recording, 20., 3.).scans, IsEmpty());
  EXPECT_EQ(Cut(recording, 0., INFINITY).scans.size(), 10u);
}

TEST(OdometryScansTest, ARangeThatComesTooOftenIsNone) {
  Recording recording;
  recording.first_angle = -M_PI / 2.;
  recording.angle_increment = M_PI / 2.;
  recording.scans = {Scan(1., {1., 2., 0.5}), Scan(2., {3., 4., 0.6})};
  recording.scans[0].ranges = {2., 81.9, 3.};
  recording.scans[1].ranges = {81.9, 25., 4.};
  const std::vector<OdometryScan> scans = OdometryScansOf(recording);
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(scans[1].time, 2.);
  EXPECT_EQ(scans[1].T_odometry_robot.translation().x(), 3.);
  const cartographer_sdf::Scan& first = scans[0].scans.front().scan;
  ASSERT_EQ(first.returns.size(), 2u);
  EXPECT_NEAR(first.returns[0].y(), -2., 1e-5);
  EXPECT_NEAR(first.returns[1].y(), 3., 1e-5);
  // As far as the lidar saw anything.
  ASSERT_EQ(first.misses.size(), 1u);
  EXPECT_NEAR(first.misses[0].x(), 25., 1e-5);
}

TEST(OdometryScansTest, TheFarthestEchoIsOne) {
  Recording recording;
  recording.scans = {Scan(1., {})};
  recording.scans[0].ranges = {2., 8., 3.};
  const std::vector<OdometryScan> scans = OdometryScansOf(recording);
  EXPECT_EQ(scans[0].scans.front().scan.returns.size(), 3u);
  EXPECT_TRUE(scans[0].scans.front().scan.misses.empty());
  EXPECT_TRUE(OdometryScansOf(Recording()).empty());
}

}  // namespace
}  // namespace cartographer_sdf::motion_test
