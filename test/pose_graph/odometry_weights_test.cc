// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <optional>

#include "cartographer_sdf/pose_graph/optimization.h"
#include "gtest/gtest.h"
#include "test/testing/synthetic_pose_graph.h"

namespace cartographer_sdf::odometry_weights_test {
namespace {

// Two rounds of 200 m with drift; none of it optimised yet.
PoseGraph OpenLoop() {
  testing::RoundTripOptions options;
  options.num_nodes = 800;
  options.nodes_between_submaps = 40;
  options.width = 60.;
  options.height = 40.;
  options.yaw_bias = 2e-4;
  options.translation_noise = 0.003;
  options.yaw_noise = 5e-4;
  options.nodes_between_closures = 20;
  return testing::MakeRoundTrip(options).open_loop;
}

// Odometry that differs from local SLAM by these standard deviations.
void AddOdometry(const double translation_sigma, const double rotation_sigma,
                 PoseGraph* const pose_graph) {
  testing::NormalNumbers normal(7);
  const Node* previous = nullptr;
  for (auto& [id, node] : pose_graph->nodes) {
    if (previous != nullptr) {
      const double x = normal(translation_sigma), y = normal(translation_sigma);
      node.T_previous_node_by_odometry = previous->T_local_node->Inverse() *
                                         *node.T_local_node *
                                         Rigid2(x, y, normal(rotation_sigma));
    }
    previous = &node;
  }
}

TEST(InferOdometryWeightsTest, FindsThoseOfTheOptimisation) {
  struct Weights {
    double translation, rotation;
  };
  for (const Weights& weights :
       {Weights{1e5, 1e5}, Weights{3e4, 2e5}, Weights{2e5, 5e4}}) {
    OptimizationOptions options;
    options.odometry_translation_weight = weights.translation;
    options.odometry_rotation_weight = weights.rotation;
    PoseGraph pose_graph = OpenLoop();
    AddOdometry(0.02, 0.005, &pose_graph);
    ASSERT_TRUE(Optimize(options, {}, &pose_graph).converged);
    const std::optional<OdometryWeights> inferred =
        InferOdometryWeights(OptimizationOptions(), pose_graph);
    ASSERT_TRUE(inferred.has_value());
    EXPECT_NEAR(inferred->translation, weights.translation,
                0.005 * weights.translation);
    EXPECT_NEAR(inferred->rotation, weights.rotation, 0.1 * weights.rotation);
  }
}

TEST(InferOdometryWeightsTest, AreRelativeToThoseOfLocalSlam) {
  OptimizationOptions options;
  options.odometry_translation_weight = 3e4;
  PoseGraph pose_graph = OpenLoop();
  AddOdometry(0.02, 0.005, &pose_graph);
  ASSERT_TRUE(Optimize(options, {}, &pose_graph).converged);
  options.local_slam_pose_translation_weight = 2e5;
  const std::optional<OdometryWeights> inferred =
      InferOdometryWeights(options, pose_graph);
  ASSERT_TRUE(inferred.has_value());
  EXPECT_NEAR(inferred->translation, 6e4, 120.);
}

TEST(InferOdometryWeightsTest, ZeroForAMapThatWasNeverOptimised) {
  PoseGraph pose_graph = OpenLoop();
  AddOdometry(0.02, 0.005, &pose_graph);
  const std::optional<OdometryWeights> inferred =
      InferOdometryWeights(OptimizationOptions(), pose_graph);
  ASSERT_TRUE(inferred.has_value());
  EXPECT_EQ(inferred->translation, 0.);
  EXPECT_EQ(inferred->rotation, 0.);
}

TEST(InferOdometryWeightsTest, ZeroWhereOdometryHadNoPart) {
  OptimizationOptions options;
  options.odometry_translation_weight = 0.;
  options.odometry_rotation_weight = 0.;
  PoseGraph pose_graph = OpenLoop();
  AddOdometry(0.02, 0.005, &pose_graph);
  ASSERT_TRUE(Optimize(options, {}, &pose_graph).converged);
  const std::optional<OdometryWeights> inferred =
      InferOdometryWeights(OptimizationOptions(), pose_graph);
  ASSERT_TRUE(inferred.has_value());
  // Closures move the steps by what looks like a little odometry.
  EXPECT_LT(inferred->translation, 1e3);
  EXPECT_LT(inferred->rotation, 1e3);
}

TEST(InferOdometryWeightsTest, NoneWithoutOdometry) {
  EXPECT_FALSE(
      InferOdometryWeights(OptimizationOptions(), OpenLoop()).has_value());
  EXPECT_FALSE(
      InferOdometryWeights(OptimizationOptions(), PoseGraph()).has_value());
}

TEST(InferOdometryWeightsTest, NoneWhereOdometryAgreesWithLocalSlam) {
  PoseGraph pose_graph = OpenLoop();
  AddOdometry(0., 0., &pose_graph);
  Optimize(OptimizationOptions(), {}, &pose_graph);
  EXPECT_FALSE(
      InferOdometryWeights(OptimizationOptions(), pose_graph).has_value());
}

TEST(InferOdometryWeightsTest, NoneOfFewSteps) {
  PoseGraph pose_graph = OpenLoop();
  AddOdometry(0.02, 0.005, &pose_graph);
  int num_steps = 0;
  for (auto& [id, node] : pose_graph.nodes) {
    if (node.T_previous_node_by_odometry && ++num_steps > 19) {
      node.T_previous_node_by_odometry.reset();
    }
  }
  EXPECT_FALSE(
      InferOdometryWeights(OptimizationOptions(), pose_graph).has_value());
}

// Their ratio is all that shows.
TEST(InferOdometryWeightsTest, NoneWithoutLocalSlamWeights) {
  PoseGraph pose_graph = OpenLoop();
  AddOdometry(0.02, 0.005, &pose_graph);
  OptimizationOptions options;
  options.local_slam_pose_translation_weight = 0.;
  EXPECT_FALSE(InferOdometryWeights(options, pose_graph).has_value());
}

TEST(InferOdometryWeightsTest, ReadsNothingAcrossGaps) {
  PoseGraph pose_graph = OpenLoop();
  AddOdometry(0.02, 0.005, &pose_graph);
  const std::optional<OdometryWeights> expected =
      InferOdometryWeights(OptimizationOptions(), pose_graph);
  // Where nodes were trimmed, the next one's odometry is not that of the step.
  pose_graph.nodes.erase({0, 300});
  pose_graph.nodes.at({0, 301}).T_previous_node_by_odometry =
      Rigid2(1e3, 0., 1.);
  const std::optional<OdometryWeights> inferred =
      InferOdometryWeights(OptimizationOptions(), pose_graph);
  ASSERT_TRUE(expected.has_value() && inferred.has_value());
  EXPECT_EQ(inferred->translation, expected->translation);
}

}  // namespace
}  // namespace cartographer_sdf::odometry_weights_test
