// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/stored_map.h"

#include <map>
#include <set>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "cartographer_sdf/pbstream/grid_conversion.h"
#include "cartographer_sdf/pbstream/node_odometry.h"
#include "cartographer_sdf/pbstream/pose_codec.h"
#include "cartographer_sdf/pbstream/pose_graph_codec.h"
#include "cartographer_sdf/pbstream/state_reader.h"

namespace cartographer_sdf {
namespace {

using Kind = proto::SerializedData::DataCase;

// Reads one file: the pose graph, the options, then every record as it comes.
class MapReader {
 public:
  MapReader(StateReader reader, const std::string& path,
            const SubmapCallback& on_submap)
      : reader_(std::move(reader)), path_(path), on_submap_(on_submap) {}

  absl::StatusOr<StoredMap> Read() {
    map_.state.format_version = reader_.format_version();
    absl::Status status = ReadPoseGraph();
    if (status.ok()) status = ReadOptions();
    if (!status.ok()) return status;
    NodeOdometry odometry(map_.state.pose_graph.nodes);
    while (true) {
      const absl::StatusOr<bool> has_record = Next();
      if (!has_record.ok()) return has_record.status();
      if (!*has_record) break;
      status = ReadRecord(&odometry);
      if (!status.ok()) return status;
    }
    PoseGraph& graph = map_.state.pose_graph;
    graph = ToPoseGraph(map_.pose_graph_record.pose_graph(), attitudes_);
    SetRelativeOdometry(odometry.poses(), &graph.nodes);
    return std::move(map_);
  }

 private:
  absl::StatusOr<bool> Next() {
    absl::StatusOr<bool> has_record = reader_.Next();
    if (has_record.ok() && *has_record)
      ++map_.state.num_records[reader_.kind()];
    return has_record;
  }

  // The next record, which must be of this kind.
  absl::Status Expect(const Kind kind, const char* const name) {
    const absl::StatusOr<bool> has_record = Next();
    if (!has_record.ok()) return has_record.status();
    if (!*has_record) {
      return absl::DataLossError(
          absl::StrCat(path_, " is truncated: it ends before its ", name));
    }
    if (reader_.data().data_case() != kind) {
      return reader_.Corrupted(absl::StrCat("is of the kind ", reader_.kind(),
                                            " where the ", name, " must be"));
    }
    return absl::OkStatus();
  }

  absl::Status ReadPoseGraph() {
    absl::Status status = Expect(Kind::kPoseGraph, "pose graph");
    if (!status.ok()) return status;
    map_.pose_graph_record = reader_.data();
    const proto::PoseGraph& stored = map_.pose_graph_record.pose_graph();
    status = CheckPoseGraph(stored);
    if (!status.ok()) return reader_.Corrupted(status.message());
    map_.state.num_trajectories = stored.trajectory_size();
    for (const proto::Trajectory& trajectory : stored.trajectory()) {
      map_.state.trajectories.push_back(trajectory.trajectory_id());
    }
    // Poses are preliminary: the attitudes of the nodes are not known yet.
    map_.state.pose_graph = ToPoseGraph(stored, {});
    return absl::OkStatus();
  }

  absl::Status ReadOptions() {
    const absl::Status status = Expect(Kind::kAllTrajectoryBuilderOptions,
                                       "options of trajectory builders");
    if (!status.ok()) return status;
    const int num_options = reader_.data()
                                .all_trajectory_builder_options()
                                .options_with_sensor_ids_size();
    if (num_options == map_.state.num_trajectories) return absl::OkStatus();
    return absl::DataLossError(absl::StrCat(
        path_, " is corrupted: its pose graph has ",
        map_.state.num_trajectories, " trajectories, but it has options for ",
        num_options, " of them"));
  }

  absl::Status ReadRecord(NodeOdometry* const odometry) {
    switch (reader_.data().data_case()) {
      case Kind::kPoseGraph:
        return reader_.Corrupted("is a second pose graph");
      case Kind::kAllTrajectoryBuilderOptions:
        return reader_.Corrupted("is a second list of options");
      case Kind::kSubmap:
        return ReadSubmap(reader_.data().submap());
      case Kind::kNode:
        return ReadNode(reader_.data().node());
      case Kind::kOdometryData:
        return ReadOdometry(reader_.data().odometry_data(), odometry);
      default:
        return absl::OkStatus();
    }
  }

  absl::Status ReadSubmap(const proto::Submap& stored) {
    if (stored.has_submap_3d()) {
      return absl::UnimplementedError(
          absl::StrCat(path_, " is a 3D map; only 2D maps are supported"));
    }
    const SubmapId id{stored.submap_id().trajectory_id(),
                      stored.submap_id().index()};
    const std::string name =
        absl::StrCat("(submap ", id.trajectory, ",", id.index, ") ");
    if (map_.state.pose_graph.submap_poses.count(id) == 0) {
      return reader_.Corrupted(name + "is not in the pose graph");
    }
    if (!stored.has_submap_2d()) return reader_.Corrupted(name + "is empty");
    const proto::Submap2D& submap = stored.submap_2d();
    const absl::StatusOr<Rigid3> local_pose = FromProto(submap.local_pose());
    if (!local_pose.ok()) {
      return reader_.Corrupted(
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
      return reader_.Corrupted(absl::StrCat(name, grid.status().message()));
    }
    summary.is_tsdf = submap.grid().has_tsdf_2d();
    summary.geometry = grid->geometry;
    summary.num_known_cells = static_cast<int>(grid->known.count());
    absl::Status status = AddSubmap(id, summary);
    if (status.ok() && on_submap_) on_submap_(id, summary, *grid);
    return status;
  }

  absl::Status AddSubmap(const SubmapId& id, const SubmapSummary& summary) {
    if (map_.state.submaps.emplace(id, summary).second) return absl::OkStatus();
    return reader_.Corrupted(
        absl::StrCat("is the second of submap ", id.trajectory, ",", id.index));
  }

  absl::Status ReadNode(const proto::Node& stored) {
    const NodeId id{stored.node_id().trajectory_id(), stored.node_id().index()};
    const std::string name =
        absl::StrCat("(node ", id.trajectory, ",", id.index, ") ");
    if (map_.state.pose_graph.nodes.count(id) == 0) {
      return reader_.Corrupted(name + "is not in the pose graph");
    }
    const absl::StatusOr<NodeAttitude> attitude =
        ReadNodeAttitude(stored.node_data());
    if (!attitude.ok()) {
      return reader_.Corrupted(absl::StrCat(name, attitude.status().message()));
    }
    if (!attitudes_.emplace(id, *attitude).second) {
      return reader_.Corrupted(name + "is the second of this node");
    }
    return absl::OkStatus();
  }

  absl::Status ReadOdometry(const proto::OdometryData& stored,
                            NodeOdometry* const odometry) {
    const absl::StatusOr<Rigid3> pose =
        FromProto(stored.odometry_data().pose());
    if (!pose.ok()) return reader_.Corrupted(pose.status().message());
    const absl::Status status = odometry->Add(
        stored.trajectory_id(), stored.odometry_data().timestamp(), *pose);
    return status.ok() ? status : reader_.Corrupted(status.message());
  }

  StateReader reader_;
  const std::string& path_;
  const SubmapCallback& on_submap_;
  StoredMap map_;
  std::map<NodeId, NodeAttitude> attitudes_;
};

}  // namespace

absl::StatusOr<StoredMap> ReadStoredMap(const std::string& path,
                                        const SubmapCallback& on_submap,
                                        const ProgressCallback& on_progress) {
  absl::StatusOr<StateReader> reader = StateReader::Open(path, on_progress);
  if (!reader.ok()) return reader.status();
  return MapReader(*std::move(reader), path, on_submap).Read();
}

}  // namespace cartographer_sdf
