// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/people.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_sdf::people_test {
namespace {

const Rigid2 kFarAway(1e3, 1e3, 0.);

// Of 12 m x 10 m, with a wall across that leaves a door.
FloorPlan TwoHalls() {
  FloorPlan plan = EmptyFloorPlan({12., 10.}, 0.05);
  FillRectangle({6., 4.}, {0.2, 8.}, 0., true, &plan);
  return plan;
}

TEST(PeopleTest, WalkersKeepToTheirSpeedAndOffTheWalls) {
  const FloorPlan plan = TwoHalls();
  PeopleOptions options;
  options.num_walking = 3;
  const absl::StatusOr<People> people = PlacePeople(plan, options, 60., 42);
  ASSERT_TRUE(people.ok()) << people.status();
  double way = 0.;
  for (double seconds = 0.; seconds < 60.; seconds += 0.1) {
    const std::vector<Person> now = people->At(seconds, kFarAway);
    const std::vector<Person> then = people->At(seconds + 0.1, kFarAway);
    ASSERT_EQ(now.size(), 3u);
    for (size_t k = 0; k != 3; ++k) {
      EXPECT_EQ(now[k].radius, People::kRadius);
      const double step = (then[k].position - now[k].position).norm();
      // Two steps where rounding skips a time step.
      EXPECT_LE(step, 2. * People::kWalkingSpeed * 0.1 + 1e-9);
      way += step;
      // Smoothed paths may cut corners by 0.1 m.
      const Eigen::Vector2d& p = now[k].position;
      EXPECT_FALSE(std::abs(p.x() - 6.) < 0.1 + 0.2 && p.y() < 8.);
    }
  }
  EXPECT_GT(way, 0.5 * 3. * 60. * People::kWalkingSpeed);
}

TEST(PeopleTest, StandersStandForTheirTime) {
  PeopleOptions options;
  options.num_standing = 5;
  const absl::StatusOr<People> people =
      PlacePeople(TwoHalls(), options, 1200., 42);
  ASSERT_TRUE(people.ok()) << people.status();
  for (size_t k = 0; k != 5; ++k) {
    int moves = 0;
    for (int second = 0; second != 1200; ++second) {
      moves += people->At(second, kFarAway)[k].position !=
               people->At(second + 1, kFarAway)[k].position;
    }
    EXPECT_GE(moves, 9);
    EXPECT_LE(moves, 10);
  }
}

TEST(PeopleTest, StepAsideForTheRobot) {
  PeopleOptions options;
  options.num_standing = 1;
  const People people = *PlacePeople(TwoHalls(), options, 10., 42);
  const Eigen::Vector2d place = people.At(0., kFarAway)[0].position;
  EXPECT_TRUE(people.At(0., Rigid2(place.x(), place.y() + 0.59, 0.)).empty());
  EXPECT_EQ(people.At(0., Rigid2(place.x(), place.y() + 0.61, 0.)).size(), 1u);
  EXPECT_TRUE(People().At(0., kFarAway).empty());
}

TEST(PeopleTest, SameSeedSamePeople) {
  PeopleOptions options;
  options.num_standing = 3;
  options.num_walking = 1;
  const auto place = [&](const uint32_t seed) {
    return PlacePeople(TwoHalls(), options, 30., seed)->At(15., kFarAway);
  };
  const auto a = place(1), b = place(1), c = place(2);
  for (size_t k = 0; k != a.size(); ++k) {
    EXPECT_EQ(a[k].position, b[k].position);
    EXPECT_NE(a[k].position, c[k].position);
  }
}

TEST(PeopleTest, NeedRoomAndValidOptions) {
  FloorPlan solid = EmptyFloorPlan({5., 5.}, 0.05);
  FillRectangle({2.5, 2.5}, {9., 9.}, 0., true, &solid);
  PeopleOptions options;
  EXPECT_TRUE(PlacePeople(solid, options, 10., 42).ok());  // Nobody.
  options.num_standing = 1;
  EXPECT_FALSE(PlacePeople(solid, options, 10., 42).ok());
  options = PeopleOptions();
  options.num_walking = 1;
  EXPECT_FALSE(PlacePeople(solid, options, 10., 42).ok());
  EXPECT_EQ(Validate(PeopleOptions()), "");
  for (int PeopleOptions::*const field :
       {&PeopleOptions::num_walking, &PeopleOptions::num_standing}) {
    options = PeopleOptions();
    options.*field = -1;
    EXPECT_NE(Validate(options), "");
  }
}

}  // namespace
}  // namespace cartographer_sdf::people_test
