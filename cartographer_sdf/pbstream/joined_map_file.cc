// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/joined_map_file.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/pbstream/pose_codec.h"
#include "cartographer_sdf/pbstream/pose_graph_update.h"
#include "cartographer_sdf/pbstream/record_stream.h"
#include "cartographer_sdf/pbstream/state_reader.h"
#include "cartographer_sdf/pbstream/stored_map.h"
#include "cartographer_sdf/pbstream/trajectory_record.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

using Kind = proto::SerializedData::DataCase;

// The host's order.
constexpr Kind kOrder[] = {Kind::kSubmap,         Kind::kNode,
                           Kind::kTrajectoryData, Kind::kImuData,
                           Kind::kOdometryData,   Kind::kFixedFramePoseData,
                           Kind::kLandmarkData};

SubmapId Renumbered(const MapPart& part, const SubmapId& id) {
  return {part.trajectories.at(id.trajectory), id.index};
}

NodeId Renumbered(const MapPart& part, const NodeId& id) {
  return {part.trajectories.at(id.trajectory), id.index};
}

void Renumber(const MapPart& part, proto::Id* const id) {
  id->set_trajectory_id(part.trajectories.at(id->trajectory_id()));
}

void AppendPoseGraph(const MapPart& part, const PoseGraph& pose_graph,
                     PoseGraph* const joined) {
  for (const auto& [id, pose] : pose_graph.submap_poses) {
    CHECK(joined->submap_poses.emplace(Renumbered(part, id), pose).second);
  }
  for (const auto& [id, node] : pose_graph.nodes) {
    CHECK(joined->nodes.emplace(Renumbered(part, id), node).second);
  }
  for (Constraint constraint : pose_graph.constraints) {
    constraint.submap = Renumbered(part, constraint.submap);
    constraint.node = Renumbered(part, constraint.node);
    joined->constraints.push_back(constraint);
  }
  joined->landmark_poses.insert(pose_graph.landmark_poses.begin(),
                                pose_graph.landmark_poses.end());
}

// The same as AppendPoseGraph, of the stored graph.
void AppendStored(const MapPart& part, proto::PoseGraph stored,
                  proto::PoseGraph* const joined) {
  std::set<std::string> known_landmarks;
  for (const proto::LandmarkPose& landmark : joined->landmark_poses()) {
    known_landmarks.insert(landmark.landmark_id());
  }
  for (proto::Constraint& constraint : *stored.mutable_constraint()) {
    Renumber(part, constraint.mutable_submap_id());
    Renumber(part, constraint.mutable_node_id());
  }
  for (proto::Trajectory& trajectory : *stored.mutable_trajectory()) {
    trajectory.set_trajectory_id(
        part.trajectories.at(trajectory.trajectory_id()));
  }
  google::protobuf::RepeatedPtrField<proto::LandmarkPose> new_landmarks;
  for (proto::LandmarkPose& landmark : *stored.mutable_landmark_poses()) {
    if (known_landmarks.count(landmark.landmark_id()) == 0) {
      *new_landmarks.Add() = std::move(landmark);
    }
  }
  stored.mutable_landmark_poses()->Swap(&new_landmarks);
  joined->MergeFrom(stored);
}

// Reads a part record by record, one ahead.
class PartReader {
 public:
  [[nodiscard]] static absl::StatusOr<PartReader> Open(
      const MapPart& part, const ProgressCallback& on_progress) {
    absl::StatusOr<StateReader> reader =
        StateReader::Open(part.path, on_progress);
    if (!reader.ok()) return reader.status();
    PartReader result(part, *std::move(reader));
    // The pose graph, the options, and the first of what follows: a file that
    // ReadMap has read has the former.
    for (int i = 0; i < 3; ++i) {
      if (absl::Status status = result.Advance(); !status.ok()) return status;
      if (i == 1) {
        result.options_ =
            result.reader_.data().all_trajectory_builder_options();
      }
    }
    return result;
  }

  [[nodiscard]] bool is_at_end() const { return is_at_end_; }
  [[nodiscard]] const proto::SerializedData& data() const {
    return reader_.data();
  }
  [[nodiscard]] int format_version() const { return reader_.format_version(); }
  [[nodiscard]] absl::Status Advance() {
    const absl::StatusOr<bool> has_record = reader_.Next();
    if (!has_record.ok()) return has_record.status();
    is_at_end_ = !*has_record;
    return absl::OkStatus();
  }

  // The options under new numbers.
  [[nodiscard]] absl::StatusOr<proto::AllTrajectoryBuilderOptions> Options()
      const {
    proto::AllTrajectoryBuilderOptions options = options_;
    for (proto::TrajectoryBuilderOptionsWithSensorIds& entry :
         *options.mutable_options_with_sensor_ids()) {
      if (!entry.trajectory_builder_options().has_initial_trajectory_pose()) {
        continue;
      }
      proto::InitialTrajectoryPose& pose =
          *entry.mutable_trajectory_builder_options()
               ->mutable_initial_trajectory_pose();
      const auto number = part_->trajectories.find(pose.to_trajectory_id());
      // Cartographer keeps what a trajectory once began at, even where that has
      // been deleted since; a number that now means another would mislead.
      if (number == part_->trajectories.end()) {
        entry.mutable_trajectory_builder_options()
            ->clear_initial_trajectory_pose();
      } else {
        pose.set_to_trajectory_id(number->second);
      }
    }
    return options;
  }

  // The current record under its new number.
  [[nodiscard]] absl::StatusOr<std::string> Record(
      const std::map<int, Rigid3>& T_joined_map) const {
    const std::optional<int> trajectory = TrajectoryOfRecord(data());
    if (!trajectory) return reader_.record();
    const auto number = part_->trajectories.find(*trajectory);
    if (number == part_->trajectories.end()) {
      return reader_.Corrupted(
          absl::StrCat("is of trajectory ", *trajectory,
                       ", which is not in the pose graph"));
    }
    if (data().trajectory_data().has_fixed_frame_origin_in_map()) {
      return MovedTrajectoryData(number->second, T_joined_map);
    }
    if (number->first == number->second) return reader_.record();
    return WithTrajectory(reader_.record(), data(), number->second);
  }

 private:
  PartReader(const MapPart& part, StateReader reader)
      : part_(&part), reader_(std::move(reader)) {}

  [[nodiscard]] absl::StatusOr<std::string> MovedTrajectoryData(
      const int number, const std::map<int, Rigid3>& T_joined_map) const {
    proto::SerializedData moved = data();
    moved.mutable_trajectory_data()->set_trajectory_id(number);
    const auto T = T_joined_map.find(number);
    if (T != T_joined_map.end()) {
      proto::Rigid3d& origin =
          *moved.mutable_trajectory_data()->mutable_fixed_frame_origin_in_map();
      const absl::StatusOr<Rigid3> before = FromProto(origin);
      if (!before.ok()) {
        return reader_.Corrupted(absl::StrCat("has an origin of GPS that ",
                                              before.status().message()));
      }
      origin = ToProto(T->second * *before);
    }
    return moved.SerializeAsString();
  }

  const MapPart* part_;
  StateReader reader_;
  proto::AllTrajectoryBuilderOptions options_;
  bool is_at_end_ = false;
};

// How the first node of each trajectory moved.
std::map<int, Rigid3> FirstNodesMoved(const PoseGraph& before,
                                      const PoseGraph& after) {
  std::map<int, Rigid3> moved;
  for (const auto& [id, node] : before.nodes) {
    const auto it = after.nodes.find(id);
    if (it == after.nodes.end()) continue;
    const Rigid2 T_after_before =
        it->second.T_map_node * node.T_map_node.Inverse();
    moved.emplace(id.trajectory, Embed3D(T_after_before));
  }
  return moved;
}

// Reads the pose graphs of all parts and makes one of them.
struct JoinedGraph {
  PoseGraph before;
  proto::SerializedData record;
};

absl::StatusOr<JoinedGraph> ReadJoinedGraph(
    const std::vector<MapPart>& parts, const ProgressCallback& on_progress) {
  JoinedGraph joined;
  for (size_t k = 0; k < parts.size(); ++k) {
    absl::StatusOr<StoredMap> map = ReadStoredMap(parts[k].path, {}, {});
    if (!map.ok()) return map.status();
    for (const int trajectory : map->state.trajectories) {
      if (parts[k].trajectories.count(trajectory) == 0) {
        return absl::FailedPreconditionError(absl::StrCat(
            parts[k].path, " has changed: it has got trajectory ", trajectory));
      }
    }
    AppendPoseGraph(parts[k], map->state.pose_graph, &joined.before);
    AppendStored(parts[k],
                 std::move(*map->pose_graph_record.mutable_pose_graph()),
                 joined.record.mutable_pose_graph());
    if (on_progress) {
      on_progress(0.5 * static_cast<double>(k + 1) /
                  static_cast<double>(parts.size()));
    }
  }
  return joined;
}

absl::Status WriteMessage(const google::protobuf::MessageLite& message,
                          const std::string& output, const char* const name,
                          RecordWriter* const writer) {
  std::string record;
  if (!message.SerializeToString(&record)) {
    return absl::ResourceExhaustedError(absl::StrCat(
        "cannot write ", output, ": its ", name, " is larger than 2 GiB"));
  }
  return writer->Write(record);
}

}  // namespace

absl::Status CheckIsNoInput(const std::string& input,
                            const std::string& output) {
  std::error_code error;
  if (std::filesystem::equivalent(input, output, error)) {
    return absl::InvalidArgumentError(absl::StrCat(
        "cannot write ", output, ": it is one of the maps that are read"));
  }
  return absl::OkStatus();
}

std::vector<MapPart> NumberTrajectories(
    const std::vector<std::string>& paths,
    const std::vector<const MapState*>& maps) {
  CHECK_EQ(paths.size(), maps.size());
  std::vector<MapPart> parts;
  int number = 0;
  for (size_t k = 0; k < paths.size(); ++k) {
    MapPart part{paths[k], {}};
    for (const int trajectory : maps[k]->trajectories) {
      part.trajectories[trajectory] = number++;
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

void AppendMap(const MapPart& part, const MapState& map,
               MapState* const joined) {
  joined->format_version = std::max(joined->format_version, map.format_version);
  AppendPoseGraph(part, map.pose_graph, &joined->pose_graph);
  for (const auto& [id, submap] : map.submaps) {
    CHECK(joined->submaps.emplace(Renumbered(part, id), submap).second);
  }
  joined->num_trajectories += map.num_trajectories;
  for (const int trajectory : map.trajectories) {
    joined->trajectories.push_back(part.trajectories.at(trajectory));
  }
  for (const auto& [kind, count] : map.num_records) {
    joined->num_records[kind] += count;
  }
}

absl::Status WriteJoinedMap(const std::vector<MapPart>& parts,
                            const PoseGraph& pose_graph,
                            const std::string& output,
                            const ProgressCallback& on_progress) {
  CHECK(!parts.empty());
  for (const MapPart& part : parts) {
    absl::Status status = CheckIsNoInput(part.path, output);
    if (!status.ok()) return status;
  }
  absl::StatusOr<JoinedGraph> joined = ReadJoinedGraph(parts, on_progress);
  if (!joined.ok()) return joined.status();
  const absl::StatusOr<bool> changed = UpdatePoseGraph(
      joined->before, pose_graph, joined->record.mutable_pose_graph());
  if (!changed.ok()) {
    return absl::InvalidArgumentError(absl::StrCat("cannot write ", output,
                                                   ": the joined map ",
                                                   changed.status().message()));
  }
  const std::map<int, Rigid3> T_joined_map =
      FirstNodesMoved(joined->before, pose_graph);

  std::vector<PartReader> readers;
  proto::SerializationHeader header;
  proto::SerializedData options;
  for (const MapPart& part : parts) {
    absl::StatusOr<PartReader> reader = PartReader::Open(part, {});
    if (!reader.ok()) return reader.status();
    header.set_format_version(
        std::max(header.format_version(),
                 static_cast<uint32_t>(reader->format_version())));
    const absl::StatusOr<proto::AllTrajectoryBuilderOptions> part_options =
        reader->Options();
    if (!part_options.ok()) return part_options.status();
    options.mutable_all_trajectory_builder_options()->MergeFrom(*part_options);
    readers.push_back(*std::move(reader));
  }
  absl::StatusOr<RecordWriter> writer = RecordWriter::Open(output);
  if (!writer.ok()) return writer.status();
  absl::Status status = WriteMessage(header, output, "header", &*writer);
  if (status.ok()) {
    status = WriteMessage(joined->record, output, "pose graph", &*writer);
  }
  if (status.ok()) {
    status = WriteMessage(options, output, "list of options", &*writer);
  }
  if (!status.ok()) return status;

  // Each file is read once: all go on while they have records of the kind whose
  // turn it is. What comes too late in a file is written where it comes.
  for (size_t turn = 0; turn <= std::size(kOrder); ++turn) {
    for (PartReader& reader : readers) {
      while (!reader.is_at_end()) {
        const auto* const kind = std::find(std::begin(kOrder), std::end(kOrder),
                                           reader.data().data_case());
        if (kind - std::begin(kOrder) > static_cast<std::ptrdiff_t>(turn)) {
          break;
        }
        const absl::StatusOr<std::string> record = reader.Record(T_joined_map);
        if (!record.ok()) return record.status();
        status = writer->Write(*record);
        if (status.ok()) status = reader.Advance();
        if (!status.ok()) return status;
      }
    }
    if (on_progress) {
      on_progress(0.5 + 0.5 * static_cast<double>(turn + 1) /
                            static_cast<double>(std::size(kOrder) + 1));
    }
  }
  return writer->Commit();
}

absl::StatusOr<std::map<NodeId, PointCloud2>> ReadJoinedPointClouds(
    const std::vector<MapPart>& parts, const std::set<NodeId>& nodes,
    const ProgressCallback& on_progress) {
  std::map<NodeId, PointCloud2> joined;
  for (size_t k = 0; k < parts.size(); ++k) {
    std::set<NodeId> own_nodes;
    for (const auto& [trajectory, number] : parts[k].trajectories) {
      for (auto node = nodes.lower_bound(NodeId{number, 0});
           node != nodes.end() && node->trajectory == number; ++node) {
        own_nodes.insert(NodeId{trajectory, node->index});
      }
    }
    if (!own_nodes.empty()) {
      absl::StatusOr<std::map<NodeId, PointCloud2>> clouds =
          ReadPointClouds(parts[k].path, own_nodes);
      if (!clouds.ok()) return clouds.status();
      for (auto& [id, cloud] : *clouds) {
        joined.emplace(Renumbered(parts[k], id), std::move(cloud));
      }
    }
    if (on_progress) {
      on_progress(static_cast<double>(k + 1) /
                  static_cast<double>(parts.size()));
    }
  }
  return joined;
}

}  // namespace cartographer_sdf
