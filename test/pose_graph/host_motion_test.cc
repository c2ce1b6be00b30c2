// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pose_graph/host_motion.h"

#include <optional>

#include "gtest/gtest.h"
#include "test/testing/node_motion.h"
#include "test/testing/synthetic_pose_graph.h"

namespace cartographer_sdf::host_motion_test {
namespace {

// What the map was optimised with: nearly without odometry.
OptimizationOptions WeakOdometry() {
  OptimizationOptions options;
  options.odometry_translation_weight = 1e3;
  options.odometry_rotation_weight = 1e3;
  return options;
}

// Two rounds of 200 m with closures, optimised with weak odometry, which turns
// by a milliradian a node too much.
PoseGraph ClosedMap() {
  testing::RoundTripOptions options;
  options.num_nodes = 400;
  options.nodes_between_submaps = 20;
  options.width = 60.;
  options.height = 40.;
  options.yaw_bias = 2e-4;
  options.nodes_between_closures = 20;
  PoseGraph pose_graph = testing::MakeRoundTrip(options).open_loop;
  const Node* previous = nullptr;
  for (auto& [id, node] : pose_graph.nodes) {
    if (previous != nullptr) {
      node.T_previous_node_by_odometry = previous->T_local_node->Inverse() *
                                         *node.T_local_node *
                                         Rigid2(0., 0., 1e-3);
    }
    previous = &node;
  }
  EXPECT_TRUE(Optimize(WeakOdometry(), {}, &pose_graph).converged);
  return pose_graph;
}

TEST(PredictHostMotionTest, IsThatOfAnotherOptimisation) {
  const PoseGraph map = ClosedMap();
  const std::optional<HostMotion> motion =
      PredictHostMotion(OptimizationOptions(), WeakOdometry(), map);
  ASSERT_TRUE(motion.has_value());
  EXPECT_EQ(motion->host_weights.translation, 1e5);
  EXPECT_EQ(motion->map_weights.rotation, 1e3);
  PoseGraph moved = map;
  Optimize(OptimizationOptions(), {}, &moved, kSettlingRun);
  // Turned by half of 0.4 rad, within loops of 200 m that closures hold.
  EXPECT_GT(motion->max_translation, 0.3);
  EXPECT_EQ(motion->max_translation, testing::LargestMotion(map, moved));
}

TEST(PredictHostMotionTest, TakesTheWeightsOfTrajectories) {
  PoseGraph map = ClosedMap();
  map.odometry_weights[0] = {1e3, 1e3};
  const std::optional<HostMotion> motion =
      PredictHostMotion(OptimizationOptions(), OptimizationOptions(), map);
  ASSERT_TRUE(motion.has_value());
  EXPECT_EQ(motion->map_weights.translation, 1e3);
  EXPECT_GT(motion->max_translation, 0.3);
}

TEST(PredictHostMotionTest, NoneWithTheSameWeights) {
  OptimizationOptions inferred = WeakOdometry();
  inferred.odometry_translation_weight *= 1.05;
  EXPECT_FALSE(
      PredictHostMotion(WeakOdometry(), inferred, ClosedMap()).has_value());
}

TEST(PredictHostMotionTest, NoneWithoutOdometry) {
  PoseGraph map = ClosedMap();
  for (auto& [id, node] : map.nodes) node.T_previous_node_by_odometry.reset();
  EXPECT_FALSE(PredictHostMotion(OptimizationOptions(), WeakOdometry(), map)
                   .has_value());
  EXPECT_FALSE(
      PredictHostMotion(OptimizationOptions(), WeakOdometry(), {}).has_value());
}

}  // namespace
}  // namespace cartographer_sdf::host_motion_test
