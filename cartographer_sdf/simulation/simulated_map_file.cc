// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A .pbstream that Cartographer loads: header, pose graph, options, submaps,
// nodes, odometry, in this order. Its readers require the first three.

#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/geometry/rigid3.h"
#include "cartographer_sdf/pbstream/grid_conversion.h"
#include "cartographer_sdf/pbstream/map_reader.h"
#include "cartographer_sdf/pbstream/point_cloud_codec.h"
#include "cartographer_sdf/pbstream/pose_codec.h"
#include "cartographer_sdf/pbstream/record_stream.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/serialized_state.pb.h"
#include "cartographer_sdf/simulation/simulated_map.h"
#include "cartographer_sdf/simulation/truth.h"

namespace cartographer_sdf {
namespace {

constexpr int kTrajectory = 0;
constexpr int kFormatVersion = 2;

// From the host's SensorId: RANGE and ODOMETRY.
constexpr int kRangeSensor = 0;
constexpr int kOdometrySensor = 2;

void SetId(const int index, proto::Id* const id) {
  id->set_trajectory_id(kTrajectory);
  id->set_index(index);
}

// Without loop closing, the map frame is the local frame.
proto::SerializedData PoseGraphRecord(const SimulatedMap& map) {
  proto::SerializedData record;
  proto::PoseGraph* const pose_graph = record.mutable_pose_graph();
  for (size_t k = 0; k != map.submaps.size(); ++k) {
    const SimulatedSubmap& submap = map.submaps[k];
    for (int n = submap.first_node; n != submap.end_node; ++n) {
      proto::Constraint* const constraint = pose_graph->add_constraint();
      SetId(static_cast<int>(k), constraint->mutable_submap_id());
      SetId(n, constraint->mutable_node_id());
      *constraint->mutable_relative_pose() = ToProto(
          Embed3D(submap.T_local_submap.Inverse() * map.nodes[n].T_local_node));
      constraint->set_translation_weight(kIntraTranslationWeight);
      constraint->set_rotation_weight(kIntraRotationWeight);
    }
  }
  proto::Trajectory* const trajectory = pose_graph->add_trajectory();
  trajectory->set_trajectory_id(kTrajectory);
  for (size_t k = 0; k != map.nodes.size(); ++k) {
    proto::TrajectoryNode* const node = trajectory->add_node();
    node->set_node_index(static_cast<int>(k));
    node->set_timestamp(map.nodes[k].time);
    *node->mutable_pose() = ToProto(Embed3D(map.nodes[k].T_local_node));
  }
  for (size_t k = 0; k != map.submaps.size(); ++k) {
    proto::TrajectorySubmap* const submap = trajectory->add_submap();
    submap->set_submap_index(static_cast<int>(k));
    *submap->mutable_pose() = ToProto(Embed3D(map.submaps[k].T_local_submap));
  }
  return record;
}

proto::SerializedData OptionsRecord() {
  proto::SerializedData record;
  proto::TrajectoryBuilderOptionsWithSensorIds* const options =
      record.mutable_all_trajectory_builder_options()
          ->add_options_with_sensor_ids();
  for (const auto& [type, id] : {std::make_pair(kOdometrySensor, "odom"),
                                 std::make_pair(kRangeSensor, "scan")}) {
    proto::SensorId* const sensor = options->add_sensor_id();
    sensor->set_type(type);
    sensor->set_id(id);
  }
  options->mutable_trajectory_builder_options();
  return record;
}

proto::SerializedData SubmapRecord(const SimulatedSubmap& submap,
                                   const int index) {
  proto::SerializedData record;
  SetId(index, record.mutable_submap()->mutable_submap_id());
  proto::Submap2D* const stored = record.mutable_submap()->mutable_submap_2d();
  *stored->mutable_local_pose() = ToProto(Embed3D(submap.T_local_submap));
  stored->set_num_range_data(submap.end_node - submap.first_node);
  stored->set_finished(true);
  *stored->mutable_grid() = MakeGrid2D(submap.grid, submap.T_local_submap);
  return record;
}

proto::SerializedData NodeRecord(const SimulatedNode& node, const int index) {
  proto::SerializedData record;
  SetId(index, record.mutable_node()->mutable_node_id());
  proto::NodeData* const data = record.mutable_node()->mutable_node_data();
  data->set_timestamp(node.time);
  *data->mutable_gravity_alignment() = ToProto(Eigen::Quaterniond::Identity());
  *data->mutable_filtered_gravity_aligned_point_cloud() =
      CompressPointCloud(node.points);
  *data->mutable_local_pose() = ToProto(Embed3D(node.T_local_node));
  return record;
}

proto::SerializedData OdometryRecord(const SimulatedOdometry& odometry) {
  proto::SerializedData record;
  record.mutable_odometry_data()->set_trajectory_id(kTrajectory);
  proto::TimedPose* const timed_pose =
      record.mutable_odometry_data()->mutable_odometry_data();
  timed_pose->set_timestamp(odometry.time);
  *timed_pose->mutable_pose() = ToProto(Embed3D(odometry.T_odometry_node));
  return record;
}

absl::Status WriteRecords(const SimulatedMap& map, RecordWriter* const writer) {
  proto::SerializationHeader header;
  header.set_format_version(kFormatVersion);
  absl::Status status = writer->Write(header.SerializeAsString());
  const auto write = [&](const proto::SerializedData& record) {
    if (status.ok()) status = writer->Write(record.SerializeAsString());
  };
  write(PoseGraphRecord(map));
  write(OptionsRecord());
  for (size_t k = 0; k != map.submaps.size(); ++k) {
    write(SubmapRecord(map.submaps[k], static_cast<int>(k)));
  }
  for (size_t k = 0; k != map.nodes.size(); ++k) {
    write(NodeRecord(map.nodes[k], static_cast<int>(k)));
  }
  for (const SimulatedOdometry& odometry : map.odometry) {
    write(OdometryRecord(odometry));
  }
  return status;
}

Truth TruthOf(const SimulatedMap& map) {
  Truth truth;
  for (size_t k = 0; k != map.submaps.size(); ++k) {
    truth.T_world_submap[{kTrajectory, static_cast<int>(k)}] =
        map.submaps[k].T_world_submap;
  }
  for (size_t k = 0; k != map.nodes.size(); ++k) {
    truth.T_world_tracking[{kTrajectory, static_cast<int>(k)}] =
        map.nodes[k].T_world_node;
  }
  return truth;
}

}  // namespace

absl::Status WriteSimulatedMap(const SimulatedMap& map,
                               const std::string& map_path,
                               const std::string& truth_path) {
  if (map_path == truth_path) {
    return absl::InvalidArgumentError(absl::StrCat(
        "the map and its truth cannot both be written to ", map_path));
  }
  absl::StatusOr<RecordWriter> writer = RecordWriter::Open(map_path);
  if (!writer.ok()) return writer.status();
  absl::Status status = WriteRecords(map, &*writer);
  if (status.ok()) status = CheckLoads(*writer);
  if (status.ok()) status = WriteTruth(truth_path, TruthOf(map));
  if (status.ok()) status = writer->Commit();
  return status;
}

}  // namespace cartographer_sdf
