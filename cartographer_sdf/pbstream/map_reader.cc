// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/map_reader.h"

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/pbstream/grid_conversion.h"
#include "cartographer_sdf/pbstream/point_cloud_codec.h"
#include "cartographer_sdf/pbstream/pose_codec.h"

namespace cartographer_sdf {
namespace {

using Kind = proto::SerializedData::DataCase;

constexpr char kPoseGraphName[] = "pose graph";
constexpr char kOptionsName[] = "options of trajectory builders";

}  // namespace

absl::StatusOr<MapReader> MapReader::Open(const std::string& path,
                                          MapVisitor visitor,
                                          const ProgressCallback& on_progress) {
  absl::StatusOr<StateReader> records = StateReader::Open(path, on_progress);
  if (!records.ok()) return records.status();
  MapReader reader(*std::move(records), path, std::move(visitor));
  reader.state_.format_version = reader.records_.format_version();
  return reader;
}

absl::StatusOr<bool> MapReader::Next() {
  const absl::StatusOr<bool> has_record = records_.Next();
  if (!has_record.ok()) return has_record.status();
  if (!*has_record) {
    if (num_records_ >= 2) return false;
    return absl::DataLossError(
        absl::StrCat(path_, " is truncated: it ends before its ",
                     num_records_ == 0 ? kPoseGraphName : kOptionsName));
  }
  ++state_.num_records[records_.kind()];
  ++num_records_;
  const absl::Status status = num_records_ == 1   ? ReadPoseGraph()
                              : num_records_ == 2 ? ReadOptions()
                                                  : ReadOther();
  if (!status.ok()) return status;
  return true;
}

MapState MapReader::Finish() {
  PoseGraph& graph = state_.pose_graph;
  graph = ToPoseGraph(stored_pose_graph_, attitudes_);
  SetRelativeOdometry(odometry_->poses(), &graph.nodes);
  return std::move(state_);
}

absl::Status MapReader::Expect(const Kind kind, const char* const name) const {
  if (records_.data().data_case() == kind) return absl::OkStatus();
  return records_.Corrupted(absl::StrCat("is of the kind ", records_.kind(),
                                         " where the ", name, " must be"));
}

absl::Status MapReader::ReadPoseGraph() {
  absl::Status status = Expect(Kind::kPoseGraph, kPoseGraphName);
  if (!status.ok()) return status;
  stored_pose_graph_ = records_.data().pose_graph();
  status = CheckPoseGraph(stored_pose_graph_);
  if (!status.ok()) return records_.Corrupted(status.message());
  for (const proto::Trajectory& trajectory : stored_pose_graph_.trajectory()) {
    state_.trajectories.push_back(trajectory.trajectory_id());
  }
  // Poses are preliminary: the attitudes of the nodes are not known yet.
  state_.pose_graph = ToPoseGraph(stored_pose_graph_, {});
  odometry_.emplace(state_.pose_graph.nodes);
  return absl::OkStatus();
}

absl::Status MapReader::ReadOptions() {
  const absl::Status status =
      Expect(Kind::kAllTrajectoryBuilderOptions, kOptionsName);
  if (!status.ok()) return status;
  const int num_options = records_.data()
                              .all_trajectory_builder_options()
                              .options_with_sensor_ids_size();
  const size_t num_trajectories = state_.trajectories.size();
  if (static_cast<size_t>(num_options) == num_trajectories) {
    return absl::OkStatus();
  }
  return absl::DataLossError(absl::StrCat(
      path_, " is corrupted: its pose graph has ", num_trajectories,
      " trajectories, but it has options for ", num_options, " of them"));
}

absl::Status MapReader::ReadOther() {
  switch (records_.data().data_case()) {
    case Kind::kPoseGraph:
      return records_.Corrupted("is a second pose graph");
    case Kind::kAllTrajectoryBuilderOptions:
      return records_.Corrupted("is a second list of options");
    case Kind::kSubmap:
      return ReadSubmap(records_.data().submap());
    case Kind::kNode:
      return ReadNode(records_.data().node());
    case Kind::kOdometryData:
      return ReadOdometry(records_.data().odometry_data());
    default:
      return absl::OkStatus();
  }
}

absl::Status MapReader::ReadSubmap(const proto::Submap& stored) {
  if (stored.has_submap_3d()) {
    return absl::UnimplementedError(
        absl::StrCat(path_, " is a 3D map; only 2D maps are supported"));
  }
  const SubmapId id{stored.submap_id().trajectory_id(),
                    stored.submap_id().index()};
  const std::string name =
      absl::StrCat("(submap ", id.trajectory, ",", id.index, ") ");
  if (state_.pose_graph.submap_poses.count(id) == 0) {
    return records_.Corrupted(name + "is not in the pose graph");
  }
  if (!stored.has_submap_2d()) return records_.Corrupted(name + "is empty");
  const proto::Submap2D& submap = stored.submap_2d();
  const absl::StatusOr<Rigid3> local_pose = FromProto(submap.local_pose());
  if (!local_pose.ok()) {
    return records_.Corrupted(
        absl::StrCat(name, local_pose.status().message()));
  }
  SubmapSummary summary;
  summary.finished = submap.finished();
  summary.num_range_data = submap.num_range_data();
  summary.T_local_submap = Project2D(*local_pose);
  if (!submap.has_grid()) return AddSubmap(id, summary);
  const absl::StatusOr<OccupancyGrid> grid =
      MakeOccupancyGrid(submap.grid(), summary.T_local_submap);
  if (!grid.ok()) {
    return records_.Corrupted(absl::StrCat(name, grid.status().message()));
  }
  summary.is_tsdf = submap.grid().has_tsdf_2d();
  summary.geometry = grid->geometry;
  summary.num_known_cells = static_cast<int>(grid->known.count());
  absl::Status status = AddSubmap(id, summary);
  if (status.ok() && visitor_.on_submap) {
    visitor_.on_submap(id, summary, *grid);
  }
  return status;
}

absl::Status MapReader::AddSubmap(const SubmapId& id,
                                  const SubmapSummary& summary) {
  if (state_.submaps.emplace(id, summary).second) return absl::OkStatus();
  return records_.Corrupted(
      absl::StrCat("is the second of submap ", id.trajectory, ",", id.index));
}

absl::Status MapReader::ReadNode(const proto::Node& stored) {
  const NodeId id{stored.node_id().trajectory_id(), stored.node_id().index()};
  const std::string name =
      absl::StrCat("(node ", id.trajectory, ",", id.index, ") ");
  if (state_.pose_graph.nodes.count(id) == 0) {
    return records_.Corrupted(name + "is not in the pose graph");
  }
  const absl::StatusOr<NodeAttitude> attitude =
      ReadNodeAttitude(stored.node_data());
  if (!attitude.ok()) {
    return records_.Corrupted(absl::StrCat(name, attitude.status().message()));
  }
  if (!attitudes_.emplace(id, *attitude).second) {
    return records_.Corrupted(name + "is the second of this node");
  }
  const proto::NodeData& data = stored.node_data();
  if (!visitor_.on_point_cloud ||
      !data.has_filtered_gravity_aligned_point_cloud()) {
    return absl::OkStatus();
  }
  absl::StatusOr<PointCloud2> cloud =
      DecompressPointCloud(data.filtered_gravity_aligned_point_cloud());
  if (!cloud.ok()) {
    return records_.Corrupted(absl::StrCat(name, cloud.status().message()));
  }
  visitor_.on_point_cloud(id, *std::move(cloud));
  return absl::OkStatus();
}

absl::Status MapReader::ReadOdometry(const proto::OdometryData& stored) {
  const absl::StatusOr<Rigid3> pose = FromProto(stored.odometry_data().pose());
  if (!pose.ok()) return records_.Corrupted(pose.status().message());
  const absl::Status status = odometry_->Add(
      stored.trajectory_id(), stored.odometry_data().timestamp(), *pose);
  return status.ok() ? status : records_.Corrupted(status.message());
}

}  // namespace cartographer_sdf
