// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/inspection.h"

#include "gtest/gtest.h"

namespace cartographer_sdf::inspection_test {
namespace {

// Two submaps and a node at each; the second is off by `error`.
PoseGraph TwoSubmaps(const Rigid2& T_map_first, const double error) {
  PoseGraph pose_graph;
  for (const int k : {0, 1}) {
    const Rigid2 pose = T_map_first * Rigid2(10. * k, k == 1 ? error : 0., 0.);
    pose_graph.submap_poses[{0, k}] = pose;
    pose_graph.nodes[{0, k}].T_map_node = pose;
  }
  pose_graph.constraints = {{{0, 0},
                             {0, 1},
                             Rigid2(10., 0., 0.),
                             1.,
                             1.,
                             Constraint::Tag::kInterSubmap},
                            {{0, 1},
                             {0, 1},
                             Rigid2(3., 0., 0.),
                             1.,
                             1.,
                             Constraint::Tag::kIntraSubmap}};
  return pose_graph;
}

class InspectionTest : public ::testing::Test {
 protected:
  const Rigid2 T_map_before_{5., -3., 0.4};
  const PoseGraph before_ = TwoSubmaps(T_map_before_, 2.);
  const PoseGraph after_ = TwoSubmaps(Rigid2(), 0.);
  const std::vector<InspectedState> states_ = {
      {"before", "Before", "", &before_}, {"after", "After", "", &after_}};
};

TEST_F(InspectionTest, StatesAreAlignedOnTheFirstSubmap) {
  const std::vector<Rigid2> T_map_states = AlignStates(states_);
  ASSERT_EQ(T_map_states.size(), 2u);
  const Rigid2 first = T_map_states[0] * before_.submap_poses.at({0, 0});
  EXPECT_NEAR(first.translation().norm(), 0., 1e-12);
  EXPECT_NEAR(first.rotation(), 0., 1e-12);
  EXPECT_NEAR(T_map_states[1].translation().norm(), 0., 1e-12);
}

TEST_F(InspectionTest, DisplacementIsSeenFromThere) {
  const std::optional<Displacement> moved = DisplacementOf(states_);
  ASSERT_TRUE(moved.has_value());
  EXPECT_NEAR(moved->largest, 2., 1e-9);
  EXPECT_NEAR(moved->mean, 1., 1e-9);
  EXPECT_FALSE(DisplacementOf({states_[0]}).has_value());
}

TEST_F(InspectionTest, SubmapsHaveTheMeanErrorOfWhatBindsThem) {
  const std::map<SubmapId, double> errors = SubmapErrors(after_, before_);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NEAR(errors.at({0, 0}), 2., 1e-9);
  EXPECT_NEAR(SubmapErrors(after_, after_).at({0, 0}), 0., 1e-9);
}

TEST_F(InspectionTest, StatesWithoutACommonSubmapStayWhereTheyAre) {
  const PoseGraph empty;
  EXPECT_EQ(AlignStates({{"a", "A", "", &empty}, states_[1]})[0].rotation(),
            0.);
  EXPECT_FALSE(
      DisplacementOf({{"a", "A", "", &empty}, states_[1]}).has_value());
}

}  // namespace
}  // namespace cartographer_sdf::inspection_test
