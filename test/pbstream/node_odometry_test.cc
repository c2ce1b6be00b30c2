// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/node_odometry.h"

#include <cmath>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::node_odometry_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Key;

constexpr double kTolerance = 1e-12;

// Nodes of trajectory 0 at these times.
std::map<NodeId, Node> NodesAt(const std::vector<int64_t>& times) {
  std::map<NodeId, Node> nodes;
  for (size_t i = 0; i < times.size(); ++i) {
    nodes[NodeId{0, static_cast<int>(i)}].time = times[i];
  }
  return nodes;
}

Rigid3 At(const double x, const double yaw) {
  return Embed3D(Rigid2(x, 0., yaw));
}

TEST(NodeOdometryTest, Interpolates) {
  NodeOdometry odometry(NodesAt({12, 15, 30}));
  ASSERT_TRUE(odometry.Add(0, 10, At(1., 3.)).ok());
  // On the short way, over pi.
  ASSERT_TRUE(odometry.Add(0, 20, At(2., -3.)).ok());
  ASSERT_TRUE(odometry.Add(0, 40, At(4., -2.)).ok());
  ASSERT_EQ(odometry.poses().size(), 3u);
  const double arc = 2. * M_PI - 6.;
  const auto expect = [&](const int node, const double x, const double yaw) {
    const Rigid2 pose = Project2D(odometry.poses().at(NodeId{0, node}));
    EXPECT_NEAR(pose.translation().x(), x, kTolerance);
    EXPECT_NEAR(NormalizeAngle(pose.rotation() - yaw), 0., kTolerance);
  };
  expect(0, 1.2, 3. + 0.2 * arc);
  expect(1, 1.5, 3. + 0.5 * arc);
  expect(2, 3., -2.5);
}

TEST(NodeOdometryTest, CoversItsRangeAlone) {
  NodeOdometry odometry(NodesAt({9, 10, 20, 21}));
  for (const int64_t time : {10, 14, 20}) {
    ASSERT_TRUE(odometry.Add(0, time, At(static_cast<double>(time), 0.)).ok());
  }
  EXPECT_THAT(odometry.poses(),
              ElementsAre(Key(NodeId{0, 1}), Key(NodeId{0, 2})));
  EXPECT_EQ(odometry.poses().at(NodeId{0, 1}).translation.x(), 10.);
  EXPECT_EQ(odometry.poses().at(NodeId{0, 2}).translation.x(), 20.);
}

TEST(NodeOdometryTest, KeepsTrajectoriesApart) {
  std::map<NodeId, Node> nodes;
  nodes[NodeId{0, 0}].time = 15;
  nodes[NodeId{1, 0}].time = 15;
  NodeOdometry odometry(nodes);
  ASSERT_TRUE(odometry.Add(0, 10, At(1., 0.)).ok());
  ASSERT_TRUE(odometry.Add(1, 20, At(2., 0.)).ok());
  EXPECT_THAT(odometry.poses(), IsEmpty());
  ASSERT_TRUE(odometry.Add(0, 20, At(3., 0.)).ok());
  EXPECT_THAT(odometry.poses(), ElementsAre(Key(NodeId{0, 0})));
  // Of a trajectory that has no nodes.
  EXPECT_TRUE(odometry.Add(7, 10, At(1., 0.)).ok());
  EXPECT_TRUE(odometry.Add(7, 9, At(1., 0.)).ok());
}

TEST(NodeOdometryTest, RefusesToGoBackInTime) {
  NodeOdometry odometry(NodesAt({15}));
  ASSERT_TRUE(odometry.Add(0, 10, At(1., 0.)).ok());
  EXPECT_FALSE(odometry.Add(0, 10, At(1., 0.)).ok());
  EXPECT_FALSE(odometry.Add(0, 9, At(1., 0.)).ok());
}

TEST(NodeOdometryTest, ExtremeTimes) {
  // Nodes' times are checked where they are read, odometry's are not.
  NodeOdometry odometry(NodesAt({0, 100}));
  ASSERT_TRUE(
      odometry.Add(0, std::numeric_limits<int64_t>::min(), At(0., 0.)).ok());
  ASSERT_TRUE(
      odometry.Add(0, std::numeric_limits<int64_t>::max(), At(1., 0.)).ok());
  for (const auto& [id, pose] : odometry.poses()) {
    EXPECT_NEAR(pose.translation.x(), 0.5, kTolerance);
  }
}

// The node frame is turned by the gravity alignment against the tracking frame,
// here by yaw alone.
TEST(NodeOdometryTest, RelativeOdometryIsBetweenNodeFrames) {
  std::map<NodeId, Node> nodes = NodesAt({0, 1, 2, 3});
  nodes.erase(NodeId{0, 2});
  for (auto& [id, node] : nodes) {
    node.gravity_alignment =
        Eigen::AngleAxisd(0.5 + id.index, Eigen::Vector3d::UnitZ());
  }
  const Rigid2 T_odometry_0(1., 2., 0.3);
  const Rigid2 T_0_1(0.7, -0.1, 0.4);
  std::map<NodeId, Rigid3> odometry;
  odometry[NodeId{0, 0}] = Embed3D(T_odometry_0);
  odometry[NodeId{0, 1}] = Embed3D(T_odometry_0 * T_0_1);
  odometry[NodeId{0, 3}] = Embed3D(T_odometry_0 * T_0_1 * T_0_1);
  SetRelativeOdometry(odometry, &nodes);
  EXPECT_FALSE(nodes[(NodeId{0, 0})].T_previous_node_by_odometry.has_value());
  // Its predecessor by index is missing.
  EXPECT_FALSE(nodes[(NodeId{0, 3})].T_previous_node_by_odometry.has_value());
  const std::optional<Rigid2> relative =
      nodes[(NodeId{0, 1})].T_previous_node_by_odometry;
  ASSERT_TRUE(relative.has_value());
  EXPECT_NEAR(relative->rotation(), 0.4 + 0.5 - 1.5, kTolerance);
  EXPECT_NEAR(relative->translation().x(),
              0.7 * std::cos(0.5) + 0.1 * std::sin(0.5), kTolerance);
  EXPECT_NEAR(relative->translation().y(),
              0.7 * std::sin(0.5) - 0.1 * std::cos(0.5), kTolerance);
}

}  // namespace
}  // namespace cartographer_sdf::node_odometry_test
