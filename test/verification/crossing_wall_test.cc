// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/crossing_wall.h"

#include <cmath>

#include "gtest/gtest.h"
#include "test/testing/building.h"

namespace cartographer_sdf::crossing_wall_test {
namespace {

using testing::Building;
using testing::Furniture;
using testing::Wall;

// Two cells, the thickness of a wall and what a corner of it hides.
constexpr double kMeters = 0.2;

SurfaceModel See(const Building& more) {
  Building building = testing::BareRoom(14., 10.);
  building.insert(building.end(), more.begin(), more.end());
  return testing::SurfaceSeenFrom(
      building, {},
      {{-5., -3.}, {-5., 3.}, {5., -3.}, {5., 3.}, {0., 4.}, {0., -4.}});
}

double Longest(const Building& more, const Rigid2& pose = Rigid2()) {
  const SurfaceModel hall = See({}), other = See(more);
  const double length = LongestCrossingWall(hall, other, pose);
  // Whichever is the reference.
  EXPECT_NEAR(LongestCrossingWall(other, hall, pose.Inverse()), length, 0.05);
  return length;
}

TEST(LongestCrossingWallTest, OfTheSameHallIsNone) {
  EXPECT_EQ(Longest({}), 0.);
  // Nor where registration leaves some centimetres.
  EXPECT_EQ(Longest({}, Rigid2(0.3, -0.3, 0.01)), 0.);
}

TEST(LongestCrossingWallTest, IsAsLongAsTheWallWhicheverWayItRuns) {
  EXPECT_NEAR(Longest({Wall({-3., 0.5}, {3., 0.5})}), 6., kMeters);
  EXPECT_NEAR(Longest({Wall({1., -2.}, {1., 2.})}), 4., kMeters);
  EXPECT_NEAR(Longest({Wall({-2., -1.}, {2., 1.})}), std::hypot(4., 2.),
              kMeters);
  EXPECT_NEAR(Longest({Wall({-1., -2.}, {0.3, 2.})}), std::hypot(1.3, 4.),
              kMeters);
}

TEST(LongestCrossingWallTest, AGapEndsIt) {
  EXPECT_NEAR(Longest({Wall({-3., 0.}, {-1., 0.}), Wall({0., 0.}, {3., 0.})}),
              3., kMeters);
}

TEST(LongestCrossingWallTest, FurnitureIsAsLongAsItsSide) {
  EXPECT_NEAR(
      Longest({Furniture(0., 0., 1.6, 0.8, 0.3), Furniture(3., 1., 1., 1., 0.),
               Furniture(-3., -1., 0.5, 0.5, 0.8)}),
      1.6, kMeters);
}

TEST(LongestCrossingWallTest, AWallNearAWallMayBeTheSame) {
  // A cupboard along a wall, or a wall that drifted.
  EXPECT_EQ(Longest({Wall({-4., -4.6}, {4., -4.6})}), 0.);
}

TEST(LongestCrossingWallTest, WhatTheOtherHasNotSeenDoesNotCount) {
  // One hall is moved by most of its length: in the common part, which has
  // been seen, stands the short wall of either.
  EXPECT_NEAR(Longest({}, Rigid2(11., 0., 0.)), 10. - 2. * 0.5, 2. * kMeters);
  EXPECT_EQ(Longest({}, Rigid2(30., 0., 0.)), 0.);
}

TEST(CrossingOptionsTest, AreValidated) {
  EXPECT_EQ(Validate(CrossingOptions()), "");
  CrossingOptions options;
  options.max_crossed_fraction = 1.5;
  EXPECT_NE(Validate(options), "");
  options = CrossingOptions();
  options.max_wall_meters = 0.;
  EXPECT_NE(Validate(options), "");
}

TEST(IsCrossedTest, WhereMoreThanTheFractionIs) {
  CrossingOptions options;
  options.max_crossed_fraction = 0.1;
  EXPECT_FALSE(IsCrossed(options, 1, 10));
  EXPECT_TRUE(IsCrossed(options, 2, 10));
  // Nothing to compare refutes nothing.
  EXPECT_FALSE(IsCrossed(options, 0, 0));
}

}  // namespace
}  // namespace cartographer_sdf::crossing_wall_test
