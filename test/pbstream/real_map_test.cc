// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Maps that Cartographer wrote.

#include <cmath>
#include <string>
#include <vector>

#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/pbstream/record_stream.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/shared_data.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::real_map_test {
namespace {

using ::cartographer_sdf::testing::TemporaryDirectory;

// Of poses hundreds of metres from the origin, through quaternions.
constexpr double kTolerance = 1e-9;

class RealMapTest : public ::testing::TestWithParam<std::string> {};

RecordReader OpenRecords(const std::string& path) {
  absl::StatusOr<RecordReader> reader = RecordReader::Open(path);
  CHECK(reader.ok()) << reader.status();
  return *std::move(reader);
}

// Numbers of the records that differ, counted from 0.
std::vector<int> DifferentRecords(const std::string& a, const std::string& b) {
  RecordReader reader_a = OpenRecords(a);
  RecordReader reader_b = OpenRecords(b);
  std::vector<int> different;
  std::string record_a;
  std::string record_b;
  for (int i = 0;; ++i) {
    const bool has_a = *reader_a.Read(&record_a);
    const bool has_b = *reader_b.Read(&record_b);
    if (has_a != has_b || record_a != record_b) different.push_back(i);
    if (!has_a || !has_b) return different;
  }
}

void ExpectNear(const Rigid2& actual, const Rigid2& expected) {
  EXPECT_LE((actual.translation() - expected.translation()).norm(), kTolerance);
  EXPECT_NEAR(NormalizeAngle(actual.rotation() - expected.rotation()), 0.,
              kTolerance);
}

// A constraint of consecutive local poses: what local SLAM put into a submap
// must agree with the node's and the submap's pose in the local frame. It ties
// together gravity alignment, node frame and submap frame.
void ExpectIntraConstraintsAgreeWithLocalSlam(const MapState& state) {
  int num_compared = 0;
  for (const Constraint& constraint : state.pose_graph.constraints) {
    const Node& node = state.pose_graph.nodes.at(constraint.node);
    if (constraint.tag != Constraint::Tag::kIntraSubmap ||
        !node.T_local_node.has_value() ||
        state.submaps.count(constraint.submap) == 0) {
      continue;
    }
    const Rigid2 expected =
        state.submaps.at(constraint.submap).T_local_submap.Inverse() *
        *node.T_local_node;
    // Without IMU, node poses of local SLAM are rounded through quaternions of
    // unit norm; files of users come from other versions, too.
    constexpr double kLoose = 1e-6;
    EXPECT_LE((constraint.T_submap_node.translation() - expected.translation())
                  .norm(),
              kLoose);
    EXPECT_NEAR(NormalizeAngle(constraint.T_submap_node.rotation() -
                               expected.rotation()),
                0., kLoose);
    ++num_compared;
  }
  EXPECT_GT(num_compared, 0);
}

TEST_P(RealMapTest, UnchangedMapIsCopied) {
  SKIP_WITHOUT_SHARED_DATA(GetParam());
  const TemporaryDirectory directory;
  const std::string input = SharedDataPath(GetParam());
  const std::string output = directory.File("out.pbstream");
  int num_grids = 0;
  const absl::StatusOr<MapState> state = ReadMap(
      input, {[&](const SubmapId&, const SubmapSummary& summary,
                  const OccupancyGrid& grid) {
        ++num_grids;
        EXPECT_GT(summary.num_known_cells, 0);
        EXPECT_TRUE(
            grid.known
                .select(grid.probability > 0.f && grid.probability < 1.f, true)
                .all());
      }});
  ASSERT_TRUE(state.ok()) << state.status();
  EXPECT_GT(num_grids, 0);
  EXPECT_FALSE(state->pose_graph.nodes.empty());
  ExpectIntraConstraintsAgreeWithLocalSlam(*state);
  const absl::Status status = WriteMap(input, output, state->pose_graph);
  ASSERT_TRUE(status.ok()) << status;
  EXPECT_THAT(DifferentRecords(input, output), ::testing::IsEmpty());
}

TEST_P(RealMapTest, ChangedMapDiffersInItsPoseGraphAlone) {
  SKIP_WITHOUT_SHARED_DATA(GetParam());
  const TemporaryDirectory directory;
  const std::string input = SharedDataPath(GetParam());
  const std::string output = directory.File("out.pbstream");
  const absl::StatusOr<MapState> state = ReadMap(input);
  ASSERT_TRUE(state.ok()) << state.status();
  PoseGraph graph = state->pose_graph;
  const Rigid2 T_new_map(30., -20., 2.);
  for (auto& [id, pose] : graph.submap_poses) pose = T_new_map * pose;
  for (auto& [id, node] : graph.nodes) {
    node.T_map_node = T_new_map * node.T_map_node;
  }
  Constraint closure = graph.constraints.back();
  closure.tag = Constraint::Tag::kInterSubmap;
  closure.T_submap_node = Rigid2(1., 2., 3.);
  graph.constraints.push_back(closure);
  const absl::Status status = WriteMap(input, output, graph);
  ASSERT_TRUE(status.ok()) << status;
  EXPECT_THAT(DifferentRecords(input, output), ::testing::ElementsAre(1));

  const absl::StatusOr<MapState> reread = ReadMap(output);
  ASSERT_TRUE(reread.ok()) << reread.status();
  EXPECT_EQ(reread->num_records, state->num_records);
  ASSERT_EQ(reread->pose_graph.submap_poses.size(), graph.submap_poses.size());
  for (const auto& [id, pose] : graph.submap_poses) {
    ExpectNear(reread->pose_graph.submap_poses.at(id), pose);
  }
  ASSERT_EQ(reread->pose_graph.nodes.size(), graph.nodes.size());
  for (const auto& [id, node] : graph.nodes) {
    const Node& actual = reread->pose_graph.nodes.at(id);
    ExpectNear(actual.T_map_node, node.T_map_node);
    EXPECT_EQ(actual.time, node.time);
    EXPECT_EQ(actual.gravity_alignment.coeffs(),
              node.gravity_alignment.coeffs());
  }
  ASSERT_EQ(reread->pose_graph.constraints.size(), graph.constraints.size());
  for (size_t i = 0; i < graph.constraints.size(); ++i) {
    const Constraint& actual = reread->pose_graph.constraints[i];
    const Constraint& expected = graph.constraints[i];
    EXPECT_EQ(actual.submap, expected.submap);
    EXPECT_EQ(actual.node, expected.node);
    EXPECT_EQ(actual.tag, expected.tag);
    EXPECT_EQ(actual.translation_weight, expected.translation_weight);
    ExpectNear(actual.T_submap_node, expected.T_submap_node);
  }
}

// Whether a cell is occupied, or one of its neighbours.
bool IsNearWall(const OccupancyGrid& grid, const Eigen::Vector2d& p_submap) {
  const Eigen::Array2i centre = grid.geometry.CellAt(p_submap);
  for (int i = centre.x() - 1; i <= centre.x() + 1; ++i) {
    for (int j = centre.y() - 1; j <= centre.y() + 1; ++j) {
      if (grid.geometry.Contains(Eigen::Array2i(i, j)) && grid.known(i, j) &&
          grid.probability(i, j) > 0.5f) {
        return true;
      }
    }
  }
  return false;
}

// Range data of a node lie where its submap has walls, and do not with a
// quarter turn too many.
TEST_P(RealMapTest, PointCloudsHitTheWallsOfTheirSubmap) {
  SKIP_WITHOUT_SHARED_DATA(GetParam());
  const std::string input = SharedDataPath(GetParam());
  const absl::StatusOr<MapState> state = ReadMap(input);
  ASSERT_TRUE(state.ok()) << state.status();
  // A node in the midst of each submap.
  constexpr int kNodeOfSubmap = 15;
  std::map<SubmapId, Constraint> chosen;
  std::map<SubmapId, int> num_nodes;
  std::set<NodeId> nodes;
  for (const Constraint& constraint : state->pose_graph.constraints) {
    if (constraint.tag != Constraint::Tag::kIntraSubmap) continue;
    if (++num_nodes[constraint.submap] == kNodeOfSubmap) {
      chosen.emplace(constraint.submap, constraint);
      nodes.insert(constraint.node);
    }
  }
  const absl::StatusOr<std::map<NodeId, PointCloud2>> clouds =
      ReadPointClouds(input, nodes);
  ASSERT_TRUE(clouds.ok()) << clouds.status();
  int num_points = 0;
  int num_hits = 0;
  int num_hits_turned = 0;
  const absl::StatusOr<MapState> again = ReadMap(
      input, {[&](const SubmapId& id, const SubmapSummary&,
                  const OccupancyGrid& grid) {
        const auto it = chosen.find(id);
        if (it == chosen.end()) return;
        for (const Eigen::Vector2f& point : clouds->at(it->second.node)) {
          const Eigen::Vector2d p_node = point.cast<double>();
          const Rigid2& T_submap_node = it->second.T_submap_node;
          ++num_points;
          num_hits += IsNearWall(grid, T_submap_node * p_node);
          num_hits_turned += IsNearWall(
              grid, T_submap_node * (Rigid2(0., 0., M_PI / 2.) * p_node));
        }
      }});
  ASSERT_TRUE(again.ok());
  ASSERT_GT(num_points, 100);
  // The rest are people, glass and noise; measured: 0.81 to 1.
  EXPECT_GT(num_hits, 0.75 * num_points) << num_points;
  EXPECT_LT(num_hits_turned, 0.5 * num_hits);
}

INSTANTIATE_TEST_SUITE_P(
    SharedData, RealMapTest,
    ::testing::Values("user_map_arena.pbstream", "user_map_odometry.pbstream",
                      "user_map_two_sessions.pbstream",
                      "intel_open_loop.pbstream", "intel_stock.pbstream",
                      "aces_open_loop.pbstream",
                      "mit_killian_open_loop.pbstream", "willow_1.pbstream",
                      "willow_2.pbstream"),
    [](const auto& info) {
      return info.param.substr(0, info.param.find('.'));
    });

}  // namespace
}  // namespace cartographer_sdf::real_map_test
