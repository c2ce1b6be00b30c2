// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/map_reader.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/pbstream/grid_conversion.h"
#include "cartographer_sdf/pbstream/point_cloud_codec.h"
#include "cartographer_sdf/pbstream/pose_codec.h"
#include "cartographer_sdf/pbstream/record_limits.h"
#include "cartographer_sdf/pbstream/trajectory_record.h"

namespace cartographer_sdf {
namespace {

using Kind = proto::SerializedData::DataCase;

constexpr char kPoseGraphName[] = "pose graph";
constexpr char kOptionsName[] = "options of trajectory builders";
// With and without histograms in submaps, which 2D does not use.
// Of all records but the pose graph: sixteen times the largest grid known.
constexpr int64_t kMaxOtherRecordSize = (int64_t{1} << 28) - 1;
constexpr uint32_t kMinFormatVersion = 1;
constexpr uint32_t kMaxFormatVersion = 2;

// Returns the name of the field that a record has; "unknown" for any other.
std::string KindName(const proto::SerializedData& data) {
  if (data.data_case() == Kind::DATA_NOT_SET) return "unknown";
  return data.GetDescriptor()->FindFieldByNumber(data.data_case())->name();
}

// As vector code, unlike Eigen's count().
int CountTrue(const BoolArray& cells) {
  return static_cast<int>(
      std::count(cells.data(), cells.data() + cells.size(), true));
}

// Returns whether both have the same elements, and their nodes the same gravity
// alignments.
bool AreSame(const RecordedElements& a, const RecordedElements& b) {
  return a.submaps == b.submaps &&
         std::equal(a.attitudes.begin(), a.attitudes.end(), b.attitudes.begin(),
                    b.attitudes.end(), [](const auto& one, const auto& other) {
                      return one.first == other.first &&
                             one.second.gravity_alignment.coeffs() ==
                                 other.second.gravity_alignment.coeffs();
                    });
}

}  // namespace

absl::StatusOr<MapReader> MapReader::Open(
    const std::string& path, MapVisitor visitor,
    const ProgressCallback& on_progress,
    const OdometryRecords odometry_records) {
  absl::StatusOr<RecordReader> records = RecordReader::Open(path);
  if (!records.ok()) return records.status();
  MapReader reader(*std::move(records));
  reader.visitor_ = std::move(visitor);
  reader.on_progress_ = on_progress;
  reader.state_.odometry_records = odometry_records;
  const absl::Status status = reader.ReadHeader();
  if (!status.ok()) return status;
  return reader;
}

absl::Status MapReader::ReadHeader() {
  const absl::StatusOr<bool> has_header = records_.Read(&record_);
  if (!has_header.ok()) return has_header.status();
  if (!*has_header) {
    return absl::DataLossError(absl::StrCat(
        records_.path(), " is truncated: it ends before its header"));
  }
  proto::SerializationHeader header;
  if (!header.ParseFromString(record_)) return Corrupted("is not a header");
  if (header.format_version() < kMinFormatVersion ||
      header.format_version() > kMaxFormatVersion) {
    return absl::UnimplementedError(absl::StrCat(
        records_.path(), " has format version ", header.format_version(),
        ", but only versions 1 and 2 are supported; Cartographer's "
        "`pbstream migrate` converts older files"));
  }
  state_.format_version = static_cast<int>(header.format_version());
  return absl::OkStatus();
}

absl::StatusOr<bool> MapReader::Next() {
  while (true) {
    absl::StatusOr<bool> has_record = ReadRecord();
    if (!has_record.ok() || !*has_record) return has_record;
    if (state_.odometry_records == OdometryRecords::kDrop &&
        data_.has_odometry_data()) {
      ++state_.num_dropped_odometry_records;
      continue;
    }
    ++state_.num_records[KindName(data_)];
    return true;
  }
}

absl::StatusOr<bool> MapReader::ReadRecord() {
  const absl::StatusOr<bool> has_record = records_.Read(
      &record_, num_records_ == 0 ? kMaxRecordSize : kMaxOtherRecordSize);
  if (!has_record.ok()) return has_record;
  if (on_progress_) {
    on_progress_(static_cast<double>(records_.position()) /
                 static_cast<double>(records_.size()));
  }
  if (!*has_record) {
    if (num_records_ >= 2) return false;
    return absl::DataLossError(
        absl::StrCat(records_.path(), " is truncated: it ends before its ",
                     num_records_ == 0 ? kPoseGraphName : kOptionsName));
  }
  if (HasTooManyFields(*proto::SerializedData::descriptor(), record_)) {
    return Corrupted("has too many fields");
  }
  if (!data_.ParseFromString(record_)) {
    return Corrupted("is not a valid protocol buffer");
  }
  ++num_records_;
  const absl::Status status = num_records_ == 1   ? ReadPoseGraph()
                              : num_records_ == 2 ? ReadOptions()
                                                  : ReadOther();
  if (!status.ok()) return status;
  return true;
}

absl::StatusOr<MapState> MapReader::Finish(
    const MissingRecords missing_records) {
  if (missing_records == MissingRecords::kRefuse) {
    if (absl::Status status = CheckIsWhole(); !status.ok()) return status;
  }
  state_.pose_graph =
      ToPoseGraph(stored_pose_graph_, recorded_.attitudes).value();
  state_.num_unrecorded_submaps = static_cast<int>(
      state_.pose_graph.submap_poses.size() - recorded_.submaps.size());
  state_.num_unrecorded_nodes = static_cast<int>(
      state_.pose_graph.nodes.size() - recorded_.attitudes.size());
  if (missing_records == MissingRecords::kDrop) {
    DropUnrecorded(recorded_, &state_.pose_graph);
  }
  if (state_.odometry_records == OdometryRecords::kKeep) {
    SetRelativeOdometry(odometry_->poses(), &state_.pose_graph.nodes);
  }
  return std::move(state_);
}

absl::Status MapReader::CheckIsWhole() const {
  // Records of what is not in the pose graph are errors.
  const size_t num_submaps = state_.pose_graph.submap_poses.size();
  const size_t num_nodes = state_.pose_graph.nodes.size();
  const size_t num_missing_submaps = num_submaps - recorded_.submaps.size();
  const size_t num_missing_nodes = num_nodes - recorded_.attitudes.size();
  if (num_missing_submaps == 0 && num_missing_nodes == 0) {
    return absl::OkStatus();
  }
  return absl::DataLossError(absl::StrCat(
      records_.path(), " is not whole: ", num_missing_submaps, " of ",
      num_submaps, " submaps and ", num_missing_nodes, " of ", num_nodes,
      " nodes in its pose graph have no record of their own, as if the file "
      "had been cut; close_loops and others leave them out with --repair"));
}

absl::Status MapReader::Expect(const Kind kind, const char* const name) const {
  if (data_.data_case() == kind) return absl::OkStatus();
  return Corrupted(absl::StrCat("is of the kind ", KindName(data_),
                                " where the ", name, " must be"));
}

absl::Status MapReader::ReadPoseGraph() {
  const absl::Status status = Expect(Kind::kPoseGraph, kPoseGraphName);
  if (!status.ok()) return status;
  stored_pose_graph_ = data_.pose_graph();
  // Poses are preliminary: the nodes' attitudes are not known yet.
  absl::StatusOr<PoseGraph> graph = ToPoseGraph(stored_pose_graph_, {});
  if (!graph.ok()) return Corrupted(graph.status().message());
  state_.pose_graph = *std::move(graph);
  for (const proto::Trajectory& trajectory : stored_pose_graph_.trajectory()) {
    state_.trajectories.push_back(trajectory.trajectory_id());
  }
  odometry_.emplace(state_.pose_graph.nodes);
  return absl::OkStatus();
}

absl::Status MapReader::ReadOptions() {
  const absl::Status status =
      Expect(Kind::kAllTrajectoryBuilderOptions, kOptionsName);
  if (!status.ok()) return status;
  const int num_options =
      data_.all_trajectory_builder_options().options_with_sensor_ids_size();
  const size_t num_trajectories = state_.trajectories.size();
  if (static_cast<size_t>(num_options) == num_trajectories) {
    return absl::OkStatus();
  }
  return absl::DataLossError(absl::StrCat(
      records_.path(), " is corrupted: its pose graph has ", num_trajectories,
      " trajectories, but it has options for ", num_options, " of them"));
}

absl::Status MapReader::CheckTrajectory() const {
  const std::optional<int> trajectory = TrajectoryOfRecord(data_);
  const std::vector<int>& known = state_.trajectories;
  if (!trajectory ||
      std::find(known.begin(), known.end(), *trajectory) != known.end()) {
    return absl::OkStatus();
  }
  return Corrupted(absl::StrCat("is of trajectory ", *trajectory,
                                ", which is not in the pose graph"));
}

absl::Status MapReader::CheckOrder(const proto::SensorData& stored) {
  const int64_t time = stored.data().timestamp();
  const auto [last, is_first] = last_times_.try_emplace(
      std::make_pair(static_cast<int>(data_.data_case()),
                     stored.trajectory_id()),
      time);
  if (!is_first && time <= last->second) {
    return Corrupted(
        absl::StrCat("has ", KindName(data_), " that is not in time order"));
  }
  last->second = time;
  return absl::OkStatus();
}

absl::Status MapReader::ReadOther() {
  if (absl::Status status = CheckTrajectory(); !status.ok()) return status;
  switch (data_.data_case()) {
    case Kind::kPoseGraph:
      return Corrupted("is a second pose graph");
    case Kind::kAllTrajectoryBuilderOptions:
      return Corrupted("is a second list of options");
    case Kind::kSubmap:
      return ReadSubmap(data_.submap());
    case Kind::kNode:
      return ReadNode(data_.node());
    case Kind::kOdometryData:
      return ReadOdometry(data_.odometry_data());
    case Kind::kImuData:
      return CheckOrder(data_.imu_data());
    case Kind::kFixedFramePoseData:
      return CheckOrder(data_.fixed_frame_pose_data());
    default:
      return absl::OkStatus();
  }
}

absl::Status MapReader::ReadSubmap(const proto::Submap& stored) {
  if (stored.has_submap_3d()) {
    return absl::UnimplementedError(absl::StrCat(
        records_.path(), " is a 3D map; only 2D maps are supported"));
  }
  const SubmapId id{stored.submap_id().trajectory_id(),
                    stored.submap_id().index()};
  const std::string name = "(" + Name("submap", id) + ") ";
  if (state_.pose_graph.submap_poses.count(id) == 0) {
    return Corrupted(name + "is not in the pose graph");
  }
  if (!recorded_.submaps.insert(id).second) {
    return Corrupted("is the second of " + Name("submap", id));
  }
  if (!stored.has_submap_2d()) return Corrupted(name + "is empty");
  const proto::Submap2D& submap = stored.submap_2d();
  const absl::StatusOr<Rigid3> local_pose = FromProto(submap.local_pose());
  if (!local_pose.ok()) {
    return Corrupted(absl::StrCat(name, local_pose.status().message()));
  }
  SubmapSummary summary;
  summary.finished = submap.finished();
  summary.num_range_data = submap.num_range_data();
  summary.T_local_submap = Project2D(*local_pose);
  if (!submap.has_grid()) {
    state_.submaps.emplace(id, summary);
    return absl::OkStatus();
  }
  absl::StatusOr<OccupancyGrid> grid =
      MakeOccupancyGrid(submap.grid(), summary.T_local_submap);
  if (!grid.ok()) {
    return Corrupted(absl::StrCat(name, grid.status().message()));
  }
  summary.is_tsdf = submap.grid().has_tsdf_2d();
  summary.geometry = grid->geometry;
  summary.num_known_cells = CountTrue(grid->known);
  state_.submaps.emplace(id, summary);
  if (visitor_.on_submap) visitor_.on_submap(id, summary, *std::move(grid));
  return absl::OkStatus();
}

absl::Status MapReader::ReadNode(const proto::Node& stored) {
  const NodeId id{stored.node_id().trajectory_id(), stored.node_id().index()};
  const std::string name = "(" + Name("node", id) + ") ";
  if (state_.pose_graph.nodes.count(id) == 0) {
    return Corrupted(name + "is not in the pose graph");
  }
  if (!stored.has_node_data()) return Corrupted(name + "has no data");
  const absl::StatusOr<NodeAttitude> attitude =
      ReadNodeAttitude(stored.node_data());
  if (!attitude.ok()) {
    return Corrupted(absl::StrCat(name, attitude.status().message()));
  }
  if (!recorded_.attitudes.emplace(id, *attitude).second) {
    return Corrupted(name + "is the second of this node");
  }
  const proto::NodeData& data = stored.node_data();
  if (!visitor_.on_point_cloud ||
      !data.has_filtered_gravity_aligned_point_cloud()) {
    return absl::OkStatus();
  }
  absl::StatusOr<PointCloud2> cloud =
      DecompressPointCloud(data.filtered_gravity_aligned_point_cloud());
  if (!cloud.ok()) {
    return Corrupted(absl::StrCat(name, cloud.status().message()));
  }
  visitor_.on_point_cloud(id, *std::move(cloud));
  return absl::OkStatus();
}

absl::Status MapReader::ReadOdometry(const proto::OdometryData& stored) {
  const absl::StatusOr<Rigid3> pose = FromProto(stored.odometry_data().pose());
  if (!pose.ok()) return Corrupted(pose.status().message());
  const absl::Status status = odometry_->Add(
      stored.trajectory_id(), stored.odometry_data().timestamp(), *pose);
  return status.ok() ? status : Corrupted(status.message());
}

absl::StatusOr<RecordWriter> WriteAssuming(const PoseGraph& pose_graph,
                                           const AssumingWriter& write) {
  RecordedElements assumed;
  for (const auto& [id, node] : pose_graph.nodes) {
    assumed.attitudes[id].gravity_alignment = node.gravity_alignment;
  }
  for (const auto& [id, pose] : pose_graph.submap_poses) {
    assumed.submaps.insert(id);
  }
  constexpr int kMaxAttempts = 2;
  for (int i = 0; i < kMaxAttempts; ++i) {
    absl::StatusOr<WrittenMap> map = write(assumed);
    if (!map.ok()) return map.status();
    if (AreSame(assumed, map->recorded)) {
      absl::Status status = CheckLoads(map->file);
      if (!status.ok()) return status;
      return std::move(map->file);
    }
    assumed = std::move(map->recorded);
  }
  return absl::AbortedError("the map changes while it is read");
}

absl::Status CheckLoads(const RecordWriter& output) {
  const auto ignore = [](const NodeId&, const PointCloud2&) {};
  const absl::Status status =
      ReadMap(output.temporary_path(), {{}, ignore}).status();
  if (status.ok()) return status;
  return absl::Status(
      status.code(),
      absl::StrCat("cannot write ", output.path(),
                   ": Cartographer would not load it: ", status.message()));
}

}  // namespace cartographer_sdf
