// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/constraint_groups.h"

#include <cmath>
#include <map>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"

namespace cartographer_sdf::constraint_groups_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::IsPoseNear;

constexpr Constraint::Tag kIntra = Constraint::Tag::kIntraSubmap;
constexpr Constraint::Tag kInter = Constraint::Tag::kInterSubmap;

// Submap k of a trajectory holds the nodes [2 k, 2 k + 4), at k metres each
// along its x axis from the submap's origin.
Rigid2 NodeInSubmap(const int submap, const int node) {
  return Rigid2(1. * (node - 2 * submap), 0., 0.1);
}

PoseGraph TwoTrajectories() {
  PoseGraph graph;
  for (int trajectory = 0; trajectory < 2; ++trajectory) {
    for (int submap = 0; submap < 4; ++submap) {
      for (int node = 2 * submap; node < 2 * submap + 4; ++node) {
        graph.constraints.push_back({{trajectory, submap},
                                     {trajectory, node},
                                     NodeInSubmap(submap, node),
                                     1.,
                                     1.,
                                     kIntra});
      }
    }
  }
  return graph;
}

std::map<SubmapId, Eigen::Vector2d> Middles() {
  std::map<SubmapId, Eigen::Vector2d> middles;
  for (int trajectory = 0; trajectory < 2; ++trajectory) {
    for (int submap = 0; submap < 4; ++submap) {
      middles[{trajectory, submap}] = Eigen::Vector2d(10., 0.);
    }
  }
  return middles;
}

// What a constraint of that submap and node must say for the other submap,
// which holds the node, to lie at T_submap_other.
void AddInter(const SubmapId& submap, const Rigid2& T_submap_other,
              const SubmapId& other, const int node, PoseGraph* const graph) {
  graph->constraints.push_back(
      {submap,
       {other.trajectory, node},
       T_submap_other * NodeInSubmap(other.index, node),
       1.,
       1.,
       kInter});
}

TEST(ConstraintGroupsTest, JoinsBothDirectionsOfAPair) {
  PoseGraph graph = TwoTrajectories();
  const size_t first = graph.constraints.size();
  const Rigid2 T_0_1(3., 4., 2.);
  // Node 3 is the second of four in submap 1, and the last one in submap 0.
  AddInter({0, 2}, T_0_1, {1, 1}, 3, &graph);
  AddInter({1, 1}, T_0_1.Inverse(), {0, 2}, 6, &graph);
  const GroupedConstraints grouped =
      GroupConstraints(GroupingOptions(), graph, Middles());
  EXPECT_THAT(grouped.unrelated, IsEmpty());
  ASSERT_EQ(grouped.groups.size(), 1u);
  EXPECT_EQ(grouped.groups[0].reference, (SubmapId{0, 2}));
  EXPECT_EQ(grouped.groups[0].query, (SubmapId{1, 1}));
  EXPECT_THAT(grouped.groups[0].T_reference_query,
              IsPoseNear(T_0_1, 1e-9, 1e-9));
  EXPECT_THAT(grouped.groups[0].constraints, ElementsAre(first, first + 1));
}

TEST(ConstraintGroupsTest, PartsWhatLiesApart) {
  PoseGraph graph = TwoTrajectories();
  const size_t first = graph.constraints.size();
  const Rigid2 T_0_1(3., 4., 2.);
  // At the middle, 10 m away, 0.04 rad are 0.4 m: near the second, not the
  // first of the others.
  AddInter({0, 2}, Rigid2(0., 0.3, 0.) * T_0_1, {1, 1}, 3, &graph);
  AddInter({0, 2}, T_0_1 * Rigid2(0., 0., 0.04), {1, 1}, 4, &graph);
  AddInter({0, 2}, T_0_1, {1, 1}, 3, &graph);
  AddInter({0, 2}, T_0_1 * Rigid2(0., 0., M_PI), {1, 1}, 3, &graph);
  AddInter({0, 2}, T_0_1, {1, 1}, 4, &graph);
  const GroupedConstraints grouped =
      GroupConstraints(GroupingOptions(), graph, Middles());
  ASSERT_EQ(grouped.groups.size(), 2u);
  // The middle one has most neighbours.
  EXPECT_THAT(grouped.groups[0].T_reference_query,
              IsPoseNear(T_0_1, 1e-9, 1e-9));
  EXPECT_THAT(grouped.groups[0].constraints,
              ElementsAre(first, first + 1, first + 2, first + 4));
  EXPECT_THAT(grouped.groups[1].constraints, ElementsAre(first + 3));
}

TEST(ConstraintGroupsTest, LeavesOutWhatRelatesNoTwoKnownSubmaps) {
  PoseGraph graph = TwoTrajectories();
  const size_t first = graph.constraints.size();
  AddInter({0, 2}, Rigid2(), {1, 1}, 3, &graph);   // unknown submap
  AddInter({0, 0}, Rigid2(), {1, 9}, 99, &graph);  // a node in no submap
  AddInter({0, 0}, Rigid2(), {0, 0}, 1, &graph);   // in that submap alone
  AddInter({0, 0}, Rigid2(), {1, 1}, 3, &graph);   // in an unknown one too
  std::map<SubmapId, Eigen::Vector2d> middles = Middles();
  middles.erase({0, 2});
  middles.erase({1, 1});
  const GroupedConstraints grouped =
      GroupConstraints(GroupingOptions(), graph, middles);
  EXPECT_THAT(grouped.unrelated, ElementsAre(first, first + 1, first + 2));
  ASSERT_EQ(grouped.groups.size(), 1u);
  EXPECT_EQ(grouped.groups[0].query, (SubmapId{1, 0}));
}

}  // namespace
}  // namespace cartographer_sdf::constraint_groups_test
