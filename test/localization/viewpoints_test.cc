// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/viewpoints.h"

#include <cmath>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::viewpoints_test {
namespace {

using ::testing::HasSubstr;

// Two rooms of 2 m x 2 m at 0.1 m a cell, side by side, without a door: from
// (0.1, 0.1) to (2.1, 2.1) and from (2.2, 0.1) to (4.2, 2.1).
class ViewpointsTest : public ::testing::Test {
 protected:
  ViewpointsTest() {
    OccupancyGrid grid = UnknownGrid({{43, 22}, 0.1, Rigid2()});
    grid.known.setConstant(true);
    grid.probability.setConstant(0.9f);
    grid.probability.block(1, 1, 20, 20).setConstant(0.1f);
    grid.probability.block(22, 1, 20, 20).setConstant(0.1f);
    map_ = *MakeRayMap(grid);
  }
  [[nodiscard]] bool IsReached(const BoolArray& reachable, const double x,
                               const double y) const {
    const Eigen::Array2i cell = map_.geometry().CellAt({x, y});
    return reachable(cell.x(), cell.y());
  }
  RayMap map_;
};

TEST_F(ViewpointsTest, ARobotStaysInTheRoomWhereItDrove) {
  const BoolArray reachable = ReachableCells(map_, 0.25, {{1., 1.}});
  EXPECT_TRUE(IsReached(reachable, 1.7, 1.7));
  EXPECT_FALSE(IsReached(reachable, 2.05, 1.));  // too near to the wall
  EXPECT_FALSE(IsReached(reachable, 3., 1.));
  const BoolArray anywhere = ReachableCells(map_, 0.25, {});
  EXPECT_TRUE(IsReached(anywhere, 1.7, 1.7));
  EXPECT_TRUE(IsReached(anywhere, 3., 1.));
  EXPECT_FALSE(IsReached(anywhere, 2.15, 1.));
}

TEST_F(ViewpointsTest, ARobotThatDroveALittleBesideFreeSpaceIsInIt) {
  EXPECT_TRUE(IsReached(ReachableCells(map_, 0.25, {{0.05, 1.}}), 1.7, 1.7));
  EXPECT_FALSE(ReachableCells(map_, 0.25, {{-30., 1.}}).any());
}

TEST_F(ViewpointsTest, CoverWhatIsReachable) {
  ViewpointOptions options;
  options.step_meters = 0.3;
  const BoolArray reachable = ReachableCells(map_, 0.25, {{1., 1.}});
  const Viewpoints viewpoints = MakeViewpoints(options, map_, reachable);
  // 1.5 m x 1.5 m, of squares that may begin anywhere.
  EXPECT_GE(viewpoints.positions.size(), 25u);
  EXPECT_LE(viewpoints.positions.size(), 36u);
  for (const Eigen::Vector2d& position : viewpoints.positions) {
    const Eigen::Array2i cell = position.array().floor().cast<int>();
    EXPECT_TRUE(reachable(cell.x(), cell.y()));
  }
  options.max_num_viewpoints = 10;
  const Viewpoints fewer = MakeViewpoints(options, map_, reachable);
  EXPECT_LE(fewer.positions.size(), 10u);
  EXPECT_GT(fewer.step, viewpoints.step);
}

TEST_F(ViewpointsTest, PanoramasShowTheWallsTwiceInARow) {
  const Viewpoints viewpoints =
      MakeViewpoints({}, map_, ReachableCells(map_, 0.25, {{1., 1.}}));
  for (size_t n = 0; n < viewpoints.positions.size(); ++n) {
    const uint8_t* const ranges = viewpoints.RangesOf(n);
    const Eigen::Vector2d p = 0.1 * viewpoints.positions[n] +
                              map_.geometry().T_submap_grid.translation();
    for (int k = 0; k < kNumDirections; ++k) {
      const double angle = 2. * M_PI * (k + 0.5) / kNumDirections;
      const double dx = std::cos(angle), dy = std::sin(angle);
      const double expected = std::min(((dx > 0. ? 2.1 : 0.1) - p.x()) / dx,
                                       ((dy > 0. ? 2.1 : 0.1) - p.y()) / dy);
      EXPECT_NEAR(kPanoramaUnit * ranges[k], expected, 0.15);
      EXPECT_EQ(ranges[k], ranges[k + kNumDirections]);
      EXPECT_EQ(viewpoints.MasksOf(n)[k], 255);
    }
  }
}

TEST(ViewpointOptionsTest, AreValidated) {
  EXPECT_EQ(Validate(ViewpointOptions()), "");
  ViewpointOptions options;
  options.step_meters = 0.;
  EXPECT_THAT(Validate(options), HasSubstr("step_meters"));
  options = {};
  options.max_num_viewpoints = 0;
  EXPECT_THAT(Validate(options), HasSubstr("max_num_viewpoints"));
  options = {};
  options.min_clearance_meters = -1.;
  EXPECT_THAT(Validate(options), HasSubstr("min_clearance_meters"));
}

}  // namespace
}  // namespace cartographer_sdf::viewpoints_test
