// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The property on which place recognition rests: a grid that is turned by any
// angle brings back the same keypoints with the same descriptors.

#include <cmath>
#include <optional>

#include "gtest/gtest.h"
#include "test/testing/rotation_repeatability.h"
#include "test/testing/world.h"

namespace cartographer_sdf {
namespace {

using testing::AddRepeatability;
using testing::CentredGeometry;
using testing::DescribedGrid;
using testing::DescribeGrid;
using testing::Repeatability;

constexpr double kToleranceCells = 2.;
// Measured: LOWEST of any angle.
constexpr double kLeastFraction = 0.8;
// A histogram of unit length and, in units of 0.5 m, the distance to walls.
constexpr double kLargestMedianDistance = 0.3;

// A grid of nine furnished rooms with walls all around.
constexpr int kCells = 280;

OccupancyGrid Building(const double angle) {
  const double middle = testing::kOfficePitch;
  return testing::Rasterise(testing::OfficeFloor(3, 3),
                            CentredGeometry(kCells, 0.05),
                            Rigid2(middle, middle, -angle));
}

void ExpectRepeatable(const Repeatability& result, const int degrees) {
  EXPECT_GE(result.Fraction(), kLeastFraction) << degrees;
  const double same = Repeatability::Median(result.same);
  EXPECT_LE(same, kLargestMedianDistance) << degrees;
  EXPECT_LE(same, 0.5 * Repeatability::Median(result.other)) << degrees;
  ::testing::Test::RecordProperty("x", 0);
  printf("%d: %d %.3f %.3f %.3f\n", degrees, result.num_keypoints,
         result.Fraction(), same, Repeatability::Median(result.other));
}

TEST(RotationInvarianceTest, ATurnedGridHasTheSameFeatures) {
  const OccupancyGrid grid = Building(0.);
  const std::optional<DescribedGrid> original = DescribeGrid(grid);
  ASSERT_TRUE(original.has_value());
  for (int degrees = 0; degrees < 360; degrees += 10) {
    const double angle = degrees * M_PI / 180.;
    const std::optional<DescribedGrid> turned =
        DescribeGrid(testing::TurnedGrid(grid, angle));
    ASSERT_TRUE(turned.has_value());
    Repeatability result;
    AddRepeatability(*original, *turned, angle, 0., kToleranceCells, &result);
    EXPECT_GT(result.num_keypoints, 200);
    ExpectRepeatable(result, degrees);
  }
}

TEST(RotationInvarianceTest, ATurnedBuildingHasTheSameFeatures) {
  const std::optional<DescribedGrid> original = DescribeGrid(Building(0.));
  ASSERT_TRUE(original.has_value());
  for (int degrees = 5; degrees < 360; degrees += 25) {
    const double angle = degrees * M_PI / 180.;
    const std::optional<DescribedGrid> turned = DescribeGrid(Building(angle));
    ASSERT_TRUE(turned.has_value());
    Repeatability result;
    AddRepeatability(*original, *turned, angle, 0., kToleranceCells, &result);
    ExpectRepeatable(result, degrees);
  }
}

// Right angles permute the cells, so nothing is lost but the last bits.
TEST(RotationInvarianceTest, RightAnglesLoseNothing) {
  const OccupancyGrid grid = Building(0.3);
  const std::optional<DescribedGrid> original = DescribeGrid(grid);
  ASSERT_TRUE(original.has_value());
  for (int quarter = 1; quarter < 4; ++quarter) {
    const double angle = quarter * M_PI_2;
    const std::optional<DescribedGrid> turned =
        DescribeGrid(testing::TurnedGrid(grid, angle));
    ASSERT_TRUE(turned.has_value());
    Repeatability result;
    AddRepeatability(*original, *turned, angle, 0., 0.01, &result);
    printf("right %f %d\n", result.Fraction(), result.num_keypoints);
    EXPECT_GE(result.Fraction(), 0.98);
    EXPECT_LE(Repeatability::Median(result.same), 1e-3);
    printf("%g\n", Repeatability::Median(result.same));
  }
}

}  // namespace
}  // namespace cartographer_sdf
