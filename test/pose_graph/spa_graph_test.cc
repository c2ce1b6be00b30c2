// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pose_graph/spa_graph.h"

#include <cmath>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/synthetic_pose_graph.h"

namespace cartographer_sdf::spa_graph_test {
namespace {

using ::cartographer_sdf::testing::InterSubmapConstraint;
using ::cartographer_sdf::testing::NormalNumbers;
using ::testing::ElementsAre;

Node NodeAt(const Rigid2& T_map_node) {
  Node node;
  node.T_map_node = T_map_node;
  node.T_local_node = T_map_node;
  return node;
}

TEST(SpaErrorTest, IsTheWeightedDifferenceInTheFrameOfTheStart) {
  const SpaEdge edge{0, 1, Rigid2(1., 2., 0.5), 10., 100., false};
  // In the start's frame, which looks along +y, the end lies at (3, -1).
  const SpaError error =
      EvaluateSpaError(edge, {5., 6., M_PI_2}, {6., 9., M_PI_2 + 0.75});
  EXPECT_NEAR(error.residual.x(), 10. * (3. - 1.), 1e-12);
  EXPECT_NEAR(error.residual.y(), 10. * (-1. - 2.), 1e-12);
  EXPECT_NEAR(error.residual.z(), 100. * 0.25, 1e-12);
}

TEST(SpaErrorTest, TakesTheShortWayAround) {
  const SpaEdge edge{0, 1, Rigid2(0., 0., 3.1), 1., 1., false};
  EXPECT_NEAR(EvaluateSpaError(edge, {0., 0., 0.}, {0., 0., -3.1}).residual.z(),
              2. * M_PI - 6.2, 1e-12);
  EXPECT_NEAR(
      EvaluateSpaError(edge, {0., 0., 20. * M_PI}, {0., 0., 3.2}).residual.z(),
      0.1, 1e-12);
}

TEST(SpaErrorTest, JacobiansAreThoseOfNumericDifferentiation) {
  NormalNumbers normal(42);
  // Central differences: error of h^2 / 6 and of rounding / h, each about 1e-7
  // for values of 1e3.
  constexpr double kStep = 1e-5;
  constexpr double kTolerance = 1e-5;
  for (int k = 0; k != 50; ++k) {
    const SpaEdge edge{0,  1,    Rigid2(normal(3.), normal(3.), normal(1.)),
                       7., 130., false};
    const Eigen::Vector3d start(normal(10.), normal(10.), normal(0.3));
    const Eigen::Vector3d end(normal(10.), normal(10.), normal(0.3));
    const SpaError error = EvaluateSpaError(edge, start, end);
    for (int i = 0; i != 3; ++i) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d by_start =
          (EvaluateSpaError(edge, start + step, end).residual -
           EvaluateSpaError(edge, start - step, end).residual) /
          (2. * kStep);
      const Eigen::Vector3d by_end =
          (EvaluateSpaError(edge, start, end + step).residual -
           EvaluateSpaError(edge, start, end - step).residual) /
          (2. * kStep);
      EXPECT_LT((error.jacobian_start.col(i) - by_start).norm(), kTolerance);
      EXPECT_LT((error.jacobian_end.col(i) - by_end).norm(), kTolerance);
    }
  }
}

TEST(SpaCostTest, AppliesTheHuberLossToRobustEdgesOnly) {
  SpaGraph graph;
  graph.poses = {{0., 0., 0.}, {3., 4., 0.}};
  graph.constant = {true, false};
  graph.edges = {SpaEdge{0, 1, Rigid2(), 2., 1., false}};
  EXPECT_NEAR(SpaCost(graph, 4.), 0.5 * 100., 1e-12);
  graph.edges[0].robust = true;
  // Linear beyond the scale: 4 * (10 - 2).
  EXPECT_NEAR(SpaCost(graph, 4.), 32., 1e-12);
  EXPECT_NEAR(SpaCost(graph, 20.), 0.5 * 100., 1e-12);
}

TEST(BuildSpaGraphTest, LinksConsecutiveNodesButNotAcrossGaps) {
  PoseGraph pose_graph;
  pose_graph.submap_poses[{0, 0}] = Rigid2(1., 0., 0.);
  for (const NodeId id : {NodeId{0, 3}, NodeId{0, 4}, NodeId{0, 6},
                          NodeId{1, 7}, NodeId{1, 8}, NodeId{1, 9}}) {
    pose_graph.nodes[id] = NodeAt(Rigid2(id.index, id.trajectory, 0.));
  }
  pose_graph.nodes[{0, 4}].T_previous_node_by_odometry = Rigid2(9., 0., 0.);
  // No link by local SLAM to a node that it says nothing of.
  pose_graph.nodes[{1, 8}].T_local_node.reset();
  OptimizationOptions options;
  options.odometry_translation_weight = 1.;
  options.odometry_rotation_weight = 2.;
  options.local_slam_pose_translation_weight = 3.;
  options.local_slam_pose_rotation_weight = 4.;
  const SpaGraph graph = BuildSpaGraph(options, {}, pose_graph);
  ASSERT_EQ(graph.poses.size(), 7u);
  EXPECT_EQ(graph.poses[0], Eigen::Vector3d(1., 0., 0.));
  EXPECT_EQ(graph.poses[1], Eigen::Vector3d(3., 0., 0.));
  ASSERT_EQ(graph.edges.size(), 2u);
  for (const SpaEdge& edge : graph.edges) {
    EXPECT_EQ(edge.start, 1);
    EXPECT_EQ(edge.end, 2);
    EXPECT_FALSE(edge.robust);
  }
  EXPECT_EQ(graph.edges[0].T_start_end.translation().x(), 9.);
  EXPECT_EQ(graph.edges[0].translation_weight, 1.);
  EXPECT_EQ(graph.edges[0].rotation_weight, 2.);
  EXPECT_EQ(graph.edges[1].T_start_end.translation().x(), 1.);
  EXPECT_EQ(graph.edges[1].translation_weight, 3.);
  EXPECT_EQ(graph.edges[1].rotation_weight, 4.);
}

// Two trajectories with two submaps and three nodes each.
PoseGraph TwoTrajectories() {
  PoseGraph pose_graph;
  for (const int trajectory : {0, 1}) {
    for (const int index : {0, 1}) {
      pose_graph.submap_poses[{trajectory, index}] = Rigid2(index, 0., 0.);
      Constraint constraint =
          InterSubmapConstraint({trajectory, index}, {trajectory, index}, {});
      constraint.tag = Constraint::Tag::kIntraSubmap;
      pose_graph.constraints.push_back(constraint);
    }
    for (const int index : {0, 1, 2}) {
      pose_graph.nodes[{trajectory, index}] = NodeAt(Rigid2(index, 0., 0.));
    }
  }
  return pose_graph;
}

// The order is submaps 0,0 0,1 1,0 1,1, then nodes 0,0 to 1,2.
TEST(BuildSpaGraphTest, HoldsTheFirstSubmapOfEachComponent) {
  PoseGraph pose_graph = TwoTrajectories();
  EXPECT_THAT(BuildSpaGraph({}, {}, pose_graph).constant,
              ElementsAre(true, false, true, false, false, false, false, false,
                          false, false));
  pose_graph.constraints.push_back(InterSubmapConstraint({0, 1}, {1, 2}, {}));
  const SpaGraph graph = BuildSpaGraph({}, {}, pose_graph);
  EXPECT_THAT(graph.constant, ElementsAre(true, false, false, false, false,
                                          false, false, false, false, false));
  EXPECT_FALSE(graph.edges[0].robust);
  EXPECT_TRUE(graph.edges[4].robust);
}

TEST(BuildSpaGraphTest, HoldsFrozenTrajectoriesAndNothingConnectedToThem) {
  PoseGraph pose_graph = TwoTrajectories();
  EXPECT_THAT(BuildSpaGraph({}, {1}, pose_graph).constant,
              ElementsAre(true, false, true, true, false, false, false, true,
                          true, true));
  pose_graph.constraints.push_back(InterSubmapConstraint({0, 1}, {1, 2}, {}));
  EXPECT_THAT(BuildSpaGraph({}, {1}, pose_graph).constant,
              ElementsAre(false, false, true, true, false, false, false, true,
                          true, true));
}

TEST(BuildSpaGraphTest, HoldsANodeWhereAComponentHasNoSubmap) {
  PoseGraph pose_graph;
  pose_graph.nodes[{0, 5}] = NodeAt(Rigid2());
  pose_graph.nodes[{0, 6}] = NodeAt(Rigid2());
  pose_graph.nodes[{0, 8}] = NodeAt(Rigid2());
  EXPECT_THAT(BuildSpaGraph({}, {}, pose_graph).constant,
              ElementsAre(true, false, true));
}

TEST(BuildSpaGraphDeathTest, ConstraintsMustNameElementsOfTheGraph) {
  PoseGraph pose_graph = TwoTrajectories();
  pose_graph.constraints.push_back(InterSubmapConstraint({0, 7}, {1, 2}, {}));
  EXPECT_DEATH(static_cast<void>(BuildSpaGraph({}, {}, pose_graph)),
               "constraint of submap 0,7 and node 1,2");
}

}  // namespace
}  // namespace cartographer_sdf::spa_graph_test
