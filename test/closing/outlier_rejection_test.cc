// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/outlier_rejection.h"

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/synthetic_pose_graph.h"

namespace cartographer_sdf::outlier_rejection_test {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

// Two rounds of 200 m, a submap every 10 m.
testing::RoundTrip MakeMap() {
  testing::RoundTripOptions options;
  options.num_nodes = 800;
  options.nodes_between_submaps = 20;
  options.width = 60.;
  options.height = 40.;
  options.yaw_bias = 3e-4;
  options.translation_noise = 0.002;
  options.yaw_noise = 3e-4;
  return testing::MakeRoundTrip(options);
}

// Three constraints of the query's nodes, wrong by `error`.
Closure MakeClosure(const PoseGraph& truth, const int reference,
                    const int query, const Rigid2& error = Rigid2()) {
  Closure outcome;
  outcome.match.pair.reference = {0, reference};
  outcome.match.pair.query = {0, query};
  outcome.status = ClosureStatus::kInGraph;
  for (const int k : {5, 20, 35}) {
    const NodeId node{0, 20 * query + k};
    outcome.constraints.push_back(testing::InterSubmapConstraint(
        {0, reference}, node,
        error * truth.submap_poses.at({0, reference}).Inverse() *
            truth.nodes.at(node).T_map_node));
  }
  return outcome;
}

std::vector<Closure> TrueClosures(const PoseGraph& truth) {
  std::vector<Closure> closures;
  for (int k = 0; k < 18; k += 2)
    closures.push_back(MakeClosure(truth, k, k + 20));
  return closures;
}

OptimizedGraph OptimizeMap(const PoseGraph& pose_graph,
                           std::vector<Closure>* const closures,
                           const std::set<int>& frozen_trajectories = {}) {
  return OptimizeAndRejectOutliers(OutlierRejectionOptions(),
                                   OptimizationOptions(), frozen_trajectories,
                                   pose_graph, closures);
}

double MaxNodeError(const PoseGraph& pose_graph, const PoseGraph& truth) {
  double max_error = 0.;
  for (const auto& [id, node] : pose_graph.nodes) {
    max_error =
        std::max(max_error, (node.T_map_node.translation() -
                             truth.nodes.at(id).T_map_node.translation())
                                .norm());
  }
  return max_error;
}

void ExpectIdentical(const PoseGraph& a, const PoseGraph& b) {
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (const auto& [id, node] : a.nodes) {
    const Rigid2& pose = b.nodes.at(id).T_map_node;
    ASSERT_EQ(node.T_map_node.translation(), pose.translation()) << id;
    ASSERT_EQ(node.T_map_node.rotation(), pose.rotation()) << id;
  }
  for (const auto& [id, T_map_submap] : a.submap_poses) {
    const Rigid2& pose = b.submap_poses.at(id);
    ASSERT_EQ(T_map_submap.translation(), pose.translation()) << id;
    ASSERT_EQ(T_map_submap.rotation(), pose.rotation()) << id;
  }
  EXPECT_EQ(a.constraints.size(), b.constraints.size());
}

TEST(OptimizeAndRejectOutliersTest, KeepsWhatIsTrue) {
  const testing::RoundTrip map = MakeMap();
  ASSERT_GT(MaxNodeError(map.open_loop, map.truth), 5.);
  std::vector<Closure> closures = TrueClosures(map.truth);
  const OptimizedGraph result = OptimizeMap(map.open_loop, &closures);
  EXPECT_THAT(result.optimizations, SizeIs(1));
  for (const Closure& closure : closures) {
    EXPECT_EQ(closure.status, ClosureStatus::kInGraph);
    EXPECT_THAT(closure.constraints, SizeIs(3));
    EXPECT_LT(closure.graph_error.translation, 0.2);
    EXPECT_LT(closure.graph_error.rotation, 0.05);
  }
  EXPECT_EQ(result.pose_graph.constraints.size(),
            map.open_loop.constraints.size() + 3 * closures.size());
  // The first round is bent still, but both lie on each other.
  EXPECT_LT(MaxNodeError(result.pose_graph, map.truth),
            0.7 * MaxNodeError(map.open_loop, map.truth));
}

TEST(OptimizeAndRejectOutliersTest, AFalseClosureLeavesNoTrace) {
  const testing::RoundTrip map = MakeMap();
  std::vector<Closure> without = TrueClosures(map.truth);
  const OptimizedGraph expected = OptimizeMap(map.open_loop, &without);
  for (const Rigid2& error :
       {Rigid2(10., -4., 0.3), Rigid2(0., 0., M_PI), Rigid2(2., 0., 0.)}) {
    std::vector<Closure> closures = TrueClosures(map.truth);
    closures.insert(closures.begin() + 3, MakeClosure(map.truth, 7, 27, error));
    const OptimizedGraph result = OptimizeMap(map.open_loop, &closures);
    EXPECT_GE(result.optimizations.size(), 2u);
    for (size_t k = 0; k < closures.size(); ++k) {
      EXPECT_EQ(closures[k].status,
                k == 3 ? ClosureStatus::kOutlier : ClosureStatus::kInGraph)
          << k;
    }
    EXPECT_THAT(closures[3].constraints, IsEmpty());
    EXPECT_GT(closures[3].graph_error.translation, 0.5);
    ExpectIdentical(result.pose_graph, expected.pose_graph);
  }
}

TEST(OptimizeAndRejectOutliersTest, SeveralFalseOnesGo) {
  const testing::RoundTrip map = MakeMap();
  std::vector<Closure> closures = TrueClosures(map.truth);
  closures.push_back(MakeClosure(map.truth, 3, 31, Rigid2(8., 5., 1.)));
  closures.push_back(MakeClosure(map.truth, 12, 25, Rigid2(-6., 3., -1.5)));
  closures.push_back(MakeClosure(map.truth, 6, 36, Rigid2(3., -9., 3.)));
  std::vector<Closure> without = TrueClosures(map.truth);
  const OptimizedGraph expected = OptimizeMap(map.open_loop, &without);
  const OptimizedGraph result = OptimizeMap(map.open_loop, &closures);
  for (size_t k = 0; k < closures.size(); ++k) {
    EXPECT_EQ(closures[k].status, k < without.size() ? ClosureStatus::kInGraph
                                                     : ClosureStatus::kOutlier)
        << k;
  }
  ExpectIdentical(result.pose_graph, expected.pose_graph);
}

// The same map twice, unconnected.
PoseGraph Twice(const PoseGraph& one) {
  PoseGraph two = one;
  for (const auto& [id, pose] : one.submap_poses) {
    two.submap_poses[{1, id.index}] = pose;
  }
  for (const auto& [id, node] : one.nodes) two.nodes[{1, id.index}] = node;
  for (Constraint constraint : one.constraints) {
    constraint.submap.trajectory = constraint.node.trajectory = 1;
    two.constraints.push_back(constraint);
  }
  return two;
}

Closure InSecondTrajectory(Closure closure) {
  closure.match.pair.reference.trajectory = 1;
  closure.match.pair.query.trajectory = 1;
  for (Constraint& constraint : closure.constraints) {
    constraint.submap.trajectory = constraint.node.trajectory = 1;
  }
  return closure;
}

TEST(OptimizeAndRejectOutliersTest, UnconnectedMapsNeedNoMoreRounds) {
  const testing::RoundTrip map = MakeMap();
  std::vector<Closure> closures = TrueClosures(map.truth);
  const size_t num_true = closures.size();
  for (size_t k = 0; k < num_true; ++k) {
    closures.push_back(InSecondTrajectory(closures[k]));
  }
  closures.push_back(MakeClosure(map.truth, 7, 27, Rigid2(10., -4., 0.3)));
  closures.push_back(
      InSecondTrajectory(MakeClosure(map.truth, 7, 27, Rigid2(2., 0., 0.))));
  // What is worse in one map says nothing of the other.
  OutlierRejectionOptions options;
  options.max_num_rounds = 1;
  const OptimizedGraph result = OptimizeAndRejectOutliers(
      options, OptimizationOptions(), {}, Twice(map.open_loop), &closures);
  EXPECT_THAT(result.optimizations, SizeIs(2));
  for (size_t k = 0; k < closures.size(); ++k) {
    EXPECT_EQ(closures[k].status, k < 2 * num_true ? ClosureStatus::kInGraph
                                                   : ClosureStatus::kOutlier)
        << k;
  }
}

TEST(OptimizeAndRejectOutliersTest, AsGivenWithoutClosures) {
  const testing::RoundTrip map = MakeMap();
  std::vector<Closure> closures;
  ExpectIdentical(OptimizeMap(map.open_loop, &closures).pose_graph,
                  map.open_loop);
  // Nor do those count that were refused before.
  closures.push_back(MakeClosure(map.truth, 0, 20));
  closures[0].status = ClosureStatus::kInconsistent;
  closures[0].constraints.clear();
  const OptimizedGraph result = OptimizeMap(map.open_loop, &closures);
  ExpectIdentical(result.pose_graph, map.open_loop);
  EXPECT_THAT(result.optimizations, IsEmpty());
  EXPECT_EQ(closures[0].status, ClosureStatus::kInconsistent);
}

TEST(OptimizeAndRejectOutliersTest, MeasuresErrorsInTheLastRoundToo) {
  const testing::RoundTrip map = MakeMap();
  std::vector<Closure> closures = TrueClosures(map.truth);
  closures.push_back(MakeClosure(map.truth, 7, 27, Rigid2(10., -4., 0.3)));
  OutlierRejectionOptions options;
  options.max_num_rounds = 0;
  const OptimizedGraph result = OptimizeAndRejectOutliers(
      options, OptimizationOptions(), {}, map.open_loop, &closures);
  EXPECT_THAT(result.optimizations, SizeIs(1));
  EXPECT_EQ(closures.back().status, ClosureStatus::kInGraph);
  for (const Closure& closure : closures) {
    ConstraintError sum;
    for (const Constraint& constraint : closure.constraints) {
      const ConstraintError error =
          ConstraintResidual(result.pose_graph, constraint);
      sum.translation += error.translation;
      sum.rotation += error.rotation;
    }
    EXPECT_NEAR(closure.graph_error.translation, sum.translation / 3., 1e-9);
    EXPECT_NEAR(closure.graph_error.rotation, sum.rotation / 3., 1e-9);
  }
  EXPECT_GT(closures.back().graph_error.translation, 1.);
}

TEST(OptimizeAndRejectOutliersTest, FrozenTrajectoriesStay) {
  const testing::RoundTrip map = MakeMap();
  // The second round becomes a session of its own, elsewhere.
  const PoseGraph true_graph =
      testing::SplitTrajectory(map.truth, 20, 400, Rigid2());
  const PoseGraph split =
      testing::SplitTrajectory(map.truth, 20, 400, Rigid2(30., -20., 1.));
  std::vector<Closure> closures = TrueClosures(map.truth);
  for (Closure& closure : closures) {
    closure.match.pair.query = {1, closure.match.pair.query.index - 20};
    for (Constraint& constraint : closure.constraints) {
      constraint.node = {1, constraint.node.index - 400};
    }
  }
  const OptimizedGraph result = OptimizeMap(split, &closures, {0});
  for (const auto& [id, node] : result.pose_graph.nodes) {
    const Rigid2& truth = true_graph.nodes.at(id).T_map_node;
    if (id.trajectory == 0) {
      ASSERT_EQ(node.T_map_node.translation(), truth.translation());
      ASSERT_EQ(node.T_map_node.rotation(), truth.rotation());
    } else {
      ASSERT_LT((node.T_map_node.translation() - truth.translation()).norm(),
                0.5);
    }
  }
}

TEST(OptimizeAndRejectOutliersTest, ReportsProgress) {
  const testing::RoundTrip map = MakeMap();
  std::vector<Closure> closures = TrueClosures(map.truth);
  std::vector<double> fractions;
  const OptimizedGraph result = OptimizeAndRejectOutliers(
      OutlierRejectionOptions(), OptimizationOptions(), {}, map.open_loop,
      &closures,
      [&fractions](const double fraction) { fractions.push_back(fraction); });
  EXPECT_EQ(fractions.size(), result.optimizations.size());
  EXPECT_THAT(fractions, ::testing::Each(::testing::Le(1.)));
}

TEST(OutlierRejectionOptionsTest, AreValidated) {
  EXPECT_EQ(Validate(OutlierRejectionOptions()), "");
  const auto error =
      [](const std::function<void(OutlierRejectionOptions*)>& set) {
        OutlierRejectionOptions options;
        set(&options);
        return Validate(options);
      };
  EXPECT_NE(error([](auto* o) { o->max_translation_error_meters = 0.; }), "");
  EXPECT_NE(error([](auto* o) { o->max_rotation_error = NAN; }), "");
  EXPECT_NE(error([](auto* o) { o->max_num_rounds = -1; }), "");
}

TEST(FindOutliersTest, TakesTheWorstAndThoseHalfAsBad) {
  OutlierRejectionOptions options;
  options.max_translation_error_meters = 1.;
  options.max_rotation_error = 0.1;
  using Errors = std::vector<std::optional<ConstraintError>>;
  EXPECT_THAT(FindOutliers(options, Errors{}), IsEmpty());
  EXPECT_THAT(FindOutliers(options, Errors{{{0.9, 0.}}, {{0., 0.09}}}),
              IsEmpty());
  // In units of what is allowed: 4, 1.9, 2.1 by rotation, and one that takes
  // no part.
  EXPECT_THAT(
      FindOutliers(options,
                   Errors{{{4., 0.}}, {{1.9, 0.}}, {{0., 0.21}}, std::nullopt}),
      ::testing::ElementsAre(0, 2));
  // Half of the worst is within what is allowed.
  EXPECT_THAT(FindOutliers(options, Errors{{{1.5, 0.}}, {{0.9, 0.}}}),
              ::testing::ElementsAre(0));
}

}  // namespace
}  // namespace cartographer_sdf::outlier_rejection_test
