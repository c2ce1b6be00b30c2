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

namespace cartographer_sdf {
namespace {

using testing::AddRepeatability;
using testing::DescribedGrid;
using testing::DescribeGrid;
using testing::Repeatability;

constexpr size_t kNumSubmaps = 4;
constexpr double kToleranceCells = 2.;
// Half a metre from where observation ends, as descriptors see 0.8 m.
constexpr double kBorderCells = 10.;

class RealSubmapRotationTest : public ::testing::TestWithParam<const char*> {};

TEST_P(RealSubmapRotationTest, BringsBackTheFeatures) {
  SKIP_WITHOUT_SHARED_DATA(GetParam());
  std::vector<OccupancyGrid> grids;
  const auto state =
      ReadMap(SharedDataPath(GetParam()),
              [&grids](const SubmapId&, const SubmapSummary& summary,
                       const OccupancyGrid& grid) {
                if (summary.finished && grids.size() < kNumSubmaps) {
                  grids.push_back(grid);
                }
              });
  ASSERT_TRUE(state.ok()) << state.status();
  ASSERT_EQ(grids.size(), kNumSubmaps);
  for (int degrees = 10; degrees < 360; degrees += 30) {
    const double angle = degrees * M_PI / 180.;
    Repeatability result;
    for (const OccupancyGrid& grid : grids) {
      const std::optional<DescribedGrid> original = DescribeGrid(grid);
      const std::optional<DescribedGrid> turned =
          DescribeGrid(testing::TurnedGrid(grid, angle));
      ASSERT_TRUE(original.has_value() && turned.has_value());
      AddRepeatability(*original, *turned, angle, kBorderCells, kToleranceCells,
                       &result);
    }
    const double same = Repeatability::Median(result.same);
    const double other = Repeatability::Median(result.other);
    printf("%d: %d %.3f %.3f %.3f\n", degrees, result.num_keypoints,
           result.Fraction(), same, other);
    EXPECT_GT(result.num_keypoints, 100);
    EXPECT_GE(result.Fraction(), 0.8) << degrees;
    EXPECT_LE(same, 0.5 * other) << degrees;
  }
}

INSTANTIATE_TEST_SUITE_P(Maps, RealSubmapRotationTest,
                         ::testing::Values("intel_stock.pbstream",
                                           "willow_1.pbstream"));

}  // namespace
}  // namespace cartographer_sdf
