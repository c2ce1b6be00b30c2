// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/loop_closing/withdrawal.h"

#include <cmath>
#include <functional>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/synthetic_pose_graph.h"

namespace cartographer_sdf {
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
ClosureOutcome Closure(const PoseGraph& truth, const int reference,
                       const int query, const Rigid2& error = Rigid2()) {
  ClosureOutcome outcome{};
  outcome.match.closure.reference = {0, reference};
  outcome.match.closure.query = {0, query};
  outcome.fate = Fate::kInGraph;
  for (const int k : {5, 20, 35}) {
    const NodeId node{0, 20 * query + k};
    outcome.constraints.push_back(testing::InterSubmapConstraint(
        {0, reference}, node,
        error * truth.submap_poses.at({0, reference}).Inverse() *
            truth.nodes.at(node).T_map_node));
  }
  return outcome;
}

std::vector<ClosureOutcome> TrueClosures(const PoseGraph& truth) {
  std::vector<ClosureOutcome> closures;
  for (int k = 0; k < 18; k += 2) closures.push_back(Closure(truth, k, k + 20));
  return closures;
}

OptimizedGraph OptimizeMap(const PoseGraph& pose_graph,
                           std::vector<ClosureOutcome>* const closures,
                           const std::set<int>& frozen_trajectories = {}) {
  return OptimizeAndWithdraw(WithdrawalOptions(), OptimizationOptions(),
                             frozen_trajectories, pose_graph, closures);
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

TEST(OptimizeAndWithdrawTest, KeepsWhatIsTrue) {
  const testing::RoundTrip map = MakeMap();
  ASSERT_GT(MaxNodeError(map.open_loop, map.truth), 5.);
  std::vector<ClosureOutcome> closures = TrueClosures(map.truth);
  const OptimizedGraph result = OptimizeMap(map.open_loop, &closures);
  EXPECT_THAT(result.optimizations, SizeIs(1));
  for (const ClosureOutcome& closure : closures) {
    EXPECT_EQ(closure.fate, Fate::kInGraph);
    EXPECT_THAT(closure.constraints, SizeIs(3));
    EXPECT_LT(closure.error.translation, 0.2);
    EXPECT_LT(closure.error.rotation, 0.05);
  }
  EXPECT_EQ(result.pose_graph.constraints.size(),
            map.open_loop.constraints.size() + 3 * closures.size());
  // The first round is bent still, but both lie on each other.
  EXPECT_LT(MaxNodeError(result.pose_graph, map.truth),
            0.7 * MaxNodeError(map.open_loop, map.truth));
}

TEST(OptimizeAndWithdrawTest, AFalseClosureLeavesNoTrace) {
  const testing::RoundTrip map = MakeMap();
  std::vector<ClosureOutcome> without = TrueClosures(map.truth);
  const OptimizedGraph expected = OptimizeMap(map.open_loop, &without);
  for (const Rigid2& error :
       {Rigid2(10., -4., 0.3), Rigid2(0., 0., M_PI), Rigid2(2., 0., 0.)}) {
    std::vector<ClosureOutcome> closures = TrueClosures(map.truth);
    closures.insert(closures.begin() + 3, Closure(map.truth, 7, 27, error));
    const OptimizedGraph result = OptimizeMap(map.open_loop, &closures);
    EXPECT_GE(result.optimizations.size(), 2u);
    for (size_t k = 0; k < closures.size(); ++k) {
      EXPECT_EQ(closures[k].fate, k == 3 ? Fate::kWithdrawn : Fate::kInGraph)
          << k;
    }
    EXPECT_THAT(closures[3].constraints, IsEmpty());
    EXPECT_GT(closures[3].error.translation, 0.5);
    ExpectIdentical(result.pose_graph, expected.pose_graph);
  }
}

TEST(OptimizeAndWithdrawTest, SeveralFalseOnesGo) {
  const testing::RoundTrip map = MakeMap();
  std::vector<ClosureOutcome> closures = TrueClosures(map.truth);
  closures.push_back(Closure(map.truth, 3, 31, Rigid2(8., 5., 1.)));
  closures.push_back(Closure(map.truth, 12, 25, Rigid2(-6., 3., -1.5)));
  closures.push_back(Closure(map.truth, 6, 36, Rigid2(3., -9., 3.)));
  std::vector<ClosureOutcome> without = TrueClosures(map.truth);
  const OptimizedGraph expected = OptimizeMap(map.open_loop, &without);
  const OptimizedGraph result = OptimizeMap(map.open_loop, &closures);
  for (size_t k = 0; k < closures.size(); ++k) {
    EXPECT_EQ(closures[k].fate,
              k < without.size() ? Fate::kInGraph : Fate::kWithdrawn)
        << k;
  }
  ExpectIdentical(result.pose_graph, expected.pose_graph);
}

TEST(OptimizeAndWithdrawTest, AsGivenWithoutClosures) {
  const testing::RoundTrip map = MakeMap();
  std::vector<ClosureOutcome> closures;
  ExpectIdentical(OptimizeMap(map.open_loop, &closures).pose_graph,
                  map.open_loop);
  // Nor do those count that were refused before.
  closures.push_back(Closure(map.truth, 0, 20));
  closures[0].fate = Fate::kContradicted;
  closures[0].constraints.clear();
  const OptimizedGraph result = OptimizeMap(map.open_loop, &closures);
  ExpectIdentical(result.pose_graph, map.open_loop);
  EXPECT_THAT(result.optimizations, IsEmpty());
  EXPECT_EQ(closures[0].fate, Fate::kContradicted);
}

TEST(OptimizeAndWithdrawTest, MeasuresErrorsInTheLastRoundToo) {
  const testing::RoundTrip map = MakeMap();
  std::vector<ClosureOutcome> closures = TrueClosures(map.truth);
  closures.push_back(Closure(map.truth, 7, 27, Rigid2(10., -4., 0.3)));
  WithdrawalOptions options;
  options.max_num_rounds = 0;
  const OptimizedGraph result = OptimizeAndWithdraw(
      options, OptimizationOptions(), {}, map.open_loop, &closures);
  EXPECT_THAT(result.optimizations, SizeIs(1));
  EXPECT_EQ(closures.back().fate, Fate::kInGraph);
  for (const ClosureOutcome& closure : closures) {
    ConstraintError sum;
    for (const Constraint& constraint : closure.constraints) {
      const ConstraintError error =
          ConstraintResidual(result.pose_graph, constraint);
      sum.translation += error.translation;
      sum.rotation += error.rotation;
    }
    EXPECT_NEAR(closure.error.translation, sum.translation / 3., 1e-9);
    EXPECT_NEAR(closure.error.rotation, sum.rotation / 3., 1e-9);
  }
  EXPECT_GT(closures.back().error.translation, 1.);
}

TEST(OptimizeAndWithdrawTest, FrozenTrajectoriesStay) {
  const testing::RoundTrip map = MakeMap();
  // The second round becomes a session of its own, elsewhere.
  const PoseGraph true_graph =
      testing::SplitTrajectory(map.truth, 20, 400, Rigid2());
  const PoseGraph split =
      testing::SplitTrajectory(map.truth, 20, 400, Rigid2(30., -20., 1.));
  std::vector<ClosureOutcome> closures = TrueClosures(map.truth);
  for (ClosureOutcome& closure : closures) {
    closure.match.closure.query = {1, closure.match.closure.query.index - 20};
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

TEST(OptimizeAndWithdrawTest, ReportsProgress) {
  const testing::RoundTrip map = MakeMap();
  std::vector<ClosureOutcome> closures = TrueClosures(map.truth);
  std::vector<double> fractions;
  const OptimizedGraph result = OptimizeAndWithdraw(
      WithdrawalOptions(), OptimizationOptions(), {}, map.open_loop, &closures,
      [&fractions](const double fraction) { fractions.push_back(fraction); });
  EXPECT_EQ(fractions.size(), result.optimizations.size());
  EXPECT_THAT(fractions, ::testing::Each(::testing::Le(1.)));
}

TEST(WithdrawalOptionsTest, AreValidated) {
  EXPECT_EQ(Validate(WithdrawalOptions()), "");
  const auto error = [](const std::function<void(WithdrawalOptions*)>& set) {
    WithdrawalOptions options;
    set(&options);
    return Validate(options);
  };
  EXPECT_NE(error([](auto* o) { o->max_translation_error_meters = 0.; }), "");
  EXPECT_NE(error([](auto* o) { o->max_rotation_error = NAN; }), "");
  EXPECT_NE(error([](auto* o) { o->max_num_rounds = -1; }), "");
}

TEST(FateTest, HasANameForEach) {
  EXPECT_STREQ(FateName(Fate::kInGraph), "in_graph");
  EXPECT_STREQ(FateName(Fate::kContradicted), "contradicted_by_others");
  EXPECT_STREQ(FateName(Fate::kUnsupported), "unsupported");
  EXPECT_STREQ(FateName(Fate::kScansDisagree), "scans_disagree");
  EXPECT_STREQ(FateName(Fate::kWithdrawn), "withdrawn");
}

}  // namespace
}  // namespace cartographer_sdf
