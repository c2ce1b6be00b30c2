// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pose_graph/slips.h"

#include <cmath>
#include <optional>

#include "cartographer_sdf/pose_graph/host_motion.h"
#include "cartographer_sdf/pose_graph/optimization.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/node_motion.h"
#include "test/testing/synthetic_pose_graph.h"

namespace cartographer_sdf::slips_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Within the submaps 4 and 5, which begin with the nodes 160 and 200.
constexpr NodeId kSlip{0, 230};
constexpr double kAngle = 0.3;

// Two rounds of 200 m with closures and odometry. Local SLAM is right but for a
// turn on the spot by the given angle at kSlip, and odometry but for one there
// and for noise of its angles.
testing::RoundTrip Drive(const double local_slip, const double wheel_slip,
                         const double odometry_noise = 0.) {
  testing::RoundTripOptions options;
  options.num_nodes = 800;
  options.nodes_between_submaps = 40;
  options.width = 60.;
  options.height = 40.;
  options.nodes_between_closures = 20;
  options.translation_noise = 1e-3;
  options.yaw_noise = 2e-4;
  testing::RoundTrip drive = testing::MakeRoundTrip(options);
  PoseGraph& graph = drive.open_loop;
  const Rigid2 T_pivot_slipped(0., 0., local_slip);
  const Rigid2 T_local_pivot = *graph.nodes.at(kSlip).T_local_node;
  const Rigid2 T_slipped_local =
      T_local_pivot * T_pivot_slipped * T_local_pivot.Inverse();
  testing::NormalNumbers normal(7);
  const Node* previous = nullptr;
  for (auto& [id, node] : graph.nodes) {
    if (previous != nullptr) {
      const double noise = normal(odometry_noise);
      node.T_previous_node_by_odometry =
          drive.truth.nodes.at({0, id.index - 1}).T_map_node.Inverse() *
          drive.truth.nodes.at(id).T_map_node *
          Rigid2(0., 0., noise + (id == kSlip ? wheel_slip : 0.));
    }
    previous = &node;
    if (id < kSlip) continue;
    node.T_local_node = T_slipped_local * *node.T_local_node;
    node.T_map_node = T_slipped_local * node.T_map_node;
  }
  for (auto& [id, T_map_submap] : graph.submap_poses) {
    if (id.index * 40 >= kSlip.index) {
      T_map_submap = T_slipped_local * T_map_submap;
    }
  }
  for (Constraint& constraint : graph.constraints) {
    if (constraint.tag != Constraint::Tag::kIntraSubmap) continue;
    constraint.T_submap_node =
        graph.submap_poses.at(constraint.submap).Inverse() *
        graph.nodes.at(constraint.node).T_map_node;
  }
  return drive;
}

OptimizationOptions Rigid() {
  OptimizationOptions options;
  options.min_slip_angle = M_PI;
  return options;
}

// As maps that people close: odometry weighs little.
OptimizationOptions GivingWay() {
  OptimizationOptions options;
  options.odometry_translation_weight = 1e3;
  options.odometry_rotation_weight = 1e3;
  return options;
}

TEST(SlipsTest, FindsTheStepThatOdometryContradicts) {
  const PoseGraph graph = Drive(kAngle, 0.).open_loop;
  const Slips slips = FindSlips(0.15, graph);
  ASSERT_EQ(slips.size(), 1u);
  EXPECT_EQ(slips.begin()->first, kSlip);
  EXPECT_NEAR(slips.begin()->second, kAngle, 0.01);
  EXPECT_THAT(FindSlips(0.35, graph), IsEmpty());
  EXPECT_NEAR(FindSlips(0.15, Drive(-kAngle, 0.).open_loop).at(kSlip), -kAngle,
              0.01);
}

TEST(SlipsTest, NoneWhereAStepIsNotKnown) {
  PoseGraph without_odometry = Drive(kAngle, 0.).open_loop;
  without_odometry.nodes.at(kSlip).T_previous_node_by_odometry.reset();
  EXPECT_THAT(FindSlips(0.15, without_odometry), IsEmpty());
  PoseGraph without_previous = Drive(kAngle, 0.).open_loop;
  without_previous.nodes.erase({0, kSlip.index - 1});
  EXPECT_THAT(FindSlips(0.15, without_previous), IsEmpty());
  PoseGraph without_data = Drive(kAngle, 0.).open_loop;
  without_data.nodes.at({0, kSlip.index - 1}).T_local_node.reset();
  EXPECT_THAT(FindSlips(0.15, without_data), IsEmpty());
}

TEST(SlipsTest, FindsSubmapsWithScansFromBothSides) {
  const PoseGraph graph = Drive(0., 0.).open_loop;
  const auto submaps = [&graph](const int node) {
    return SubmapsWithSlips({{NodeId{0, node}, kAngle}}, graph);
  };
  EXPECT_THAT(submaps(230), ElementsAre(SubmapId{0, 4}, SubmapId{0, 5}));
  // The first scan of a submap is on the far side alone.
  EXPECT_THAT(submaps(200), ElementsAre(SubmapId{0, 4}));
  EXPECT_THAT(submaps(201), ElementsAre(SubmapId{0, 4}, SubmapId{0, 5}));
  EXPECT_THAT(SubmapsWithSlips({}, graph), IsEmpty());
}

TEST(SlipsTest, TheMapGivesWay) {
  const testing::RoundTrip drive = Drive(kAngle, 0.);
  PoseGraph rigid = drive.open_loop;
  ASSERT_TRUE(Optimize(Rigid(), {}, &rigid).converged);
  EXPECT_GT(testing::LargestMotion(rigid, drive.truth), 0.5);
  PoseGraph mended = drive.open_loop;
  ASSERT_TRUE(Optimize(GivingWay(), {}, &mended).converged);
  EXPECT_LT(testing::LargestMotion(mended, drive.truth), 0.15);
}

// Closures decide whether local SLAM or odometry is right.
TEST(SlipsTest, WheelsThatSlipBendNothing) {
  const testing::RoundTrip drive = Drive(0., kAngle);
  ASSERT_EQ(FindSlips(0.15, drive.open_loop).size(), 1u);
  PoseGraph graph = drive.open_loop;
  ASSERT_TRUE(Optimize(OptimizationOptions(), {}, &graph).converged);
  EXPECT_LT(testing::LargestMotion(graph, drive.truth), 0.15);
}

// Otherwise a map that is closed twice would trust odometry the second time.
TEST(SlipsTest, DoNotTellTheWeightOfOdometry) {
  PoseGraph graph = Drive(kAngle, 0., 0.005).open_loop;
  ASSERT_TRUE(Optimize(GivingWay(), {}, &graph).converged);
  const std::optional<OdometryWeights> weights =
      InferOdometryWeights(OptimizationOptions(), graph);
  ASSERT_TRUE(weights.has_value());
  EXPECT_LT(weights->rotation, 3e3);
  const std::optional<OdometryWeights> of_all =
      InferOdometryWeights(Rigid(), graph);
  ASSERT_TRUE(of_all.has_value());
  EXPECT_GT(of_all->rotation, 1e5);
}

TEST(SlipsTest, CartographerDoesNotGiveWay) {
  PoseGraph graph = Drive(kAngle, 0.).open_loop;
  ASSERT_TRUE(Optimize(GivingWay(), {}, &graph).converged);
  // The weights are the same.
  const std::optional<HostMotion> motion =
      PredictHostMotion(GivingWay(), GivingWay(), graph);
  ASSERT_TRUE(motion.has_value());
  EXPECT_EQ(motion->num_slips, 1u);
  EXPECT_GT(motion->max_translation, 0.3);
}

TEST(SlipsTest, AnAngleMustBePositive) {
  OptimizationOptions options;
  options.min_slip_angle = 0.;
  EXPECT_EQ(Validate(options), "min_slip_angle must be positive");
}

}  // namespace
}  // namespace cartographer_sdf::slips_test
