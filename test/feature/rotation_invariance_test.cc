// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The property on which place recognition rests: a grid that is turned by any
// angle brings back the same keypoints with the same descriptors.

#include <cmath>
#include <optional>

#include "gtest/gtest.h"
#include "test/testing/rotation_repeatability.h"
#include "test/testing/world.h"

namespace cartographer_sdf::rotation_invariance_test {
namespace {

using testing::AddRepeatability;
using testing::CentredGeometry;
using testing::DescribedGrid;
using testing::DescribeGrid;
using testing::Repeatability;

constexpr double kToleranceCells = 2.;
// Resampled walls move by half a cell, as does what is found between them.
// Peaks and pits are fixed by that, saddles on long ridges slide.
struct LeastFractions {
  double all;
  double extrema;
};
// The lowest measured of any angle are 0.81 and 0.91.
constexpr LeastFractions kTurnedGrid = {0.8, 0.9};
// The lowest measured of any angle are 0.77 and 0.84.
constexpr LeastFractions kTurnedBuilding = {0.75, 0.82};
// A histogram of unit length beside twice the distance to walls in metres.
// Measured medians are at most 0.12, and 0.85 between different places.
constexpr double kLargestMedianDistance = 0.15;
constexpr double kLeastMedianOfOthers = 0.7;

// A grid of nine furnished rooms with walls all around.
constexpr int kCells = 280;

OccupancyGrid Building(const double angle) {
  const double middle = testing::kOfficePitch;
  return testing::Rasterise(testing::OfficeFloor(3, 3),
                            CentredGeometry(kCells, 0.05),
                            Rigid2(middle, middle, -angle));
}

void ExpectRepeatable(const DescribedGrid& original, const OccupancyGrid& grid,
                      const double angle, const LeastFractions& least) {
  const std::optional<DescribedGrid> turned = DescribeGrid(grid);
  ASSERT_TRUE(turned.has_value());
  Repeatability result;
  AddRepeatability(original, *turned, angle, 0., kToleranceCells, &result);
  EXPECT_GT(result.NumKeypoints(), 200);
  EXPECT_GE(result.Fraction(), least.all) << angle;
  EXPECT_GE(result.Fraction({KeypointKind::kMaximum, KeypointKind::kMinimum}),
            least.extrema)
      << angle;
  EXPECT_LE(Repeatability::Median(result.same), kLargestMedianDistance)
      << angle;
  EXPECT_GE(Repeatability::Median(result.other), kLeastMedianOfOthers) << angle;
}

TEST(RotationInvarianceTest, ATurnedGridHasTheSameFeatures) {
  const OccupancyGrid grid = Building(0.);
  const std::optional<DescribedGrid> original = DescribeGrid(grid);
  ASSERT_TRUE(original.has_value());
  for (int degrees = 0; degrees < 360; degrees += 10) {
    const double angle = degrees * M_PI / 180.;
    ExpectRepeatable(*original, TurnedGrid(grid, angle), angle, kTurnedGrid);
  }
}

TEST(RotationInvarianceTest, ATurnedBuildingHasTheSameFeatures) {
  const std::optional<DescribedGrid> original = DescribeGrid(Building(0.));
  ASSERT_TRUE(original.has_value());
  for (int degrees = 5; degrees < 360; degrees += 10) {
    const double angle = degrees * M_PI / 180.;
    ExpectRepeatable(*original, Building(angle), angle, kTurnedBuilding);
  }
}

// Right angles permute the cells, so nothing is lost but the last bits; those
// decide only where two directions dominate equally.
TEST(RotationInvarianceTest, RightAnglesLoseNothing) {
  const OccupancyGrid grid = Building(0.3);
  const std::optional<DescribedGrid> original = DescribeGrid(grid);
  ASSERT_TRUE(original.has_value());
  for (int quarter = 1; quarter < 4; ++quarter) {
    const double angle = quarter * M_PI_2;
    const std::optional<DescribedGrid> turned =
        DescribeGrid(TurnedGrid(grid, angle));
    ASSERT_TRUE(turned.has_value());
    Repeatability result;
    AddRepeatability(*original, *turned, angle, 0., 0.01, &result);
    EXPECT_GE(result.Fraction(), 0.98);
    EXPECT_LE(Repeatability::Median(result.same), 1e-4);
  }
}

}  // namespace
}  // namespace cartographer_sdf::rotation_invariance_test
