// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/lidar.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "gtest/gtest.h"

namespace cartographer_sdf::lidar_test {
namespace {

using Eigen::Vector2d;

constexpr double kResolution = 0.05;
constexpr double kRounding = 1e-9;

// The inside is [1, 7] x [1, 5], on cell borders.
FloorPlan RectangularRoom() {
  FloorPlan plan = EmptyFloorPlan({8., 6.}, kResolution);
  FillRectangle({4., 3.}, {9., 9.}, 0., true, &plan);
  FillRectangle({4., 3.}, {6., 4.}, 0., false, &plan);
  return plan;
}

// Distance from within the room to its wall.
double RangeInRoom(const Vector2d& p, const Vector2d& direction) {
  const double x = ((direction.x() > 0. ? 7. : 1.) - p.x()) / direction.x();
  const double y = ((direction.y() > 0. ? 5. : 1.) - p.y()) / direction.y();
  return std::min(x, y);
}

LidarOptions Noiseless() {
  LidarOptions options;
  options.range_noise = 0.;
  options.drop_outs = 0.;
  return options;
}

TEST(LidarTest, RangesInARoomAreExact) {
  const FloorPlan room = RectangularRoom();
  RandomNumbers random(42);
  for (int k = 0; k != 2000; ++k) {
    const Vector2d p(random.Uniform(1.1, 6.9), random.Uniform(1.1, 4.9));
    const double angle = random.Uniform(-M_PI, M_PI);
    const Vector2d direction(std::cos(angle), std::sin(angle));
    const std::optional<double> range = CastRay(room, p, direction, 20.);
    ASSERT_TRUE(range.has_value());
    EXPECT_NEAR(*range, RangeInRoom(p, direction), kRounding);
  }
}

TEST(LidarTest, AgreesWithMarchingThroughClutter) {
  FloorPlan plan = EmptyFloorPlan({10., 10.}, kResolution);
  RandomNumbers random(42);
  for (int k = 0; k != 60; ++k) {
    FillDisc({random.Uniform(0., 10.), random.Uniform(0., 10.)},
             random.Uniform(0.05, 0.4), &plan);
  }
  constexpr double kStep = 1e-4;
  // A march may step over the tip of a cell's corner that the exact ray hits.
  int num_corners = 0;
  for (int k = 0; k != 300; ++k) {
    const Vector2d p(random.Uniform(0., 10.), random.Uniform(0., 10.));
    const double angle = random.Uniform(-M_PI, M_PI);
    const Vector2d direction(std::cos(angle), std::sin(angle));
    std::optional<double> marched;
    for (int step = 0; step * kStep <= 6.; ++step) {
      const Eigen::Array2i cell =
          plan.geometry.CellAt(p + step * kStep * direction);
      if (!plan.geometry.Contains(cell)) break;
      if (!plan.occupied(cell.x(), cell.y())) continue;
      marched = step * kStep;
      break;
    }
    const std::optional<double> range = CastRay(plan, p, direction, 6.);
    if (range.has_value() != marched.has_value() ||
        (range && std::abs(*range - *marched) > kStep)) {
      ++num_corners;
      EXPECT_TRUE(range.has_value());
    }
  }
  EXPECT_LE(num_corners, 2);
}

TEST(LidarTest, NoEchoBeyondTheRangeOrOutsideThePlan) {
  const FloorPlan room = RectangularRoom();
  EXPECT_FALSE(CastRay(room, {2., 3.}, {1., 0.}, 4.9).has_value());
  EXPECT_TRUE(CastRay(room, {2., 3.}, {1., 0.}, 5.1).has_value());
  const FloorPlan empty = EmptyFloorPlan({2., 2.}, kResolution);
  EXPECT_FALSE(CastRay(empty, {1., 1.}, {0., 1.}, 20.).has_value());
  EXPECT_FALSE(CastRay(empty, {-5., 1.}, {1., 0.}, 20.).has_value());
}

TEST(LidarTest, ScanIsInTheRobotFrame) {
  const FloorPlan room = RectangularRoom();
  const Rigid2 T_world_robot(3., 2.5, 2.);
  RandomNumbers random(42);
  const Scan scan = TakeScan(room, {}, T_world_robot, Noiseless(), &random);
  ASSERT_EQ(scan.returns.size(), 360u);
  EXPECT_TRUE(scan.misses.empty());
  double smallest = 10., largest = -10.;
  for (const Eigen::Vector2f& p_robot : scan.returns) {
    const Vector2d p_world = T_world_robot * p_robot.cast<double>();
    const double to_wall = std::min(
        std::min(std::abs(p_world.x() - 1.), std::abs(p_world.x() - 7.)),
        std::min(std::abs(p_world.y() - 1.), std::abs(p_world.y() - 5.)));
    EXPECT_NEAR(to_wall, 0., 1e-6);  // Single precision.
    const double angle = std::atan2(p_robot.y(), p_robot.x());
    smallest = std::min(smallest, angle);
    largest = std::max(largest, angle);
  }
  const double beam = 1.5 * M_PI / 360.;
  EXPECT_NEAR(smallest, -0.75 * M_PI + 0.5 * beam, 1e-6);
  EXPECT_NEAR(largest, 0.75 * M_PI - 0.5 * beam, 1e-6);
}

TEST(LidarTest, MissesEndAtTheLargestRange) {
  const FloorPlan room = RectangularRoom();
  LidarOptions options = Noiseless();
  options.max_range = 2.5;
  RandomNumbers random(42);
  const Scan scan = TakeScan(room, {}, Rigid2(4., 3., 0.), options, &random);
  EXPECT_EQ(scan.returns.size() + scan.misses.size(), 360u);
  // Walls above and below are 2 m away: within reach up to acos(2 / 2.5) off.
  const double visible = 4. * std::acos(0.8);
  const double hidden_behind = 2. * M_PI - options.field_of_view;
  const double expected =
      360. * (2. * M_PI - hidden_behind - visible) / options.field_of_view;
  EXPECT_NEAR(static_cast<double>(scan.misses.size()), expected, 4.);
  for (const Eigen::Vector2f& miss : scan.misses) {
    EXPECT_NEAR(miss.norm(), 2.5f, 1e-6f);
  }
}

TEST(LidarTest, NoiseAndDropOutsHaveTheirSize) {
  const FloorPlan room = RectangularRoom();
  LidarOptions options;
  options.num_beams = 10000;
  options.range_noise = 0.02;
  options.drop_outs = 0.05;
  RandomNumbers random(42);
  const Rigid2 T_world_robot(4., 3., 0.3);
  const Scan scan = TakeScan(room, {}, T_world_robot, options, &random);
  // Four standard deviations of the binomial distribution.
  EXPECT_NEAR(static_cast<double>(scan.returns.size()), 9500.,
              4. * std::sqrt(10000. * 0.05 * 0.95));
  double sum = 0., sum_squared = 0.;
  for (const Eigen::Vector2f& p_robot : scan.returns) {
    const Vector2d p = p_robot.cast<double>();
    const double error =
        p.norm() - RangeInRoom(T_world_robot.translation(),
                               T_world_robot.RotationMatrix() * p.normalized());
    sum += error;
    sum_squared += error * error;
  }
  const double n = static_cast<double>(scan.returns.size());
  EXPECT_NEAR(sum / n, 0., 4. * 0.02 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(sum_squared / n), 0.02, 4. * 0.02 / std::sqrt(2. * n));
}

// A pane 1 m before the right wall.
FloorPlan RoomWithPane() {
  FloorPlan plan = RectangularRoom();
  FillRectangle({6., 3.}, {0.1, 4.}, 0., true, &plan);
  return plan;
}

TEST(LidarTest, GlassReturnsSomeBeamsAndShowsWhatIsBehind) {
  FloorPlan plan = RoomWithPane();
  EXPECT_NEAR(*CastRay(plan, {3., 3.}, {1., 0.}, 20.), 2.95, kRounding);
  MakeGlass({6., 3.}, {0.2, 4.}, 0., &plan);
  EXPECT_EQ(plan.glass.count(), 2 * 80);
  EXPECT_NEAR(*CastRay(plan, {3., 3.}, {1., 0.}, 20.), 2.95, kRounding);
  EXPECT_NEAR(*CastRay(plan, {3., 3.}, {1., 0.}, 20., true), 4., kRounding);
  LidarOptions options = Noiseless();
  options.field_of_view = 0.01;
  options.num_beams = 10000;
  options.glass_echo = 0.3;
  RandomNumbers random(42);
  const Scan scan = TakeScan(plan, {}, Rigid2(3., 3., 0.), options, &random);
  ASSERT_EQ(scan.returns.size(), 10000u);
  double on_glass = 0.;
  for (const Eigen::Vector2f& point : scan.returns)
    on_glass += point.x() < 3.5f;
  // Four standard deviations.
  EXPECT_NEAR(on_glass, 3000., 4. * std::sqrt(10000. * 0.3 * 0.7));
}

TEST(LidarTest, DoesNotSeeTheUnseen) {
  FloorPlan plan = RoomWithPane();
  MakeUnseen({6., 3.}, {0.2, 4.}, 0., true, &plan);
  EXPECT_NEAR(*CastRay(plan, {3., 3.}, {1., 0.}, 20.), 4., kRounding);
  MakeUnseen({6., 3.}, {0.2, 0.1}, 0., false, &plan);
  EXPECT_NEAR(*CastRay(plan, {3., 3.}, {1., 0.}, 20.), 2.95, kRounding);
  EXPECT_NEAR(*CastRay(plan, {3., 3.5}, {1., 0.}, 20.), 4., kRounding);
}

TEST(LidarTest, PeopleStandBeforeWalls) {
  const FloorPlan room = RectangularRoom();
  const std::vector<Person> people = {
      {{4.5, 3.}, 0.2}, {{6., 3.}, 0.2}, {{3., 20.}, 0.2}};
  LidarOptions options = Noiseless();
  options.num_beams = 361;
  options.field_of_view = 2. * M_PI;
  RandomNumbers random(42);
  // Half a beam off, so that the middle one points ahead.
  const Scan scan =
      TakeScan(room, people, Rigid2(3., 3., 0.), options, &random);
  ASSERT_EQ(scan.returns.size(), 361u);
  int on_person = 0;
  for (const Eigen::Vector2f& point : scan.returns) {
    const Vector2d p = point.cast<double>();
    const double to_first = (p - Vector2d(1.5, 0.)).norm();
    if (std::abs(to_first - 0.2) < 1e-5) {
      ++on_person;
      EXPECT_LT(p.x(), 1.5);  // The near side.
    } else {
      EXPECT_NEAR(p.norm(), RangeInRoom({3., 3.}, p.normalized()), 1e-5);
    }
  }
  // The disc spans 2 asin(0.2 / 1.5) and hides the one behind it.
  EXPECT_NEAR(on_person, 361. * std::asin(0.2 / 1.5) / M_PI, 1.);
}

TEST(LidarTest, ValidatesOptions) {
  EXPECT_EQ(Validate(LidarOptions{}), "");
  LidarOptions options;
  options.num_beams = 0;
  EXPECT_NE(Validate(options), "");
  for (double LidarOptions::*const field :
       {&LidarOptions::field_of_view, &LidarOptions::max_range,
        &LidarOptions::range_noise, &LidarOptions::drop_outs,
        &LidarOptions::glass_echo}) {
    options = LidarOptions{};
    options.*field = -1.;
    EXPECT_NE(Validate(options), "");
    options.*field = std::nan("");
    EXPECT_NE(Validate(options), "");
  }
}

}  // namespace
}  // namespace cartographer_sdf::lidar_test
