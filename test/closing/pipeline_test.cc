// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/pipeline.h"

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/execution/parallel_for.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/two_visits.h"

namespace cartographer_sdf::pipeline_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Two laps of ten submaps along a straight way, 5 m apart.
std::map<SubmapId, OdometryPose> Laps() {
  std::map<SubmapId, OdometryPose> odometry;
  for (int i = 0; i < 20; ++i) {
    odometry[{0, i}] = {Rigid2(5. * (i % 10), 0., 0.), 5. * i};
  }
  return odometry;
}

Closure BetweenLaps(const int index, const double error, const double score,
                    const ClosureStatus status = ClosureStatus::kSelected) {
  Closure closure;
  closure.match.pair = {
      {0, index}, {0, index + 10}, Rigid2(error, 0., 0.), score};
  closure.status = status;
  return closure;
}

std::vector<ClosureStatus> Statuses(const std::vector<Closure>& closures) {
  std::vector<ClosureStatus> statuses;
  for (const Closure& closure : closures) statuses.push_back(closure.status);
  return statuses;
}

TEST(SelectClosuresTest, EachStatusHasItsReason) {
  std::vector<Closure> closures = {
      BetweenLaps(0, 0., 5.), BetweenLaps(1, 0., 5.), BetweenLaps(2, 0., 5.),
      BetweenLaps(3, 8., 9.)};
  EXPECT_THAT(SelectClosures(ConsistencyOptions(), Laps(), {}, &closures),
              IsEmpty());
  EXPECT_THAT(
      Statuses(closures),
      ElementsAre(ClosureStatus::kSelected, ClosureStatus::kSelected,
                  ClosureStatus::kSelected, ClosureStatus::kInconsistent));
  closures = {BetweenLaps(0, 0., 4.)};
  EXPECT_THAT(SelectClosures(ConsistencyOptions(), Laps(), {}, &closures),
              IsEmpty());
  EXPECT_THAT(Statuses(closures), ElementsAre(ClosureStatus::kUnsupported));
}

TEST(SelectClosuresTest, TornSubmapsHaveNoWeight) {
  const std::map<SubmapId, Tear> torn = {{{0, 3}, Tear{}}};
  // Outweighs two others, if it counts.
  std::vector<Closure> closures = {
      BetweenLaps(0, 0., 5.), BetweenLaps(1, 0., 5.), BetweenLaps(3, 8., 20.)};
  std::vector<Closure> same = closures;
  (void)SelectClosures(ConsistencyOptions(), Laps(), {}, &same);
  EXPECT_EQ(same[2].status, ClosureStatus::kSelected);
  EXPECT_EQ(same[0].status, ClosureStatus::kInconsistent);
  (void)SelectClosures(ConsistencyOptions(), Laps(), torn, &closures);
  EXPECT_EQ(closures[2].status, ClosureStatus::kInconsistent);
  EXPECT_EQ(closures[0].status, ClosureStatus::kSelected);
}

TEST(SelectClosuresTest, WhatIsDecidedStaysAndIsReportedWhereContradicted) {
  std::vector<Closure> closures = {
      BetweenLaps(0, 0., 5.), BetweenLaps(1, 0., 5.), BetweenLaps(2, 0., 5.),
      BetweenLaps(3, 8., 9., ClosureStatus::kInGraph),
      BetweenLaps(4, 8., 99., ClosureStatus::kOutlier)};
  EXPECT_THAT(SelectClosures(ConsistencyOptions(), Laps(), {}, &closures),
              ElementsAre(3u));
  EXPECT_THAT(Statuses(closures),
              ElementsAre(ClosureStatus::kSelected, ClosureStatus::kSelected,
                          ClosureStatus::kSelected, ClosureStatus::kInGraph,
                          ClosureStatus::kOutlier));
}

// The first visit and the second one to the same rooms; the pose graph has no
// closure yet.
class CloseGraphTest : public ::testing::Test {
 protected:
  CloseGraphTest() {
    // Nothing but intra-submap constraints: the visits are apart.
    int node = 0;
    for (const auto& [id, pose] : *visits_.Places().odometry) {
      odometry_[id] = pose;
      graph_.submap_poses[id] = pose.T_local_submap;
      for (int k = 0; k < 4; ++k, ++node) {
        const Rigid2 T_submap_node(0.3 * k, 0.1, 0.2);
        Node& added = graph_.nodes[{id.index / 10, node}];
        added.T_map_node = pose.T_local_submap * T_submap_node;
        added.T_local_node = added.T_map_node;
        graph_.constraints.push_back({id,
                                      {id.index / 10, node},
                                      T_submap_node,
                                      1e5,
                                      1e5,
                                      Constraint::Tag::kIntraSubmap});
      }
    }
  }

  [[nodiscard]] Match TrueMatch(const double score) const {
    Match match;
    match.pair = {testing::TwoVisits::kWestFirst,
                  testing::TwoVisits::kWestAgain,
                  visits_.T_west_first_west_again(), score};
    match.verdict = Verdict::kAccepted;
    return match;
  }
  [[nodiscard]] ClosedGraph Close(
      std::vector<Match> matches,
      const std::set<int>& frozen_trajectories = {}) const {
    std::vector<std::pair<std::string, double>> seconds;
    StageClock clock({}, &seconds);
    return CloseGraph(
        options_, {&graph_, &odometry_, visits_.Places().places, &clouds_},
        std::move(matches), frozen_trajectories, MakeExecutor(1), &clock);
  }

  const testing::TwoVisits visits_;
  std::map<SubmapId, OdometryPose> odometry_;
  std::map<NodeId, PointCloud2> clouds_;
  PoseGraph graph_;
  ClosingOptions options_;
};

TEST_F(CloseGraphTest, AMatchBecomesConstraintsAndMovesTheMap) {
  const ClosedGraph closed = Close({TrueMatch(9.)});
  EXPECT_THAT(Statuses(closed.closures), ElementsAre(ClosureStatus::kInGraph));
  // All nodes of both submaps, there being fewer than num_nodes_per_submap.
  EXPECT_EQ(closed.closures[0].constraints.size(), 8u);
  EXPECT_EQ(closed.pose_graph.constraints.size(),
            graph_.constraints.size() + 8u);
  const auto& poses = closed.pose_graph.submap_poses;
  EXPECT_THAT(
      poses.at(testing::TwoVisits::kWestFirst).Inverse() *
          poses.at(testing::TwoVisits::kWestAgain),
      testing::IsPoseNear(visits_.T_west_first_west_again(), 1e-3, 1e-4));
  EXPECT_EQ(closed.optimizations.size(), 1u);
}

TEST_F(CloseGraphTest, TooFewConstraintsAreNoClosure) {
  options_.constraints.min_num_constraints = 9;
  const ClosedGraph closed = Close({TrueMatch(9.)});
  EXPECT_THAT(Statuses(closed.closures),
              ElementsAre(ClosureStatus::kScansDisagree));
  EXPECT_THAT(closed.closures[0].constraints, IsEmpty());
  EXPECT_EQ(closed.pose_graph.constraints.size(), graph_.constraints.size());
}

TEST_F(CloseGraphTest, ClosingAgainAddsNothing) {
  const std::vector<Match> matches = {TrueMatch(9.)};
  graph_ = Close(matches).pose_graph;
  const ClosedGraph again = Close(matches);
  EXPECT_THAT(Statuses(again.closures),
              ElementsAre(ClosureStatus::kAlreadyInGraph));
  EXPECT_EQ(again.pose_graph.constraints.size(), graph_.constraints.size());
  EXPECT_THAT(again.optimizations, IsEmpty());
  for (const auto& [id, pose] : graph_.submap_poses) {
    EXPECT_EQ(again.pose_graph.submap_poses.at(id).translation(),
              pose.translation());
  }
}

TEST_F(CloseGraphTest, AClosureThatTheGraphContradictsIsTriedAsBefore) {
  Match elsewhere = TrueMatch(9.);
  elsewhere.pair.T_reference_query =
      elsewhere.pair.T_reference_query * Rigid2(1., 0., 0.);
  graph_ = Close({elsewhere}).pose_graph;
  const ClosedGraph closed = Close({TrueMatch(9.)});
  EXPECT_EQ(closed.optimizations.empty(), false);
  EXPECT_NE(closed.closures[0].status, ClosureStatus::kAlreadyInGraph);
}

TEST_F(CloseGraphTest, FewConstraintsInTheGraphAreNotEnough) {
  const std::vector<Match> matches = {TrueMatch(9.)};
  graph_ = Close(matches).pose_graph;
  // Two of eight stay.
  graph_.constraints.resize(graph_.constraints.size() - 6);
  EXPECT_THAT(Statuses(Close(matches).closures),
              ElementsAre(ClosureStatus::kInGraph));
}

TEST_F(CloseGraphTest, TheBestOfSeveralTiesStays) {
  const std::vector<Match> matches = {TrueMatch(8.), TrueMatch(9.),
                                      TrueMatch(7.)};
  options_.redundancy.min_num_ties = 1;
  EXPECT_THAT(Statuses(Close(matches).closures),
              ElementsAre(ClosureStatus::kRedundant, ClosureStatus::kInGraph,
                          ClosureStatus::kRedundant));
  options_.redundancy.min_num_ties = 2;
  EXPECT_THAT(Statuses(Close(matches).closures),
              ElementsAre(ClosureStatus::kInGraph, ClosureStatus::kInGraph,
                          ClosureStatus::kRedundant));
}

// Where scans disagree with the best, the next one has its place.
TEST_F(CloseGraphTest, ARedundantClosureReplacesOneThatScansRefuse) {
  for (const Constraint& constraint : graph_.constraints) {
    const Rigid2 T_world_node =
        visits_.T_world_submap(constraint.submap) * constraint.T_submap_node;
    for (const SurfacePoint& point :
         testing::TakeScan(testing::TwoRooms(), T_world_node)) {
      clouds_[constraint.node].push_back(point.position.cast<float>());
    }
  }
  options_.detect_torn_submaps = false;
  options_.redundancy.min_num_ties = 1;
  options_.consistency.max_cycle_sigma_meters = 1e-6;
  Match elsewhere = TrueMatch(9.5);
  elsewhere.pair.T_reference_query =
      elsewhere.pair.T_reference_query * Rigid2(0.8, 0.7, 0.3);
  EXPECT_THAT(
      Statuses(Close({elsewhere, TrueMatch(9.), TrueMatch(8.)}).closures),
      ElementsAre(ClosureStatus::kScansDisagree, ClosureStatus::kInGraph,
                  ClosureStatus::kRedundant));
}

TEST_F(CloseGraphTest, WhatIsNotAcceptedIsNoClosure) {
  Match refused = TrueMatch(9.);
  refused.verdict = Verdict::kAmbiguous;
  const ClosedGraph closed = Close({refused, TrueMatch(3.)});
  EXPECT_THAT(Statuses(closed.closures),
              ElementsAre(ClosureStatus::kUnsupported));
  EXPECT_EQ(closed.pose_graph.constraints.size(), graph_.constraints.size());
}

// All submaps are of trajectory 0, and so are the nodes of the first visit.
TEST_F(CloseGraphTest, FrozenTrajectoriesStayToTheLastBit) {
  const ClosedGraph closed = Close({TrueMatch(9.)}, {0});
  EXPECT_THAT(Statuses(closed.closures), ElementsAre(ClosureStatus::kOutlier));
  for (const auto& [id, pose] : graph_.submap_poses) {
    const Rigid2& after = closed.pose_graph.submap_poses.at(id);
    EXPECT_EQ(after.translation(), pose.translation()) << id;
    EXPECT_EQ(after.rotation(), pose.rotation()) << id;
  }
  for (const auto& [id, node] : graph_.nodes) {
    if (id.trajectory != 0) continue;
    const Rigid2& after = closed.pose_graph.nodes.at(id).T_map_node;
    EXPECT_EQ(after.translation(), node.T_map_node.translation()) << id;
    EXPECT_EQ(after.rotation(), node.T_map_node.rotation()) << id;
  }
}

// Nodes see the room from where they truly are: scans find 15 cm of error.
TEST_F(CloseGraphTest, ScansCorrectWhereAMatchIsOff) {
  for (const Constraint& constraint : graph_.constraints) {
    const Rigid2 T_world_node =
        visits_.T_world_submap(constraint.submap) * constraint.T_submap_node;
    for (const SurfacePoint& point :
         testing::TakeScan(testing::TwoRooms(), T_world_node)) {
      clouds_[constraint.node].push_back(point.position.cast<float>());
    }
  }
  Match match = TrueMatch(9.);
  match.pair.T_reference_query =
      match.pair.T_reference_query * Rigid2(0.12, -0.09, 0.);
  const auto relative = [](const ClosedGraph& closed) {
    const auto& poses = closed.pose_graph.submap_poses;
    return poses.at(testing::TwoVisits::kWestFirst).Inverse() *
           poses.at(testing::TwoVisits::kWestAgain);
  };
  options_.detect_torn_submaps = false;
  // Half a cell.
  EXPECT_THAT(
      relative(Close({match})),
      testing::IsPoseNear(visits_.T_west_first_west_again(), 0.025, 0.002));
  clouds_.clear();
  EXPECT_THAT(relative(Close({match})),
              testing::IsPoseNear(match.pair.T_reference_query, 1e-3, 1e-4));
}

TEST_F(CloseGraphTest, OnlySelectedClosuresGetConstraints) {
  std::vector<Closure> closures = MakeClosures(
      {TrueMatch(9.), TrueMatch(9.), TrueMatch(9.), TrueMatch(9.)});
  closures[1].status = ClosureStatus::kUnsupported;
  closures[2].status = ClosureStatus::kDetectedOnly;
  GenerateConstraints(options_.constraints, FindInsertedNodes(graph_),
                      *visits_.Places().places, {}, MakeExecutor(1), &closures);
  EXPECT_THAT(
      Statuses(closures),
      ElementsAre(ClosureStatus::kInGraph, ClosureStatus::kUnsupported,
                  ClosureStatus::kDetectedOnly, ClosureStatus::kInGraph));
  EXPECT_EQ(closures[0].constraints.size(), 8u);
  EXPECT_THAT(closures[1].constraints, IsEmpty());
  EXPECT_THAT(closures[2].constraints, IsEmpty());
}

// A drive whose odometry is off by a centimetre a step, and has no part in the
// poses.
TEST(OptimizationInForceTest, TakesTheWeightsThatTheMapShows) {
  PoseGraph graph;
  for (int k = 0; k < 25; ++k) {
    Node& node = graph.nodes[{0, k}];
    node.T_map_node = Rigid2(0.5 * k, 0., 0.);
    node.T_local_node = node.T_map_node;
    if (k > 0) node.T_previous_node_by_odometry = Rigid2(0.51, 0., 0.001);
  }
  ClosingOptions options;
  options.optimization.odometry_translation_weight = 7.;
  options.optimization.odometry_rotation_weight = 8.;
  options.optimization.huber_scale = 9.;
  const OptimizationOptions inferred = OptimizationInForce(options, graph);
  EXPECT_EQ(inferred.odometry_translation_weight, 0.);
  EXPECT_EQ(inferred.odometry_rotation_weight, 0.);
  EXPECT_EQ(inferred.huber_scale, 9.);
  // Nothing is shown.
  EXPECT_EQ(OptimizationInForce(options, {}).odometry_translation_weight, 7.);
  options.infer_odometry_weights = false;
  const OptimizationOptions given = OptimizationInForce(options, graph);
  EXPECT_EQ(given.odometry_translation_weight, 7.);
  EXPECT_EQ(given.odometry_rotation_weight, 8.);
}

}  // namespace
}  // namespace cartographer_sdf::pipeline_test
