// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pose_graph/rotation_first.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "gtest/gtest.h"
#include "test/testing/synthetic_pose_graph.h"

namespace cartographer_sdf::rotation_first_test {
namespace {

using ::cartographer_sdf::testing::MakeRoundTrip;
using ::cartographer_sdf::testing::NormalNumbers;
using ::cartographer_sdf::testing::RoundTripOptions;
using ::cartographer_sdf::testing::SplitTrajectory;

constexpr double kHuberScale = 10.;

RoundTripOptions SmallRoundTrip() {
  RoundTripOptions options;
  options.num_nodes = 300;
  options.nodes_between_submaps = 15;
  options.nodes_between_closures = 10;
  options.width = 30.;
  options.height = 20.;
  return options;
}

double MaxError(const std::vector<Eigen::Vector3d>& actual,
                const std::vector<Eigen::Vector3d>& expected) {
  double error = 0.;
  for (size_t i = 0; i != actual.size(); ++i) {
    const Eigen::Vector3d difference = actual[i] - expected[i];
    error = std::max({error, difference.head<2>().norm(),
                      std::abs(NormalizeAngle(difference.z()))});
  }
  return error;
}

TEST(RotationFirstPosesTest, FindsConsistentPosesFromAnyStart) {
  RoundTripOptions options = SmallRoundTrip();
  options.closure_translation_noise = 0.;
  options.closure_yaw_noise = 0.;
  const SpaGraph truth = BuildSpaGraph({}, {}, MakeRoundTrip(options).truth);
  SpaGraph graph = truth;
  NormalNumbers normal(42);
  for (size_t i = 1; i != graph.poses.size(); ++i) {
    graph.poses[i] =
        Eigen::Vector3d(normal(100.), normal(100.), 6. * normal(1.));
  }
  const std::optional<std::vector<Eigen::Vector3d>> poses =
      RotationFirstPoses(graph, kHuberScale);
  ASSERT_TRUE(poses.has_value());
  EXPECT_EQ((*poses)[0], truth.poses[0]);
  // All residuals can vanish, so the solver goes on to rounding.
  EXPECT_LT(MaxError(*poses, truth.poses), 1e-9);
}

TEST(RotationFirstPosesTest, TurnsATrajectoryAroundUnderNoise) {
  RoundTripOptions options = SmallRoundTrip();
  options.translation_noise = 0.005;
  options.yaw_noise = 1e-3;
  const testing::RoundTrip trip = MakeRoundTrip(options);
  const SpaGraph truth =
      BuildSpaGraph({}, {}, SplitTrajectory(trip.truth, 10, 150, Rigid2()));
  SpaGraph graph = BuildSpaGraph(
      {}, {}, SplitTrajectory(trip.open_loop, 10, 150, Rigid2(40., 30., M_PI)));
  const double cost = SpaCost(graph, kHuberScale);
  EXPECT_GT(MaxError(graph.poses, truth.poses), 50.);
  const std::optional<std::vector<Eigen::Vector3d>> poses =
      RotationFirstPoses(graph, kHuberScale);
  ASSERT_TRUE(poses.has_value());
  graph.poses = *poses;
  // A round of 100 m bends by some sqrt(150) * 1e-3 rad.
  EXPECT_LT(MaxError(graph.poses, truth.poses), 0.3);
  EXPECT_LT(SpaCost(graph, kHuberScale), 0.003 * cost);
}

TEST(RotationFirstPosesTest, KeepsConstantPoses) {
  const testing::RoundTrip trip = MakeRoundTrip(SmallRoundTrip());
  SpaGraph graph = BuildSpaGraph({}, {}, trip.truth);
  for (size_t i = 0; i < graph.poses.size(); i += 7) {
    graph.constant[i] = true;
    graph.poses[i].x() += 0.5;
  }
  const std::optional<std::vector<Eigen::Vector3d>> poses =
      RotationFirstPoses(graph, kHuberScale);
  ASSERT_TRUE(poses.has_value());
  for (size_t i = 0; i < graph.poses.size(); i += 7) {
    EXPECT_EQ((*poses)[i], graph.poses[i]);
  }
}

TEST(RotationFirstPosesTest, HandlesGraphsWithNothingToMove) {
  const std::optional<std::vector<Eigen::Vector3d>> none =
      RotationFirstPoses(SpaGraph{}, kHuberScale);
  ASSERT_TRUE(none.has_value());
  EXPECT_TRUE(none->empty());
  SpaGraph single;
  single.poses = {{1., 2., 3.}};
  single.constant = {true};
  const std::optional<std::vector<Eigen::Vector3d>> same =
      RotationFirstPoses(single, kHuberScale);
  ASSERT_TRUE(same.has_value());
  EXPECT_EQ(*same, single.poses);
}

}  // namespace
}  // namespace cartographer_sdf::rotation_first_test
