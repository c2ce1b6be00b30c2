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
  const double length = FindCrossingWalls(hall, {}, other, {}, pose).longest;
  // Whichever is the reference.
  EXPECT_NEAR(FindCrossingWalls(other, {}, hall, {}, pose.Inverse()).longest,
              length, 0.05);
  return length;
}

// Of a wall through which the robot drove that had seen the bare hall.
double LongestDrivenThrough(const Building& more, const DrivenWay& way,
                            const Rigid2& pose = Rigid2()) {
  const SurfaceModel hall = See({}), other = See(more);
  const CrossingWalls walls = FindCrossingWalls(hall, way, other, {}, pose);
  EXPECT_LE(walls.longest_driven_through, walls.longest);
  EXPECT_NEAR(FindCrossingWalls(other, {}, hall, way, pose.Inverse())
                  .longest_driven_through,
              walls.longest_driven_through, 0.05);
  // The other robot has not driven through the walls that it saw.
  EXPECT_EQ(
      FindCrossingWalls(hall, {}, other, way, pose).longest_driven_through, 0.);
  return walls.longest_driven_through;
}

DrivenWay WayBetween(const Eigen::Vector2d& begin, const Eigen::Vector2d& end) {
  DrivenWay way;
  for (int k = 0; k <= 20; ++k) way.push_back(begin + k / 20. * (end - begin));
  return way;
}

TEST(CrossingWallTest, OfTheSameHallIsNone) {
  EXPECT_EQ(Longest({}), 0.);
  // Nor where registration leaves some centimetres.
  EXPECT_EQ(Longest({}, Rigid2(0.3, -0.3, 0.01)), 0.);
}

TEST(CrossingWallTest, IsAsLongAsTheWallWhicheverWayItRuns) {
  EXPECT_NEAR(Longest({Wall({-3., 0.5}, {3., 0.5})}), 6., kMeters);
  EXPECT_NEAR(Longest({Wall({1., -2.}, {1., 2.})}), 4., kMeters);
  EXPECT_NEAR(Longest({Wall({-2., -1.}, {2., 1.})}), std::hypot(4., 2.),
              kMeters);
  EXPECT_NEAR(Longest({Wall({-1., -2.}, {0.3, 2.})}), std::hypot(1.3, 4.),
              kMeters);
}

TEST(CrossingWallTest, AGapEndsIt) {
  EXPECT_NEAR(Longest({Wall({-3., 0.}, {-1., 0.}), Wall({0., 0.}, {3., 0.})}),
              3., kMeters);
}

TEST(CrossingWallTest, FurnitureIsAsLongAsItsSide) {
  EXPECT_NEAR(
      Longest({Furniture(0., 0., 1.6, 0.8, 0.3), Furniture(3., 1., 1., 1., 0.),
               Furniture(-3., -1., 0.5, 0.5, 0.8)}),
      1.6, kMeters);
}

TEST(CrossingWallTest, AWallNearAWallMayBeTheSame) {
  // A cupboard along a wall, or a wall that drifted.
  EXPECT_EQ(Longest({Wall({-4., -4.6}, {4., -4.6})}), 0.);
}

TEST(CrossingWallTest, WhatTheOtherHasNotSeenDoesNotCount) {
  // One hall is moved by most of its length: in the common part, which has
  // been seen, stands the short wall of either.
  EXPECT_NEAR(Longest({}, Rigid2(11., 0., 0.)), 10. - 2. * 0.5, 2. * kMeters);
  EXPECT_EQ(Longest({}, Rigid2(30., 0., 0.)), 0.);
}

TEST(CrossingWallTest, NobodyDrivesThroughWalls) {
  const Building wall = {Wall({-3., 0.5}, {1., 0.5})};
  EXPECT_NEAR(LongestDrivenThrough(wall, WayBetween({-2., -2.}, {-1., 3.})), 4.,
              kMeters);
  // Beside its end, and up to it.
  EXPECT_EQ(LongestDrivenThrough(wall, WayBetween({2., -2.}, {2., 3.})), 0.);
  EXPECT_EQ(LongestDrivenThrough(wall, WayBetween({0., -3.}, {0., 0.2})), 0.);
  // Of several, the longest that was driven through.
  Building walls = wall;
  walls.push_back(Wall({2., -1.}, {4., -1.}));
  EXPECT_NEAR(LongestDrivenThrough(walls, WayBetween({3., -3.}, {3., 3.})), 2.,
              kMeters);
}

TEST(CrossingWallTest, TheWayIsThatOfItsOwnSubmap) {
  const Rigid2 T_hall_other(0.4, -0.3, M_PI / 2.);
  const Building wall = {Wall({-1., -2.}, {-1., 2.})};
  // In the hall, the wall runs along x, at y = -1.3.
  EXPECT_NEAR(
      LongestDrivenThrough(wall, WayBetween({0., -3.}, {0., 1.}), T_hall_other),
      4., kMeters);
  EXPECT_EQ(
      LongestDrivenThrough(wall, WayBetween({-3., 1.}, {3., 1.}), T_hall_other),
      0.);
}

TEST(CrossingWallTest, OfAWayBetweenDistantPositionsNothingIsKnown) {
  const Building wall = {Wall({-3., 0.5}, {1., 0.5})};
  EXPECT_EQ(LongestDrivenThrough(wall, {{0., -1.}, {0., 2.}}), 0.);
}

}  // namespace
}  // namespace cartographer_sdf::crossing_wall_test
