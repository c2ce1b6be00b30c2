// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/trajectory_error.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_sdf::trajectory_error_test {
namespace {

// A square of 4 m.
Truth Square() {
  Truth truth;
  truth.T_world_tracking[{0, 0}] = Rigid2(0., 0., 0.);
  truth.T_world_tracking[{0, 1}] = Rigid2(4., 0., M_PI_2);
  truth.T_world_tracking[{0, 2}] = Rigid2(4., 4., M_PI);
  truth.T_world_tracking[{0, 3}] = Rigid2(0., 4., -M_PI_2);
  return truth;
}

PoseGraph MapOf(const Truth& truth, const Rigid2& T_map_world) {
  PoseGraph graph;
  for (const auto& [id, T_world_tracking] : truth.T_world_tracking) {
    graph.nodes[id].T_map_node = T_map_world * T_world_tracking;
  }
  return graph;
}

TEST(EvaluateTrajectoryTest, ARigidMotionIsNoError) {
  const Rigid2 T_map_world(100., -30., 2.5);
  const std::optional<TrajectoryError> error =
      EvaluateTrajectory(MapOf(Square(), T_map_world), Square());
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->errors.translation.count, 4);
  EXPECT_NEAR(error->errors.translation.max, 0., 1e-12);
  EXPECT_NEAR(error->errors.rotation.max, 0., 1e-12);
  EXPECT_EQ(error->num_skipped, 0);
  EXPECT_NEAR(error->T_world_map.rotation(), -2.5, 1e-12);
}

TEST(EvaluateTrajectoryTest, MeasuresWhatNoMotionExplains) {
  // Opposite corners move out by 1 m along the diagonal: no motion helps.
  PoseGraph graph = MapOf(Square(), Rigid2(3., 4., 1.));
  const double step = std::sqrt(0.5);
  graph.nodes[{0, 0}].T_map_node =
      Rigid2(3., 4., 1.) * Rigid2(-step, -step, 0.1);
  graph.nodes[{0, 2}].T_map_node =
      Rigid2(3., 4., 1.) * Rigid2(4. + step, 4. + step, M_PI + 0.3);
  const std::optional<TrajectoryError> error =
      EvaluateTrajectory(graph, Square());
  ASSERT_TRUE(error.has_value());
  EXPECT_NEAR(error->errors.translation.mean, 0.5, 1e-12);
  EXPECT_NEAR(error->errors.translation.median, 0.5, 1e-12);
  EXPECT_NEAR(error->errors.translation.max, 1., 1e-12);
  EXPECT_NEAR(error->errors.rotation.mean, 0.1, 1e-12);
  EXPECT_NEAR(error->errors.rotation.max, 0.3, 1e-12);
}

TEST(EvaluateTrajectoryTest, RotationsAreOfTheTrackingFrame) {
  PoseGraph graph = MapOf(Square(), Rigid2(3., 4., 1.));
  double yaw = 0.5;
  for (auto& [id, node] : graph.nodes) {
    node.gravity_alignment = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
    node.T_map_node = node.T_map_node * Rigid2(0., 0., -yaw);
    yaw += 1.;
  }
  const std::optional<TrajectoryError> error =
      EvaluateTrajectory(graph, Square());
  ASSERT_TRUE(error.has_value());
  EXPECT_NEAR(error->errors.rotation.max, 0., 1e-12);
}

TEST(EvaluateTrajectoryTest, SkipsAndCountsWhatTheTruthDoesNotKnow) {
  PoseGraph graph = MapOf(Square(), Rigid2());
  graph.nodes[{0, 4}].T_map_node = Rigid2(1000., 0., 0.);
  graph.nodes[{1, 0}].T_map_node = Rigid2(1000., 0., 0.);
  Truth truth = Square();
  truth.T_world_tracking[{7, 7}] = Rigid2();
  const std::optional<TrajectoryError> error = EvaluateTrajectory(graph, truth);
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->num_skipped, 2);
  EXPECT_EQ(error->errors.translation.count, 4);
  EXPECT_NEAR(error->errors.translation.max, 0., 1e-12);
}

TEST(EvaluateTrajectoryTest, NoneWhereTheMotionIsUndetermined) {
  EXPECT_FALSE(EvaluateTrajectory(PoseGraph{}, Square()).has_value());
  EXPECT_FALSE(
      EvaluateTrajectory(MapOf(Square(), Rigid2()), Truth{}).has_value());
  Truth one = Square();
  one.T_world_tracking.erase(++one.T_world_tracking.begin(),
                             one.T_world_tracking.end());
  EXPECT_FALSE(EvaluateTrajectory(MapOf(Square(), Rigid2()), one).has_value());
}

}  // namespace
}  // namespace cartographer_sdf::trajectory_error_test
