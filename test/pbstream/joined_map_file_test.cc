// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/joined_map_file.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "cartographer_sdf/pbstream/pose_codec.h"
#include "cartographer_sdf/pbstream/trajectory_record.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/open_counter.h"
#include "test/testing/small_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::joined_map_file_test {
namespace {

using ::cartographer_sdf::testing::Container;
using ::cartographer_sdf::testing::IsPoseNear;
using ::cartographer_sdf::testing::ReadFile;
using ::cartographer_sdf::testing::ReadRecords;
using ::cartographer_sdf::testing::SmallMap;
using ::cartographer_sdf::testing::TemporaryDirectory;
using ::cartographer_sdf::testing::WriteFile;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

constexpr double kTolerance = 1e-9;

proto::SerializedData Parse(const std::string& record) {
  proto::SerializedData data;
  CHECK(data.ParseFromString(record));
  return data;
}

// The records of a small map, all of its trajectory.
std::vector<std::string> RecordsOf(const SmallMap& map) {
  std::vector<std::string> records = map.Records();
  for (size_t k = 3; k < records.size(); ++k) {
    const proto::SerializedData data = Parse(records[k]);
    if (TrajectoryOfRecord(data)) {
      records[k] = WithTrajectory(records[k], data, SmallMap::kTrajectory);
    }
  }
  return records;
}

// What a record is without the number of its trajectory.
std::string Anonymous(const std::string& record) {
  const proto::SerializedData data = Parse(record);
  return TrajectoryOfRecord(data) ? WithTrajectory(record, data, 0) : record;
}

class JoinedMapFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    // The second map is another one: it begins at the end of the first.
    second_.options.mutable_options_with_sensor_ids(0)
        ->mutable_trajectory_builder_options()
        ->mutable_initial_trajectory_pose()
        ->set_to_trajectory_id(SmallMap::kTrajectory);
    *second_.pose_graph.mutable_landmark_poses(0)->mutable_global_pose() =
        ToProto(Embed3D(Rigid2(7., 8., 0.)));
    proto::LandmarkPose& landmark = *second_.pose_graph.add_landmark_poses();
    landmark.set_landmark_id("other tag");
    *landmark.mutable_global_pose() = ToProto(Embed3D(Rigid2(4., 4., 0.)));
    WriteFile(paths_[0], Container(RecordsOf(first_)));
    WriteFile(paths_[1], Container(RecordsOf(second_)));
  }

  // Numbers and joins the maps as read.
  MapState Join() {
    std::vector<MapState> maps;
    for (const std::string& path : paths_) {
      absl::StatusOr<MapState> map = ReadMap(path);
      CHECK(map.ok()) << map.status();
      maps.push_back(*std::move(map));
    }
    parts_ = NumberTrajectories(paths_, {&maps[0], &maps[1]});
    MapState joined;
    AppendMap(parts_[0], maps[0], &joined);
    AppendMap(parts_[1], maps[1], &joined);
    return joined;
  }

  TemporaryDirectory directory_;
  const std::vector<std::string> paths_ = {directory_.File("first.pbstream"),
                                           directory_.File("second.pbstream")};
  const std::string output_ = directory_.File("joined.pbstream");
  SmallMap first_, second_;
  std::vector<MapPart> parts_;
};

TEST_F(JoinedMapFileTest, NumbersTrajectoriesInOrder) {
  const MapState joined = Join();
  ASSERT_EQ(parts_.size(), 2u);
  EXPECT_THAT(parts_[0].trajectories, ElementsAre(Pair(5, 0)));
  EXPECT_THAT(parts_[1].trajectories, ElementsAre(Pair(5, 1)));
  EXPECT_THAT(joined.trajectories, ElementsAre(0, 1));
  EXPECT_EQ(joined.pose_graph.nodes.size(), 8u);
  EXPECT_EQ(joined.submaps.size(), 4u);
  EXPECT_EQ(joined.pose_graph.constraints.size(), 10u);
}

TEST_F(JoinedMapFileTest, KeepsEveryByteButTheNumbers) {
  const MapState joined = Join();
  ASSERT_TRUE(WriteJoinedMap(parts_, joined.pose_graph, output_).ok());
  const std::vector<std::string> first = ReadRecords(paths_[0]);
  const std::vector<std::string> second = ReadRecords(paths_[1]);
  const std::vector<std::string> records = ReadRecords(output_);
  // Header, pose graph and options are common.
  ASSERT_EQ(records.size(), first.size() + second.size() - 3);
  EXPECT_EQ(records[0], first[0]);
  // In the host's order: by kinds, of each kind first the first map's.
  std::vector<std::string> expected;
  for (int kind = proto::SerializedData::kSubmap;
       kind <= proto::SerializedData::kLandmarkData; ++kind) {
    for (const std::vector<std::string>* const map : {&first, &second}) {
      for (size_t k = 3; k < map->size(); ++k) {
        if (Parse((*map)[k]).data_case() == kind) expected.push_back((*map)[k]);
      }
    }
  }
  expected.push_back(first.back());
  expected.push_back(second.back());
  ASSERT_EQ(records.size(), expected.size() + 3);
  std::map<int, int> num_of_trajectory;
  for (size_t k = 0; k < expected.size(); ++k) {
    const std::string& record = records[k + 3];
    EXPECT_EQ(Anonymous(record), Anonymous(expected[k])) << k;
    const std::optional<int> trajectory = TrajectoryOfRecord(Parse(record));
    if (trajectory) ++num_of_trajectory[*trajectory];
  }
  EXPECT_THAT(num_of_trajectory, ElementsAre(Pair(0, 17), Pair(1, 17)));
}

TEST_F(JoinedMapFileTest, JoinsGraphsAndOptions) {
  MapState joined = Join();
  // As if it had been optimised: the second map is elsewhere, and tied to the
  // first.
  const Rigid2 T_joined_second(10., -3., 1.);
  for (auto& [id, pose] : joined.pose_graph.submap_poses) {
    if (id.trajectory == 1) pose = T_joined_second * pose;
  }
  for (auto& [id, node] : joined.pose_graph.nodes) {
    if (id.trajectory == 1) node.T_map_node = T_joined_second * node.T_map_node;
  }
  const Constraint closure{{0, 1}, {1, 2}, Rigid2(1., 2., 0.5),
                           3.,     4.,     Constraint::Tag::kInterSubmap};
  joined.pose_graph.constraints.push_back(closure);
  ASSERT_TRUE(WriteJoinedMap(parts_, joined.pose_graph, output_).ok());

  const absl::StatusOr<MapState> read = ReadMap(output_);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_THAT(read->trajectories, ElementsAre(0, 1));
  for (const auto& [id, pose] : joined.pose_graph.submap_poses) {
    EXPECT_THAT(read->pose_graph.submap_poses.at(id),
                IsPoseNear(pose, kTolerance, kTolerance));
  }
  for (const auto& [id, node] : joined.pose_graph.nodes) {
    const Node& actual = read->pose_graph.nodes.at(id);
    EXPECT_THAT(actual.T_map_node,
                IsPoseNear(node.T_map_node, kTolerance, kTolerance));
    EXPECT_EQ(actual.time, node.time);
    EXPECT_EQ(actual.T_previous_node_by_odometry.has_value(),
              node.T_previous_node_by_odometry.has_value());
  }
  ASSERT_EQ(read->pose_graph.constraints.size(), 11u);
  EXPECT_EQ(read->pose_graph.constraints.back().node, closure.node);
  EXPECT_EQ(read->pose_graph.constraints[5].submap, (SubmapId{1, 0}));

  const std::vector<std::string> records = ReadRecords(output_);
  const proto::PoseGraph graph = Parse(records[1]).pose_graph();
  // What did not move keeps its pose in space.
  EXPECT_EQ(graph.trajectory(0).SerializeAsString(), [this] {
    proto::Trajectory trajectory = first_.pose_graph.trajectory(0);
    trajectory.set_trajectory_id(0);
    return trajectory.SerializeAsString();
  }());
  // Equal names are one landmark.
  ASSERT_EQ(graph.landmark_poses_size(), 2);
  EXPECT_EQ(graph.landmark_poses(0).SerializeAsString(),
            first_.pose_graph.landmark_poses(0).SerializeAsString());
  EXPECT_EQ(graph.landmark_poses(1).landmark_id(), "other tag");
  const proto::AllTrajectoryBuilderOptions options =
      Parse(records[2]).all_trajectory_builder_options();
  ASSERT_EQ(options.options_with_sensor_ids_size(), 2);
  EXPECT_EQ(options.options_with_sensor_ids(0).SerializeAsString(),
            first_.options.options_with_sensor_ids(0).SerializeAsString());
  EXPECT_EQ(options.options_with_sensor_ids(1)
                .trajectory_builder_options()
                .initial_trajectory_pose()
                .to_trajectory_id(),
            1);
}

TEST_F(JoinedMapFileTest, MovesTheOriginOfGps) {
  std::vector<std::string> records = RecordsOf(second_);
  proto::SerializedData data;
  data.mutable_trajectory_data()->set_trajectory_id(SmallMap::kTrajectory);
  *data.mutable_trajectory_data()->mutable_fixed_frame_origin_in_map() =
      ToProto(Embed3D(Rigid2(100., 50., 0.)));
  for (std::string& record : records) {
    if (Parse(record).has_trajectory_data()) record = data.SerializeAsString();
  }
  WriteFile(paths_[1], Container(records));
  MapState joined = Join();
  const Rigid2 T_joined_second(10., -3., 1.);
  for (auto& [id, node] : joined.pose_graph.nodes) {
    if (id.trajectory == 1) node.T_map_node = T_joined_second * node.T_map_node;
  }
  ASSERT_TRUE(WriteJoinedMap(parts_, joined.pose_graph, output_).ok());
  int num_found = 0;
  for (const std::string& record : ReadRecords(output_)) {
    const proto::SerializedData written = Parse(record);
    if (!written.trajectory_data().has_fixed_frame_origin_in_map()) continue;
    ++num_found;
    EXPECT_EQ(written.trajectory_data().trajectory_id(), 1);
    const absl::StatusOr<Rigid3> origin =
        FromProto(written.trajectory_data().fixed_frame_origin_in_map());
    ASSERT_TRUE(origin.ok());
    EXPECT_THAT(Project2D(*origin),
                IsPoseNear(T_joined_second * Rigid2(100., 50., 0.), kTolerance,
                           kTolerance));
  }
  EXPECT_EQ(num_found, 1);
}

TEST_F(JoinedMapFileTest, ReadsEachPartOnce) {
  MapState joined = Join();
  for (auto& [id, node] : joined.pose_graph.nodes) {
    if (id.trajectory == 1) node.T_map_node = Rigid2(1., 2., 3.);
  }
  testing::OpenCounter first(paths_[0]), second(paths_[1]);
  std::vector<double> fractions;
  ASSERT_TRUE(WriteJoinedMap(parts_, joined.pose_graph, output_,
                             [&fractions](const double fraction) {
                               fractions.push_back(fraction);
                             })
                  .ok());
  EXPECT_EQ(first.Count(), 1);
  EXPECT_EQ(second.Count(), 1);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.);
  // But where nodes are not in the graph, what there is of them stays, for
  // which their gravity alignments must be found out first.
  const std::string expected = ReadFile(output_);
  const NodeId unchanged{0, 1};
  joined.pose_graph.nodes.erase(unchanged);
  ASSERT_TRUE(WriteJoinedMap(parts_, joined.pose_graph, output_).ok());
  EXPECT_EQ(first.Count(), 3);
  EXPECT_EQ(second.Count(), 3);
  EXPECT_TRUE(ReadFile(output_) == expected);
}

TEST_F(JoinedMapFileTest, LeavesOutWhatHasNoRecord) {
  second_.nodes.resize(2);
  WriteFile(paths_[1], Container(RecordsOf(second_)));
  const absl::StatusOr<MapState> first = ReadMap(paths_[0]);
  const absl::StatusOr<MapState> second =
      ReadMap({paths_[1], MissingRecords::kDrop});
  ASSERT_TRUE(first.ok() && second.ok());
  parts_ = NumberTrajectories(paths_, {&*first, &*second});
  MapState joined;
  AppendMap(parts_[0], *first, &joined);
  AppendMap(parts_[1], *second, &joined);
  EXPECT_EQ(joined.num_unrecorded_nodes, 2);
  ASSERT_TRUE(WriteJoinedMap(parts_, joined.pose_graph, output_).ok());
  const absl::StatusOr<MapState> read = ReadMap(output_);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->pose_graph.nodes.size(), 6u);
  EXPECT_EQ(read->pose_graph.constraints.size(), 8u);
}

TEST_F(JoinedMapFileTest, LeavesOutOdometryOfMapsThatWereReadWithoutIt) {
  const absl::StatusOr<MapState> first =
      ReadMap({paths_[0], MissingRecords::kRefuse, OdometryRecords::kDrop});
  const absl::StatusOr<MapState> second = ReadMap(paths_[1]);
  ASSERT_TRUE(first.ok() && second.ok());
  parts_ = NumberTrajectories(paths_, {&*first, &*second});
  MapState joined;
  AppendMap(parts_[0], *first, &joined);
  AppendMap(parts_[1], *second, &joined);
  ASSERT_TRUE(WriteJoinedMap(parts_, joined.pose_graph, output_).ok());
  const absl::StatusOr<MapState> read = ReadMap(output_);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->num_records.at("odometry_data"),
            second->num_records.at("odometry_data"));
  for (const auto& [id, node] : read->pose_graph.nodes) {
    if (id.trajectory != 0) continue;
    EXPECT_FALSE(node.T_previous_node_by_odometry.has_value());
  }
}

TEST_F(JoinedMapFileTest, LeavesNothingBehindWhereItFails) {
  const MapState joined = Join();
  const auto expect_error = [this](const PoseGraph& graph,
                                   const std::string& message) {
    const absl::Status status = WriteJoinedMap(parts_, graph, output_);
    EXPECT_THAT(std::string(status.message()), HasSubstr(message));
    EXPECT_FALSE(std::filesystem::exists(output_));
  };
  PoseGraph graph = joined.pose_graph;
  graph.submap_poses[{2, 0}] = Rigid2();
  expect_error(graph, "does not have submap 2,0");

  // Sensor data of a trajectory that is not there, which the host would not
  // load.
  std::vector<std::string> records = RecordsOf(second_);
  for (std::string& record : records) {
    const proto::SerializedData data = Parse(record);
    if (data.has_imu_data()) record = WithTrajectory(record, data, 3);
  }
  WriteFile(paths_[1], Container(records));
  expect_error(joined.pose_graph, "is of trajectory 3, which is not in");

  WriteFile(paths_[1], Container(RecordsOf(second_)));
  const std::string bytes = ReadFile(paths_[0]);
  WriteFile(paths_[0], bytes.substr(0, bytes.size() - 5));
  expect_error(joined.pose_graph, "truncated");
  WriteFile(paths_[0], bytes);

  // What ReadMap() does not take: a node twice.
  records = RecordsOf(second_);
  const auto node = std::find_if(
      records.begin(), records.end(),
      [](const std::string& record) { return Parse(record).has_node(); });
  records.push_back(*node);
  WriteFile(paths_[1], Container(records));
  expect_error(joined.pose_graph, "is the second of this node");
  EXPECT_THAT(
      std::string(
          WriteJoinedMap(parts_, joined.pose_graph, paths_[1]).message()),
      HasSubstr("is one of the maps that are read"));
}

}  // namespace
}  // namespace cartographer_sdf::joined_map_file_test
