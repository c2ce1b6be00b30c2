// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/map_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "cartographer_sdf/pbstream/pose_codec.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/open_counter.h"
#include "test/testing/small_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::map_file_test {
namespace {

using ::cartographer_sdf::testing::Container;
using ::cartographer_sdf::testing::OpenCounter;
using ::cartographer_sdf::testing::ReadFile;
using ::cartographer_sdf::testing::ReadRecords;
using ::cartographer_sdf::testing::SmallMap;
using ::cartographer_sdf::testing::TemporaryDirectory;
using ::cartographer_sdf::testing::WriteFile;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::Key;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

// Of a few products of poses.
constexpr double kTolerance = 1e-12;

constexpr int kTrajectory = SmallMap::kTrajectory;

void ExpectNear(const Rigid2& actual, const Rigid2& expected) {
  EXPECT_NEAR(actual.translation().x(), expected.translation().x(), kTolerance);
  EXPECT_NEAR(actual.translation().y(), expected.translation().y(), kTolerance);
  EXPECT_NEAR(NormalizeAngle(actual.rotation() - expected.rotation()), 0.,
              kTolerance);
}

class MapFileTest : public ::testing::Test {
 protected:
  void SetUp() override { Write(SmallMap()); }

  void Write(const SmallMap& map) {
    WriteFile(input_, Container(map.Records()));
  }

  MapState Read(const std::string& path) {
    absl::StatusOr<MapState> state = ReadMap(path);
    CHECK(state.ok()) << state.status();
    return *std::move(state);
  }

  // The pose graph of the output, which must differ from the input in nothing
  // else.
  proto::PoseGraph WrittenPoseGraph() {
    const std::vector<std::string> before = ReadRecords(input_);
    std::vector<std::string> after = ReadRecords(output_);
    proto::SerializedData data;
    CHECK(data.ParseFromString(after[1]));
    EXPECT_EQ(data.GetReflection()->GetUnknownFields(data).field_count(), 1);
    EXPECT_EQ(data.pose_graph()
                  .GetReflection()
                  ->GetUnknownFields(data.pose_graph())
                  .field_count(),
              1);
    after[1] = before[1];
    EXPECT_THAT(after, ElementsAreArray(before));
    return data.pose_graph();
  }

  std::string WriteError(const PoseGraph& graph) {
    const absl::Status status = WriteMap(input_, output_, graph);
    EXPECT_FALSE(std::filesystem::exists(output_));
    return std::string(status.message());
  }

  const TemporaryDirectory directory_;
  const std::string input_ = directory_.File("in.pbstream");
  const std::string output_ = directory_.File("out.pbstream");
};

TEST_F(MapFileTest, CountsRecords) {
  const MapState state = Read(input_);
  EXPECT_EQ(state.format_version, 2);
  EXPECT_THAT(state.trajectories, ElementsAre(kTrajectory));
  EXPECT_THAT(
      state.num_records,
      UnorderedElementsAre(
          Pair("pose_graph", 1), Pair("all_trajectory_builder_options", 1),
          Pair("submap", 2), Pair("node", 4), Pair("trajectory_data", 1),
          Pair("imu_data", 2), Pair("odometry_data", 7),
          Pair("landmark_data", 1), Pair("unknown", 1)));
}

TEST_F(MapFileTest, ReadsNodesInTheGravityAlignedFrame) {
  const MapState state = Read(input_);
  ASSERT_EQ(state.pose_graph.nodes.size(), 4u);
  for (int i = 0; i < SmallMap::kNumNodes; ++i) {
    const Node& node = state.pose_graph.nodes.at(NodeId{kTrajectory, i});
    ExpectNear(node.T_map_node, SmallMap::NodePose(i));
    EXPECT_EQ(node.time, SmallMap::NodeTime(i));
    EXPECT_NEAR(node.gravity_alignment.angularDistance(SmallMap::Gravity(i)),
                0., 1e-7);
    ASSERT_TRUE(node.T_local_node.has_value());
    ExpectNear(*node.T_local_node, SmallMap::LocalNodePose(i));
  }
}

TEST_F(MapFileTest, ReadsConstraintsLandmarksAndSubmapPoses) {
  const MapState state = Read(input_);
  ASSERT_EQ(state.pose_graph.constraints.size(), 5u);
  const Constraint& last = state.pose_graph.constraints.back();
  EXPECT_EQ(last.submap, (SubmapId{kTrajectory, 1}));
  EXPECT_EQ(last.node, (NodeId{kTrajectory, 0}));
  EXPECT_EQ(last.tag, Constraint::Tag::kInterSubmap);
  EXPECT_EQ(last.translation_weight, 500.);
  EXPECT_EQ(last.rotation_weight, 1601.);
  EXPECT_EQ(state.pose_graph.constraints[0].tag, Constraint::Tag::kIntraSubmap);
  for (const Constraint& constraint : state.pose_graph.constraints) {
    ExpectNear(constraint.T_submap_node,
               SmallMap::ConstraintPose(constraint.submap.index,
                                        constraint.node.index));
  }
  ASSERT_EQ(state.pose_graph.submap_poses.size(), 2u);
  for (const auto& [id, pose] : state.pose_graph.submap_poses) {
    ExpectNear(pose, SmallMap::SubmapPose(id.index));
  }
  ASSERT_THAT(state.pose_graph.landmark_poses, ElementsAre(Key("tag")));
  EXPECT_EQ(state.pose_graph.landmark_poses.at("tag").translation,
            Eigen::Vector3d(1., 2., 3.));
}

TEST_F(MapFileTest, LeavesOutOdometryAsIfThereWereNone) {
  const MapSource source(input_, MissingRecords::kRefuse,
                         OdometryRecords::kDrop);
  const absl::StatusOr<MapState> state = ReadMap(source);
  ASSERT_TRUE(state.ok()) << state.status();
  const MapState with_odometry = Read(input_);
  EXPECT_EQ(state->num_records.count("odometry_data"), 0u);
  EXPECT_EQ(state->num_dropped_odometry_records,
            with_odometry.num_records.at("odometry_data"));
  EXPECT_EQ(with_odometry.num_dropped_odometry_records, 0);
  EXPECT_EQ(state->num_records.size() + 1, with_odometry.num_records.size());
  for (const auto& [id, node] : state->pose_graph.nodes) {
    EXPECT_FALSE(node.T_previous_node_by_odometry.has_value());
    ExpectNear(node.T_map_node,
               with_odometry.pose_graph.nodes.at(id).T_map_node);
  }
  ASSERT_TRUE(WriteMap(source, output_, state->pose_graph).ok());
  std::vector<std::string> expected = ReadRecords(input_);
  const auto is_odometry = [](const std::string& record) {
    proto::SerializedData data;
    return data.ParseFromString(record) && data.has_odometry_data();
  };
  // The header is no record of this kind.
  const auto end =
      std::remove_if(expected.begin() + 1, expected.end(), is_odometry);
  EXPECT_EQ(expected.end() - end, 7);
  expected.erase(end, expected.end());
  EXPECT_THAT(ReadRecords(output_), ElementsAreArray(expected));
}

TEST_F(MapFileTest, ChecksOdometryThatItLeavesOut) {
  SmallMap map;
  std::swap(map.odometry[0], map.odometry[1]);
  Write(map);
  const absl::Status status =
      ReadMap({input_, MissingRecords::kRefuse, OdometryRecords::kDrop})
          .status();
  EXPECT_THAT(std::string(status.message()), HasSubstr("time"));
}

TEST_F(MapFileTest, ReadsOdometryBetweenNodes) {
  const MapState state = Read(input_);
  const auto odometry = [&](const int node) {
    return state.pose_graph.nodes.at(NodeId{kTrajectory, node})
        .T_previous_node_by_odometry;
  };
  // The first node is before the first measurement.
  EXPECT_FALSE(odometry(0).has_value());
  EXPECT_FALSE(odometry(1).has_value());
  ASSERT_TRUE(odometry(2).has_value());
  ASSERT_TRUE(odometry(3).has_value());
  // One second of a circle of 10 m radius at 1 m/s, turned by the yaw of the
  // gravity alignments; their tilt of up to 0.04 rad acts in second order.
  constexpr double kTilt = 2e-3;
  const auto yaw = [](const int node) { return Rigid2(0., 0., 0.8 + node); };
  const Rigid2 drive(10. * std::sin(0.1), 10. - 10. * std::cos(0.1), 0.1);
  const Rigid2 expected = yaw(1) * drive * yaw(2).Inverse();
  EXPECT_NEAR(odometry(2)->rotation(), expected.rotation(), kTilt);
  EXPECT_LE((odometry(2)->translation() - expected.translation()).norm(),
            kTilt);
}

TEST_F(MapFileTest, ReadsSubmaps) {
  std::vector<SubmapId> ids;
  const absl::StatusOr<MapState> state = ReadMap(
      input_, {[&](const SubmapId& id, const SubmapSummary& summary,
                   const OccupancyGrid& grid) {
        ids.push_back(id);
        EXPECT_EQ(summary.finished, id.index == 0);
        EXPECT_EQ(summary.num_range_data, 10 + id.index);
        EXPECT_FALSE(summary.is_tsdf);
        EXPECT_EQ(summary.num_known_cells, 4);
        ExpectNear(summary.T_local_submap, SmallMap::LocalSubmapPose(id.index));
        // (1.75, 0.75) in the local frame.
        const Eigen::Array2i cell = grid.geometry.CellAt(
            Eigen::Vector2d(1.75 - 1.5 * id.index, 0.75 - 0.25));
        EXPECT_TRUE(grid.known(cell.x(), cell.y()));
        EXPECT_NEAR(grid.probability(cell.x(), cell.y()), 0.9, 1e-6);
      }});
  ASSERT_TRUE(state.ok()) << state.status();
  EXPECT_THAT(ids,
              ElementsAre(SubmapId{kTrajectory, 0}, SubmapId{kTrajectory, 1}));
  EXPECT_EQ(state->submaps.size(), 2u);
}

TEST_F(MapFileTest, SubmapWithoutGridIsListed) {
  SmallMap map;
  map.submaps[1].mutable_submap_2d()->clear_grid();
  Write(map);
  int num_grids = 0;
  const absl::StatusOr<MapState> state =
      ReadMap(input_, {[&](const SubmapId&, const SubmapSummary&,
                           const OccupancyGrid&) { ++num_grids; }});
  ASSERT_TRUE(state.ok()) << state.status();
  EXPECT_EQ(num_grids, 1);
  EXPECT_EQ(state->submaps.size(), 2u);
  EXPECT_EQ(state->submaps.at(SubmapId{kTrajectory, 1}).num_known_cells, 0);
}

TEST_F(MapFileTest, ReadsFormatVersion1) {
  SmallMap map;
  map.header.set_format_version(1);
  Write(map);
  EXPECT_EQ(Read(input_).format_version, 1);
}

TEST_F(MapFileTest, ReadsPointClouds) {
  const NodeId first{kTrajectory, 0};
  const NodeId third{kTrajectory, 2};
  const absl::StatusOr<std::map<NodeId, PointCloud2>> clouds = ReadPointClouds(
      input_, {first, third, NodeId{kTrajectory, 9}, NodeId{0, 0}});
  ASSERT_TRUE(clouds.ok()) << clouds.status();
  ASSERT_THAT(*clouds, ElementsAre(Key(first), Key(third)));
  ASSERT_EQ(clouds->at(third).size(), 1u);
  EXPECT_LE((clouds->at(third)[0] - Eigen::Vector2f(2.f, -0.001f)).norm(),
            1e-6f);
}

TEST_F(MapFileTest, VisitsPointCloudsWhileItReads) {
  OpenCounter counter(input_);
  std::map<NodeId, PointCloud2> clouds;
  int num_grids = 0;
  const absl::StatusOr<MapState> state =
      ReadMap(input_, {[&num_grids](const SubmapId&, const SubmapSummary&,
                                    const OccupancyGrid&) { ++num_grids; },
                       [&clouds](const NodeId& id, PointCloud2 cloud) {
                         clouds.emplace(id, std::move(cloud));
                       }});
  ASSERT_TRUE(state.ok()) << state.status();
  EXPECT_EQ(counter.Count(), 1);
  EXPECT_EQ(num_grids, 2);
  const NodeId first{kTrajectory, 0}, second{kTrajectory, 1},
      third{kTrajectory, 2}, fourth{kTrajectory, 3};
  EXPECT_THAT(clouds,
              ElementsAre(Key(first), Key(second), Key(third), Key(fourth)));
  EXPECT_EQ(clouds, *ReadPointClouds(input_, {first, second, third, fourth}));
}

// A file that was cut at the border of a record.
class CutMapTest : public MapFileTest {
 protected:
  CutMapTest() { map_.nodes.resize(2); }
  void SetUp() override { Write(map_); }

  SmallMap map_;
};

TEST_F(CutMapTest, IsRefusedWithTheNumbers) {
  EXPECT_THAT(std::string(ReadMap(input_).status().message()),
              HasSubstr(input_ + " is not whole: 0 of 2 submaps and 2 of 4 "
                                 "nodes in its pose graph have no record"));
  map_.nodes.clear();
  map_.submaps.resize(1);
  Write(map_);
  EXPECT_THAT(std::string(ReadMap(input_).status().message()),
              HasSubstr("1 of 2 submaps and 4 of 4 nodes"));
}

TEST_F(CutMapTest, CanBeLookedAt) {
  const absl::StatusOr<MapState> kept =
      ReadMap({input_, MissingRecords::kKeep});
  ASSERT_TRUE(kept.ok()) << kept.status();
  EXPECT_EQ(kept->num_unrecorded_submaps, 0);
  EXPECT_EQ(kept->num_unrecorded_nodes, 2);
  EXPECT_EQ(kept->pose_graph.nodes.size(), 4u);
  EXPECT_FALSE(kept->pose_graph.nodes.at(NodeId{kTrajectory, 3}).T_local_node);
  EXPECT_EQ(kept->pose_graph.constraints.size(), 5u);
}

TEST_F(CutMapTest, CanBeRepaired) {
  const absl::StatusOr<MapState> repaired =
      ReadMap({input_, MissingRecords::kDrop});
  ASSERT_TRUE(repaired.ok()) << repaired.status();
  EXPECT_EQ(repaired->num_unrecorded_nodes, 2);
  EXPECT_THAT(
      repaired->pose_graph.nodes,
      ElementsAre(Key(NodeId{kTrajectory, 0}), Key(NodeId{kTrajectory, 1})));
  // Those of the nodes 2 and 3 are gone.
  EXPECT_EQ(repaired->pose_graph.constraints.size(), 3u);
  // The output is whole, from whatever graph, and is the same.
  EXPECT_THAT(WriteError(repaired->pose_graph), HasSubstr("is not whole"));
  const MapSource source(input_, MissingRecords::kDrop);
  ASSERT_TRUE(WriteMap(source, output_, repaired->pose_graph).ok());
  const std::string expected = ReadFile(output_);
  const MapState read = Read(output_);
  EXPECT_EQ(read.num_unrecorded_nodes, 0);
  EXPECT_EQ(read.pose_graph.nodes.size(), 2u);
  EXPECT_EQ(read.pose_graph.constraints.size(), 3u);
  ASSERT_TRUE(WriteMap(source, output_,
                       ReadMap({input_, MissingRecords::kKeep})->pose_graph)
                  .ok());
  EXPECT_EQ(ReadFile(output_), expected);
}

TEST_F(MapFileTest, TellsItsTrajectories) {
  EXPECT_THAT(*ReadTrajectories(input_), ElementsAre(kTrajectory));
  EXPECT_TRUE(CheckHasTrajectories(input_, {}).ok());
  EXPECT_TRUE(CheckHasTrajectories("/nowhere", {}).ok());
  EXPECT_TRUE(CheckHasTrajectories(input_, {kTrajectory}).ok());
  EXPECT_EQ(
      std::string(CheckHasTrajectories(input_, {kTrajectory, 7}).message()),
      input_ + " has no trajectory 7; it has 5");
  EXPECT_FALSE(CheckHasTrajectories("/nowhere", {0}).ok());
}

// What local data are damaged is copied as it is; nothing of it may appear.
TEST_F(MapFileTest, WritesNothingThatTheHostWouldNotLoad) {
  SmallMap map;
  map.nodes[1]
      .mutable_node_data()
      ->mutable_filtered_gravity_aligned_point_cloud()
      ->set_num_points(2);
  Write(map);
  const PoseGraph graph = Read(input_).pose_graph;
  EXPECT_THAT(WriteError(graph),
              HasSubstr("cannot write " + output_ +
                        ": Cartographer would not load it: "));
}

TEST_F(MapFileTest, ProgressGrowsToOne) {
  double last = 0.;
  int num_calls = 0;
  const ProgressCallback on_progress = [&](const double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    ++num_calls;
  };
  ASSERT_TRUE(ReadMap(input_, {}, on_progress).ok());
  EXPECT_EQ(last, 1.);
  EXPECT_GT(num_calls, 10);
  last = 0.;
  ASSERT_TRUE(
      WriteMap(input_, output_, Read(input_).pose_graph, on_progress).ok());
  EXPECT_EQ(last, 1.);
}

TEST_F(MapFileTest, AnUnchangedMapIsCopied) {
  ASSERT_TRUE(WriteMap(input_, output_, Read(input_).pose_graph).ok());
  EXPECT_THAT(ReadRecords(output_), ElementsAreArray(ReadRecords(input_)));
}

TEST_F(MapFileTest, KeepsRecordsCompressedAsTheyAre) {
  ASSERT_TRUE(WriteMap(input_, output_, Read(input_).pose_graph).ok());
  EXPECT_TRUE(ReadFile(output_) == ReadFile(input_));
}

TEST_F(MapFileTest, ReadsOnceToWrite) {
  PoseGraph graph = Read(input_).pose_graph;
  graph.nodes.at(NodeId{kTrajectory, 1}).T_map_node = Rigid2(1., 2., 3.);
  OpenCounter counter(input_);
  int num_grids = 0;
  const MapVisitor count_grids = {
      [&num_grids](const SubmapId&, const SubmapSummary&,
                   const OccupancyGrid&) { ++num_grids; },
      {}};
  ASSERT_TRUE(PrepareMap(input_, output_, graph, count_grids).ok());
  EXPECT_EQ(counter.Count(), 1);
  EXPECT_EQ(num_grids, 2);
  // Their gravity alignments must be found out first.
  graph.nodes.erase(NodeId{kTrajectory, 2});
  num_grids = 0;
  ASSERT_TRUE(PrepareMap(input_, output_, graph, count_grids).ok());
  EXPECT_EQ(counter.Count(), 3);
  EXPECT_EQ(num_grids, 2);
}

// Those of the file hold.
TEST_F(MapFileTest, ChangedGravityAlignmentsAreNotWritten) {
  PoseGraph graph = Read(input_).pose_graph;
  for (auto& [id, node] : graph.nodes) {
    node.T_map_node = Rigid2(1., 2., 3.) * node.T_map_node;
  }
  ASSERT_TRUE(WriteMap(input_, output_, graph).ok());
  const std::string expected = ReadFile(output_);
  for (auto& [id, node] : graph.nodes) {
    node.gravity_alignment = SmallMap::Gravity(1);
  }
  ASSERT_TRUE(WriteMap(input_, output_, graph).ok());
  EXPECT_TRUE(ReadFile(output_) == expected);
}

TEST_F(MapFileTest, APreparedMapAppearsWhenItIsCommitted) {
  const PoseGraph graph = Read(input_).pose_graph;
  for (const bool is_committed : {false, true}) {
    {
      absl::StatusOr<RecordWriter> map = PrepareMap(input_, output_, graph);
      ASSERT_TRUE(map.ok()) << map.status();
      EXPECT_FALSE(std::filesystem::exists(output_));
      ASSERT_TRUE(!is_committed || map->Commit().ok());
    }
    const std::filesystem::directory_iterator files(directory_.path());
    EXPECT_EQ(std::distance(begin(files), end(files)), is_committed ? 2 : 1);
    EXPECT_EQ(std::filesystem::exists(output_), is_committed);
  }
}

TEST_F(MapFileTest, WritesPosesAsTheHostDoes) {
  PoseGraph graph = Read(input_).pose_graph;
  const NodeId node{kTrajectory, 2};
  const Rigid2 T_map_node(-7., 8., 2.);
  const Rigid2 T_map_submap(-1., -2., -3.);
  graph.nodes.at(node).T_map_node = T_map_node;
  graph.submap_poses.at(SubmapId{kTrajectory, 1}) = T_map_submap;
  graph.landmark_poses.at("tag").translation.x() = 9.;
  ASSERT_TRUE(WriteMap(input_, output_, graph).ok());

  const proto::PoseGraph before = SmallMap().pose_graph;
  const proto::PoseGraph after = WrittenPoseGraph();
  const proto::Trajectory& trajectory = after.trajectory(0);
  for (const int i : {0, 1, 3}) {
    EXPECT_EQ(trajectory.node(i).SerializeAsString(),
              before.trajectory(0).node(i).SerializeAsString());
  }
  EXPECT_EQ(trajectory.node(2).timestamp(), SmallMap::NodeTime(2));
  const Rigid3 written = *FromProto(trajectory.node(2).pose());
  EXPECT_LE((written.translation - Eigen::Vector3d(-7., 8., 0.)).norm(),
            kTolerance);
  EXPECT_LE(written.rotation.angularDistance(
                Eigen::AngleAxisd(2., Eigen::Vector3d::UnitZ()) *
                SmallMap::Gravity(2)),
            1e-7);
  EXPECT_EQ(trajectory.submap(0).SerializeAsString(),
            before.trajectory(0).submap(0).SerializeAsString());
  EXPECT_EQ(after.landmark_poses(0).global_pose().translation().x(), 9.);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(after.constraint(i).SerializeAsString(),
              before.constraint(i).SerializeAsString());
  }

  const PoseGraph reread = Read(output_).pose_graph;
  ExpectNear(reread.nodes.at(node).T_map_node, T_map_node);
  ExpectNear(reread.submap_poses.at(SubmapId{kTrajectory, 1}), T_map_submap);
}

TEST_F(MapFileTest, AppendsConstraints) {
  PoseGraph graph = Read(input_).pose_graph;
  Constraint closure;
  closure.submap = SubmapId{kTrajectory, 0};
  closure.node = NodeId{kTrajectory, 2};
  closure.T_submap_node = Rigid2(0.5, -0.25, 3.);
  closure.translation_weight = 1e4;
  closure.rotation_weight = 1e5;
  closure.tag = Constraint::Tag::kInterSubmap;
  graph.constraints.push_back(closure);
  // Of a submap and node that the file has a constraint of already.
  closure.node = NodeId{kTrajectory, 3};
  graph.constraints.push_back(closure);
  ASSERT_TRUE(WriteMap(input_, output_, graph).ok());

  const proto::PoseGraph before = SmallMap().pose_graph;
  const proto::PoseGraph after = WrittenPoseGraph();
  ASSERT_EQ(after.constraint_size(), 7);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(after.constraint(i).SerializeAsString(),
              before.constraint(i).SerializeAsString());
  }
  EXPECT_EQ(after.constraint(5).tag(), 1);
  EXPECT_EQ(after.constraint(5).translation_weight(), 1e4);
  const Rigid3 written = *FromProto(after.constraint(5).relative_pose());
  EXPECT_LE(written.rotation.angularDistance(
                Eigen::AngleAxisd(3., Eigen::Vector3d::UnitZ()) *
                SmallMap::Gravity(2)),
            1e-7);
  const PoseGraph reread = Read(output_).pose_graph;
  EXPECT_EQ(reread.constraints[5].submap, closure.submap);
  EXPECT_EQ(reread.constraints[5].node, (NodeId{kTrajectory, 2}));
  EXPECT_EQ(reread.constraints[6].node, closure.node);
  ExpectNear(reread.constraints[5].T_submap_node, closure.T_submap_node);
  ExpectNear(reread.constraints[6].T_submap_node, closure.T_submap_node);
}

TEST_F(MapFileTest, DropsAndChangesConstraints) {
  PoseGraph graph = Read(input_).pose_graph;
  graph.constraints.erase(graph.constraints.begin() + 1);
  graph.constraints[1].translation_weight = 7.;
  graph.constraints[2].T_submap_node = Rigid2(5., 6., 0.5);
  ASSERT_TRUE(WriteMap(input_, output_, graph).ok());

  const proto::PoseGraph before = SmallMap().pose_graph;
  const proto::PoseGraph after = WrittenPoseGraph();
  ASSERT_EQ(after.constraint_size(), 4);
  EXPECT_EQ(after.constraint(0).SerializeAsString(),
            before.constraint(0).SerializeAsString());
  EXPECT_EQ(after.constraint(1).translation_weight(), 7.);
  EXPECT_EQ(after.constraint(1).relative_pose().SerializeAsString(),
            before.constraint(2).relative_pose().SerializeAsString());
  EXPECT_EQ(after.constraint(2).relative_pose().translation().z(), 0.);
  EXPECT_EQ(after.constraint(3).SerializeAsString(),
            before.constraint(4).SerializeAsString());
  ExpectNear(Read(output_).pose_graph.constraints[2].T_submap_node,
             Rigid2(5., 6., 0.5));
}

TEST_F(MapFileTest, ReorderedConstraintsAreAChange) {
  PoseGraph graph = Read(input_).pose_graph;
  std::swap(graph.constraints[0], graph.constraints[4]);
  ASSERT_TRUE(WriteMap(input_, output_, graph).ok());
  EXPECT_EQ(WrittenPoseGraph().constraint(0).SerializeAsString(),
            SmallMap().pose_graph.constraint(4).SerializeAsString());
}

TEST_F(MapFileTest, WhatTheGraphLacksStays) {
  PoseGraph graph = Read(input_).pose_graph;
  graph.nodes.clear();
  graph.submap_poses.clear();
  graph.landmark_poses.clear();
  ASSERT_TRUE(WriteMap(input_, output_, graph).ok());
  EXPECT_THAT(ReadRecords(output_), ElementsAreArray(ReadRecords(input_)));
}

TEST_F(MapFileTest, WritesInPlace) {
  PoseGraph graph = Read(input_).pose_graph;
  const Rigid2 T_map_node(-7., 8., 2.);
  graph.nodes.at(NodeId{kTrajectory, 1}).T_map_node = T_map_node;
  const size_t num_records = ReadRecords(input_).size();
  ASSERT_TRUE(WriteMap(input_, input_, graph).ok());
  EXPECT_EQ(ReadRecords(input_).size(), num_records);
  ExpectNear(
      Read(input_).pose_graph.nodes.at(NodeId{kTrajectory, 1}).T_map_node,
      T_map_node);
  int num_files = 0;
  for ([[maybe_unused]] const auto& entry :
       std::filesystem::directory_iterator(directory_.path())) {
    ++num_files;
  }
  EXPECT_EQ(num_files, 1);
}

TEST_F(MapFileTest, SameGraphGivesSameBytes) {
  PoseGraph graph = Read(input_).pose_graph;
  graph.nodes.at(NodeId{kTrajectory, 1}).T_map_node = Rigid2(1., 2., 3.);
  ASSERT_TRUE(WriteMap(input_, output_, graph).ok());
  const std::string once = ReadFile(output_);
  ASSERT_TRUE(WriteMap(input_, output_, graph).ok());
  EXPECT_EQ(ReadFile(output_), once);
}

TEST_F(MapFileTest, RefusesGraphsOfAnotherMap) {
  const PoseGraph graph = Read(input_).pose_graph;
  PoseGraph other = graph;
  other.nodes[NodeId{0, 7}];
  EXPECT_EQ(WriteError(other), "cannot write " + output_ + ": " + input_ +
                                   " does not have node 0,7");
  other = graph;
  other.submap_poses[SubmapId{kTrajectory, 2}];
  EXPECT_THAT(WriteError(other), HasSubstr("does not have submap 5,2"));
  other = graph;
  other.landmark_poses["other"];
  EXPECT_THAT(WriteError(other), HasSubstr("does not have landmark other"));
  other = graph;
  other.constraints.push_back(graph.constraints[0]);
  other.constraints.back().node.index = 9;
  EXPECT_THAT(WriteError(other), HasSubstr("node 5,9"));
}

TEST_F(MapFileTest, RefusesToWriteWhatIsNotFinite) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const PoseGraph graph = Read(input_).pose_graph;
  PoseGraph other = graph;
  other.nodes.at(NodeId{kTrajectory, 1}).T_map_node = Rigid2(kNaN, 0., 0.);
  EXPECT_THAT(WriteError(other), HasSubstr("not finite of node 5,1"));
  other = graph;
  other.submap_poses.at(SubmapId{kTrajectory, 0}) = Rigid2(0., 0., kNaN);
  EXPECT_THAT(WriteError(other), HasSubstr("not finite of submap 5,0"));
  other = graph;
  other.constraints[0].rotation_weight = kNaN;
  EXPECT_THAT(WriteError(other), HasSubstr("not finite in the constraint"));
  other = graph;
  other.landmark_poses.at("tag").translation.x() = kNaN;
  EXPECT_THAT(WriteError(other), HasSubstr("not finite of landmark tag"));
}

TEST_F(MapFileTest, SaysWhyItCannotWrite) {
  const PoseGraph graph = Read(input_).pose_graph;
  EXPECT_THAT(
      std::string(WriteMap(input_, directory_.File("no/a"), graph).message()),
      HasSubstr("cannot write " + directory_.File("no/a")));
  EXPECT_THAT(
      std::string(WriteMap(directory_.File("no"), output_, graph).message()),
      HasSubstr("cannot open " + directory_.File("no")));
}

}  // namespace
}  // namespace cartographer_sdf::map_file_test
