// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Rotation invariance of the features (see feature/rotation_invariance_test)
// on submaps of real maps, with all their noise.

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/pbstream/map_file.h"
#include "gtest/gtest.h"
#include "test/testing/rotation_repeatability.h"
#include "test/testing/shared_data.h"

namespace cartographer_sdf::real_submap_rotation_test {
namespace {

using testing::AddRepeatability;
using testing::DescribedGrid;
using testing::DescribeGrid;
using testing::Repeatability;

constexpr size_t kNumSubmaps = 4;
constexpr double kToleranceCells = 2.;
// Half a metre from where observation ends, as descriptors see 0.8 m.
constexpr double kBorderCells = 10.;
// The lowest measured of any angle is 0.72, ...
constexpr double kLeastFraction = 0.7;
// ... and 0.8 over all angles within twice the distance.
constexpr double kLeastFractionWithinTwice = 0.8;
// Measured: 0.085, and 0.92 between different places.
constexpr double kLargestMedianDistance = 0.12;
constexpr double kLeastMedianOfOthers = 0.8;

class RealSubmapRotationTest : public ::testing::TestWithParam<const char*> {};

TEST_P(RealSubmapRotationTest, BringsBackTheFeatures) {
  SKIP_WITHOUT_SHARED_DATA(GetParam());
  std::vector<OccupancyGrid> grids;
  const auto state =
      ReadMap(SharedDataPath(GetParam()),
              {[&grids](const SubmapId&, const SubmapSummary& summary,
                        const OccupancyGrid& grid) {
                if (summary.finished && grids.size() < kNumSubmaps) {
                  grids.push_back(grid);
                }
              }});
  ASSERT_TRUE(state.ok()) << state.status();
  ASSERT_EQ(grids.size(), kNumSubmaps);
  Repeatability over_all_angles;
  for (int degrees = 10; degrees < 360; degrees += 30) {
    const double angle = degrees * M_PI / 180.;
    Repeatability result;
    for (const OccupancyGrid& grid : grids) {
      const std::optional<DescribedGrid> original = DescribeGrid(grid);
      const std::optional<DescribedGrid> turned =
          DescribeGrid(TurnedGrid(grid, angle));
      ASSERT_TRUE(original.has_value() && turned.has_value());
      AddRepeatability(*original, *turned, angle, kBorderCells, kToleranceCells,
                       &result);
      AddRepeatability(*original, *turned, angle, kBorderCells,
                       2. * kToleranceCells, &over_all_angles);
    }
    EXPECT_GT(result.NumKeypoints(), 200);
    EXPECT_GE(result.Fraction(), kLeastFraction) << degrees;
    EXPECT_LE(Repeatability::Median(result.same), kLargestMedianDistance)
        << degrees;
    EXPECT_GE(Repeatability::Median(result.other), kLeastMedianOfOthers)
        << degrees;
  }
  EXPECT_GE(over_all_angles.Fraction(), kLeastFractionWithinTwice);
}

INSTANTIATE_TEST_SUITE_P(Maps, RealSubmapRotationTest,
                         ::testing::Values("intel_stock.pbstream",
                                           "willow_1.pbstream"));

}  // namespace
}  // namespace cartographer_sdf::real_submap_rotation_test
