// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <map>
#include <string>
#include <vector>

#include "cartographer_sdf/apps/session.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/drive_state.h"

namespace cartographer_sdf::joined_sessions_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::IsPoseNear;
using ::testing::Key;
using ::testing::Pair;

// Of a product of two poses.
constexpr double kRounding = 1e-12;
constexpr int kNumNodes = 25;
constexpr double kSpacing = 3.;

// Trajectory 7 alone, along a straight way from `T_map_way` on. Odometry is off
// by a centimetre a step, and has no part in the poses.
Session StraightSession(const std::string& path, const Rigid2& T_map_way) {
  Session session;
  session.path = path;
  MapState& state = session.map.state;
  testing::AddStraightDrive(7, T_map_way, kNumNodes, kSpacing, &state);
  for (auto& [id, node] : state.pose_graph.nodes) {
    session.map.point_clouds[id] = {
        Eigen::Vector2f(static_cast<float>(id.index), 1.f)};
    if (id.index == 0) continue;
    node.T_previous_node_by_odometry = Rigid2(kSpacing + 0.01, 0., 0.001);
  }
  for (const auto& [id, pose] : state.pose_graph.submap_poses) {
    Place place;
    place.id = id;
    session.map.places.emplace(id, place);
    session.map.odometry[id] = {pose, kSpacing * id.index};
  }
  return session;
}

class JoinSessionsTest : public ::testing::Test {
 protected:
  // The second session is placed nowhere.
  [[nodiscard]] JoinedSessions Join(const ClosingOptions& options = {}) const {
    return JoinSessions(options, {&first_, &second_, &third_},
                        {{0, Rigid2()}, {2, T_merged_third_}});
  }

  Session first_ = StraightSession("first", Rigid2(0.3, 0.2, 0.1));
  Session second_ = StraightSession("second", Rigid2());
  Session third_ = StraightSession("third", Rigid2(5., 1., -2.));
  const Rigid2 T_merged_third_{10., -3., 1.};
};

TEST_F(JoinSessionsTest, NumbersWhatIsPlaced) {
  const JoinedSessions joined = Join();
  EXPECT_THAT(joined.parts, ElementsAre(Key(0u), Key(2u)));
  EXPECT_EQ(joined.parts.at(0).path, "first");
  EXPECT_EQ(joined.parts.at(2).path, "third");
  EXPECT_THAT(joined.state.trajectories, ElementsAre(0, 1));
  EXPECT_THAT(joined.session_of_trajectory,
              ElementsAre(Pair(0, 0u), Pair(1, 2u)));
  EXPECT_EQ(joined.SessionOf({1, 4}), 2u);
  EXPECT_EQ(Renumbered(joined.parts.at(2), SubmapId{7, 4}), (SubmapId{1, 4}));
}

TEST_F(JoinSessionsTest, MovesEachSessionToItsPlace) {
  third_.map.state.pose_graph.landmark_poses["tag"] =
      Embed3D(Rigid2(1., 2., 0.5));
  const JoinedSessions joined = Join();
  for (int k = 0; k < kNumNodes; ++k) {
    const PoseGraph& first = first_.map.state.pose_graph;
    const PoseGraph& third = third_.map.state.pose_graph;
    // To the last bit.
    EXPECT_EQ(joined.placed.submap_poses.at({0, k}).translation(),
              first.submap_poses.at({7, k}).translation());
    EXPECT_EQ(joined.placed.nodes.at({0, k}).T_map_node.rotation(),
              first.nodes.at({7, k}).T_map_node.rotation());
    EXPECT_THAT(joined.placed.submap_poses.at({1, k}),
                IsPoseNear(T_merged_third_ * third.submap_poses.at({7, k}),
                           kRounding, kRounding));
    EXPECT_THAT(joined.placed.nodes.at({1, k}).T_map_node,
                IsPoseNear(T_merged_third_ * third.nodes.at({7, k}).T_map_node,
                           kRounding, kRounding));
    // What local SLAM says does not move, nor does the state as read.
    EXPECT_EQ(joined.placed.nodes.at({1, k}).T_local_node->translation(),
              third.nodes.at({7, k}).T_local_node->translation());
    EXPECT_EQ(joined.state.pose_graph.submap_poses.at({1, k}).translation(),
              third.submap_poses.at({7, k}).translation());
  }
  EXPECT_THAT(
      Project2D(joined.placed.landmark_poses.at("tag")),
      IsPoseNear(T_merged_third_ * Rigid2(1., 2., 0.5), kRounding, kRounding));
  EXPECT_EQ(joined.placed.constraints.size(), 2u * kNumNodes);
  EXPECT_EQ(joined.placed.constraints.back().submap,
            (SubmapId{1, kNumNodes - 1}));
}

TEST_F(JoinSessionsTest, PlacesOdometryAndScansGetTheNewNumbers) {
  third_.scan_grids[{7, 24}] = {};
  const JoinedSessions joined = Join();
  ASSERT_EQ(joined.places.size(), 2u * kNumNodes);
  for (const auto& [id, place] : joined.places) EXPECT_EQ(place.id, id);
  EXPECT_EQ(joined.odometry.at({1, 4}).distance_driven, 4. * kSpacing);
  EXPECT_EQ(joined.odometry.at({1, 4}).T_local_submap.translation(),
            third_.map.odometry.at({7, 4}).T_local_submap.translation());
  ASSERT_EQ(joined.point_clouds.size(), 2u * kNumNodes);
  EXPECT_EQ(joined.point_clouds.at({1, 9})[0], Eigen::Vector2f(9.f, 1.f));
  EXPECT_THAT(joined.scan_submaps, ElementsAre(SubmapId{1, 24}));
}

TEST_F(JoinSessionsTest, EachIsWeighedByTheOdometryThatItShows) {
  // Of the third, every pose is where odometry has it.
  Rigid2 pose = third_.map.state.pose_graph.nodes.begin()->second.T_map_node;
  for (auto& [id, node] : third_.map.state.pose_graph.nodes) {
    if (id.index > 0) pose = pose * *node.T_previous_node_by_odometry;
    node.T_map_node = pose;
  }
  const std::map<int, OdometryWeights> weights = Join().placed.odometry_weights;
  ASSERT_THAT(weights, ElementsAre(Key(0), Key(1)));
  EXPECT_EQ(weights.at(0).translation, 0.);
  EXPECT_EQ(weights.at(0).rotation, 0.);
  const double local = OptimizationOptions().local_slam_pose_translation_weight;
  EXPECT_GT(weights.at(1).translation, 900. * local);
  EXPECT_GT(weights.at(1).rotation, 900. * local);
  ClosingOptions options;
  options.infer_odometry_weights = false;
  EXPECT_THAT(Join(options).placed.odometry_weights, IsEmpty());
}

TEST_F(JoinSessionsTest, SubmapsOfNoFileAreRemoved) {
  third_.scan_grids[{7, 24}] = {};
  const JoinedSessions joined = Join();
  PoseGraph graph = joined.placed;
  RemoveScanSubmaps(joined, &graph);
  EXPECT_EQ(graph.submap_poses.size(), 2u * kNumNodes - 1u);
  EXPECT_EQ(graph.submap_poses.count({1, 24}), 0u);
  EXPECT_EQ(graph.submap_poses.count({0, 24}), 1u);
  ASSERT_EQ(graph.constraints.size(), 2u * kNumNodes - 1u);
  EXPECT_EQ(graph.constraints.back().submap, (SubmapId{1, 23}));
  EXPECT_EQ(graph.nodes.size(), 2u * kNumNodes);
}

}  // namespace
}  // namespace cartographer_sdf::joined_sessions_test
