// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A small, valid map in the host's format, made with the protocol buffers and
// a container writer of its own, so that tests know what is in it.

#ifndef TEST_TESTING_SMALL_MAP_H_
#define TEST_TESTING_SMALL_MAP_H_

#include <google/protobuf/io/gzip_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid3.h"
#include "cartographer_sdf/pbstream/pose_codec.h"
#include "cartographer_sdf/pbstream/record_stream.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/serialized_state.pb.h"
#include "glog/logging.h"

namespace cartographer_sdf::testing {

inline std::string LittleEndian(uint64_t word) {
  std::string bytes;
  for (int i = 0; i < 8; ++i, word >>= 8) {
    bytes.push_back(static_cast<char>(word & 0xff));
  }
  return bytes;
}

inline std::string MagicNumber() { return LittleEndian(0x7b1d1f7b5bf501db); }

inline std::string Gzipped(const std::string& bytes) {
  std::string compressed;
  google::protobuf::io::StringOutputStream sink(&compressed);
  google::protobuf::io::GzipOutputStream stream(&sink);
  void* buffer;
  int size;
  size_t done = 0;
  while (done < bytes.size()) {
    CHECK(stream.Next(&buffer, &size));
    const size_t count =
        std::min(bytes.size() - done, static_cast<size_t>(size));
    std::copy_n(bytes.data() + done, count, static_cast<char*>(buffer));
    stream.BackUp(size - static_cast<int>(count));
    done += count;
  }
  CHECK(stream.Close());
  return compressed;
}

inline void WriteFile(const std::string& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  CHECK(file.write(bytes.data(), static_cast<std::streamsize>(bytes.size())));
}

inline std::string ReadFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

// The bytes of a file with these records.
inline std::string Container(const std::vector<std::string>& records) {
  std::string bytes = MagicNumber();
  for (const std::string& record : records) {
    const std::string compressed = Gzipped(record);
    bytes += LittleEndian(compressed.size()) + compressed;
  }
  return bytes;
}

inline std::vector<std::string> ReadRecords(const std::string& path) {
  absl::StatusOr<RecordReader> reader = RecordReader::Open(path);
  CHECK(reader.ok()) << reader.status();
  std::vector<std::string> records;
  while (true) {
    std::string record;
    const absl::StatusOr<bool> has_record = reader->Read(&record);
    CHECK(has_record.ok()) << has_record.status();
    if (!*has_record) return records;
    records.push_back(record);
  }
}

// Appends an unknown field to a serialized message.
inline std::string WithUnknownField(const std::string& message) {
  // Field 1000, three bytes.
  return message + std::string("\xc2\x3e\x03xyz", 6);
}

// One trajectory with two submaps and four nodes. Change it before Records().
struct SmallMap {
  // As ReadMap() must find them.
  static Rigid2 NodePose(const int index) {
    return Rigid2(1. + index, -0.5 * index, 0.3 * index - 3.);
  }
  static Rigid2 LocalNodePose(const int index) {
    return Rigid2(0.9 * index, 0.1 * index, -0.2 * index);
  }
  static Rigid2 SubmapPose(const int index) {
    return Rigid2(2. * index, 1., 0.7 * index);
  }
  static Rigid2 LocalSubmapPose(const int index) {
    return Rigid2(1.5 * index, 0.25, 0.);
  }
  static Rigid2 ConstraintPose(const int submap, const int node) {
    return Rigid2(0.1 * node - submap, 0.2, 3. - 0.2 * node);
  }
  // Yaw and tilt, as with an IMU.
  static Eigen::Quaterniond Gravity(const int index) {
    return Eigen::AngleAxisd(0.02 * index, Eigen::Vector3d::UnitX()) *
           Eigen::AngleAxisd(0.8 + index, Eigen::Vector3d::UnitZ());
  }
  // [100 ns]
  static int64_t NodeTime(const int index) {
    return 621355968000000000 + int64_t{10'000'000} * index;
  }
  // A drive along a circle of 10 m radius, 1 m a second.
  static Rigid3 Odometry(const double seconds) {
    return Embed3D(Rigid2(10. * std::sin(seconds / 10.),
                          10. - 10. * std::cos(seconds / 10.), seconds / 10.));
  }
  static constexpr int kNumSubmaps = 2;
  static constexpr int kNumNodes = 4;
  static constexpr int kTrajectory = 5;

  proto::SerializationHeader header;
  proto::PoseGraph pose_graph;
  proto::AllTrajectoryBuilderOptions options;
  std::vector<proto::Submap> submaps;
  std::vector<proto::Node> nodes;
  std::vector<proto::OdometryData> odometry;

  SmallMap() {
    header.set_format_version(2);
    options.add_options_with_sensor_ids()->add_sensor_id()->set_id("scan");
    pose_graph.add_trajectory()->set_trajectory_id(kTrajectory);
    for (int i = 0; i < kNumSubmaps; ++i) AddSubmap(i);
    for (int i = 0; i < kNumNodes; ++i) AddNode(i);
    AddConstraint(0, 0, 0);
    AddConstraint(0, 1, 0);
    AddConstraint(1, 2, 0);
    AddConstraint(0, 3, 1);
    AddConstraint(1, 0, 1);
    proto::LandmarkPose& landmark = *pose_graph.add_landmark_poses();
    landmark.set_landmark_id("tag");
    *landmark.mutable_global_pose() =
        ToProto(Rigid3{Eigen::Vector3d(1., 2., 3.),
                       Eigen::Quaterniond(Eigen::AngleAxisd(
                           0.4, Eigen::Vector3d(1., 2., 2.) / 3.))});
    // From half a second after the first node until after the last one.
    for (double seconds = 0.5; seconds <= 3.5; seconds += 0.5) {
      AddOdometry(seconds);
    }
  }

  // In the host's order; every one and the pose graph's inside has an unknown
  // field, the last is of an unknown kind.
  std::vector<std::string> Records() const {
    std::vector<std::string> records = {header.SerializeAsString()};
    const auto add = [&records](const proto::SerializedData& data) {
      records.push_back(WithUnknownField(data.SerializeAsString()));
    };
    proto::SerializedData data;
    CHECK(data.mutable_pose_graph()->ParseFromString(
        WithUnknownField(pose_graph.SerializeAsString())));
    add(data);
    *data.mutable_all_trajectory_builder_options() = options;
    add(data);
    for (const proto::Submap& submap : submaps) {
      *data.mutable_submap() = submap;
      add(data);
    }
    for (const proto::Node& node : nodes) {
      *data.mutable_node() = node;
      add(data);
    }
    data.mutable_trajectory_data()->set_trajectory_id(kTrajectory);
    add(data);
    for (const int64_t time : {NodeTime(0), NodeTime(1)}) {
      proto::SensorData& imu = *data.mutable_imu_data();
      imu.set_trajectory_id(kTrajectory);
      CHECK(imu.mutable_data()->ParseFromString(WithUnknownField("")));
      imu.mutable_data()->set_timestamp(time);
      add(data);
    }
    for (const proto::OdometryData& measurement : odometry) {
      *data.mutable_odometry_data() = measurement;
      add(data);
    }
    data.mutable_landmark_data()->set_trajectory_id(kTrajectory);
    add(data);
    records.push_back(WithUnknownField(""));
    return records;
  }

 private:
  void AddSubmap(const int index) {
    proto::TrajectorySubmap& pose =
        *pose_graph.mutable_trajectory(0)->add_submap();
    pose.set_submap_index(index);
    *pose.mutable_pose() = ToProto(Embed3D(SubmapPose(index)));
    proto::Submap& submap = submaps.emplace_back();
    submap.mutable_submap_id()->set_trajectory_id(kTrajectory);
    submap.mutable_submap_id()->set_index(index);
    proto::Submap2D& content = *submap.mutable_submap_2d();
    *content.mutable_local_pose() = ToProto(Embed3D(LocalSubmapPose(index)));
    content.set_num_range_data(10 + index);
    content.set_finished(index == 0);
    proto::Grid2D& grid = *content.mutable_grid();
    grid.mutable_limits()->set_resolution(0.5);
    grid.mutable_limits()->mutable_max()->set_x(2.);
    grid.mutable_limits()->mutable_max()->set_y(1.);
    grid.mutable_limits()->mutable_cell_limits()->set_num_x_cells(3);
    grid.mutable_limits()->mutable_cell_limits()->set_num_y_cells(2);
    for (const int value : {1, 0, 32767, 16384, 0, 8000}) grid.add_cells(value);
    grid.mutable_probability_grid_2d();
    grid.set_min_correspondence_cost(0.1f);
    grid.set_max_correspondence_cost(0.9f);
  }

  void AddNode(const int index) {
    const Rigid3 gravity = Rigid3::Rotation(Gravity(index));
    proto::TrajectoryNode& pose = *pose_graph.mutable_trajectory(0)->add_node();
    pose.set_node_index(index);
    pose.set_timestamp(NodeTime(index));
    *pose.mutable_pose() = ToProto(Embed3D(NodePose(index)) * gravity);
    proto::Node& node = nodes.emplace_back();
    node.mutable_node_id()->set_trajectory_id(kTrajectory);
    node.mutable_node_id()->set_index(index);
    proto::NodeData& data = *node.mutable_node_data();
    data.set_timestamp(NodeTime(index));
    *data.mutable_gravity_alignment() = ToProto(Gravity(index));
    *data.mutable_local_pose() =
        ToProto(Embed3D(LocalNodePose(index)) * gravity);
    // One point at (index, -0.001) m.
    proto::CompressedPointCloud& cloud =
        *data.mutable_filtered_gravity_aligned_point_cloud();
    cloud.set_num_points(1);
    const int x = 1000 * index;
    for (const int value : {1, x / 1024, -1, 0, 1023 * 1024 + x % 1024}) {
      cloud.add_point_data(value);
    }
  }

  void AddConstraint(const int submap, const int node, const int tag) {
    proto::Constraint& constraint = *pose_graph.add_constraint();
    constraint.mutable_submap_id()->set_trajectory_id(kTrajectory);
    constraint.mutable_submap_id()->set_index(submap);
    constraint.mutable_node_id()->set_trajectory_id(kTrajectory);
    constraint.mutable_node_id()->set_index(node);
    Rigid3 pose =
        Embed3D(ConstraintPose(submap, node)) * Rigid3::Rotation(Gravity(node));
    // Lost on the way to the plane, so it tells whether a pose was kept.
    pose.translation.z() = 0.125;
    *constraint.mutable_relative_pose() = ToProto(pose);
    constraint.set_tag(tag);
    constraint.set_translation_weight(500. + node);
    constraint.set_rotation_weight(1600. + submap);
  }

  void AddOdometry(const double seconds) {
    proto::OdometryData& measurement = odometry.emplace_back();
    measurement.set_trajectory_id(kTrajectory);
    measurement.mutable_odometry_data()->set_timestamp(
        NodeTime(0) + std::llround(1e7 * seconds));
    *measurement.mutable_odometry_data()->mutable_pose() =
        ToProto(Odometry(seconds));
  }
};

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_SMALL_MAP_H_
