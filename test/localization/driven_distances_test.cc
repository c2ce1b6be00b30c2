// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/driven_distances.h"

#include "cartographer_sdf/place_store/described_map.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/drive_state.h"

namespace cartographer_sdf::driven_distances_test {
namespace {

using ::testing::AllOf;
using ::testing::DoubleNear;
using ::testing::Gt;
using ::testing::Lt;
using ::testing::Optional;

TEST(DrivenDistancesTest, AlongTheTrajectory) {
  MapState state;
  testing::AddStraightDrive(3, Rigid2(1., 2., 0.5), 11, 4., &state);
  testing::AddStraightDrive(7, Rigid2(), 2, 4., &state);
  const DrivenDistances distances(state.pose_graph, OdometryPoses(state));
  EXPECT_THAT(distances.Between({3, 0}, {3, 10}),
              Optional(DoubleNear(40., 1e-9)));
  EXPECT_THAT(distances.Between({3, 7}, {3, 4}),
              Optional(DoubleNear(12., 1e-9)));
  EXPECT_THAT(distances.Between({7, 1}, {7, 1}), Optional(0.));
  // Nothing relates the two trajectories.
  EXPECT_FALSE(distances.Between({3, 0}, {7, 0}).has_value());
}

TEST(DrivenDistancesTest, ClosedLoopsAreShortCuts) {
  MapState state;
  testing::AddStraightDrive(0, Rigid2(), 31, 4., &state);
  testing::AddStraightDrive(1, Rigid2(), 3, 4., &state);
  // Node 29 is in submap 29; it was seen again from submap 1, and from the
  // other trajectory.
  for (const SubmapId& submap : {SubmapId{0, 1}, SubmapId{1, 2}}) {
    state.pose_graph.constraints.push_back(
        {submap, {0, 29}, Rigid2(), 1., 1., Constraint::Tag::kInterSubmap});
  }
  const DrivenDistances distances(state.pose_graph, OdometryPoses(state));
  // 4 m to submap 1, the closure, 4 m from submap 29 on.
  EXPECT_THAT(distances.Between({0, 0}, {0, 30}),
              Optional(AllOf(Gt(8.), Lt(20.))));
  EXPECT_EQ(distances.Between({0, 0}, {0, 30}),
            distances.Between({0, 30}, {0, 0}));
  EXPECT_THAT(distances.Between({0, 2}, {0, 10}),
              Optional(DoubleNear(32., 1e-9)));
  EXPECT_TRUE(distances.Between({0, 0}, {1, 0}).has_value());
}

}  // namespace
}  // namespace cartographer_sdf::driven_distances_test
