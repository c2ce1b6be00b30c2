// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/joined_map_file.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/pbstream/map_reader.h"
#include "cartographer_sdf/pbstream/pose_codec.h"
#include "cartographer_sdf/pbstream/pose_graph_codec.h"
#include "cartographer_sdf/pbstream/record_stream.h"
#include "cartographer_sdf/pbstream/trajectory_record.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

using Kind = proto::SerializedData::DataCase;

// The host's order of record kinds.
constexpr Kind kOrder[] = {Kind::kSubmap,         Kind::kNode,
                           Kind::kTrajectoryData, Kind::kImuData,
                           Kind::kOdometryData,   Kind::kFixedFramePoseData,
                           Kind::kLandmarkData};

void Renumber(const MapPart& part, proto::Id* const id) {
  id->set_trajectory_id(part.trajectories.at(id->trajectory_id()));
}

// The leading records, merged from all parts under the new numbers.
struct Beginning {
  proto::SerializationHeader header;
  proto::SerializedData pose_graph;
  proto::SerializedData options;
};

// AppendMap for the stored graph.
absl::Status AppendStored(const MapPart& part, proto::PoseGraph stored,
                          proto::PoseGraph* const joined) {
  for (proto::Trajectory& trajectory : *stored.mutable_trajectory()) {
    const auto number = part.trajectories.find(trajectory.trajectory_id());
    if (number == part.trajectories.end()) {
      return absl::FailedPreconditionError(
          absl::StrCat(part.path, " has changed: it has a new trajectory ",
                       trajectory.trajectory_id()));
    }
    trajectory.set_trajectory_id(number->second);
  }
  for (proto::Constraint& constraint : *stored.mutable_constraint()) {
    Renumber(part, constraint.mutable_submap_id());
    Renumber(part, constraint.mutable_node_id());
  }
  std::set<std::string> known_landmarks;
  for (const proto::LandmarkPose& landmark : joined->landmark_poses()) {
    known_landmarks.insert(landmark.landmark_id());
  }
  google::protobuf::RepeatedPtrField<proto::LandmarkPose> new_landmarks;
  for (proto::LandmarkPose& landmark : *stored.mutable_landmark_poses()) {
    if (known_landmarks.count(landmark.landmark_id()) == 0) {
      *new_landmarks.Add() = std::move(landmark);
    }
  }
  stored.mutable_landmark_poses()->Swap(&new_landmarks);
  joined->MergeFrom(stored);
  return absl::OkStatus();
}

void AppendOptions(const MapPart& part,
                   proto::AllTrajectoryBuilderOptions options,
                   proto::AllTrajectoryBuilderOptions* const joined) {
  for (proto::TrajectoryBuilderOptionsWithSensorIds& entry :
       *options.mutable_options_with_sensor_ids()) {
    if (!entry.trajectory_builder_options().has_initial_trajectory_pose()) {
      continue;
    }
    proto::TrajectoryBuilderOptions& builder =
        *entry.mutable_trajectory_builder_options();
    const auto number = part.trajectories.find(
        builder.initial_trajectory_pose().to_trajectory_id());
    // Cartographer keeps the trajectory that an initial pose refers to, even
    // after that trajectory was deleted; its number may now denote another one.
    if (number == part.trajectories.end()) {
      builder.clear_initial_trajectory_pose();
    } else {
      builder.mutable_initial_trajectory_pose()->set_to_trajectory_id(
          number->second);
    }
  }
  joined->MergeFrom(options);
}

// Reads a part record by record, one ahead, with the checks of ReadMap().
class PartReader {
 public:
  // Adds the leading records to `beginning` and advances to the first one
  // after.
  [[nodiscard]] static absl::StatusOr<PartReader> Open(
      const MapPart& part, const ProgressCallback& on_progress,
      Beginning* const beginning) {
    absl::StatusOr<MapReader> reader =
        MapReader::Open(part.path, {}, on_progress, part.odometry_records);
    if (!reader.ok()) return reader.status();
    PartReader result(part, *std::move(reader));
    beginning->header.set_format_version(
        std::max(beginning->header.format_version(),
                 static_cast<uint32_t>(result.reader_.format_version())));
    absl::Status status = result.Advance();
    if (status.ok()) {
      status = AppendStored(part, result.data().pose_graph(),
                            beginning->pose_graph.mutable_pose_graph());
    }
    if (status.ok()) status = result.Advance();
    if (status.ok()) {
      AppendOptions(
          part, result.data().all_trajectory_builder_options(),
          beginning->options.mutable_all_trajectory_builder_options());
      status = result.Advance();
    }
    if (!status.ok()) return status;
    return result;
  }

  [[nodiscard]] bool is_at_end() const { return is_at_end_; }
  [[nodiscard]] const proto::SerializedData& data() const {
    return reader_.data();
  }
  [[nodiscard]] absl::Status Advance() {
    const absl::StatusOr<bool> has_record = reader_.Next();
    if (!has_record.ok()) return has_record.status();
    is_at_end_ = !*has_record;
    return absl::OkStatus();
  }

  // Adds the submaps and nodes read so far, under the new numbers.
  void AppendRecorded(RecordedElements* const recorded) const {
    for (const auto& [id, attitude] : reader_.recorded().attitudes) {
      recorded->attitudes.emplace(Renumbered(*part_, id), attitude);
    }
    for (const SubmapId& id : reader_.recorded().submaps) {
      recorded->submaps.insert(Renumbered(*part_, id));
    }
  }

  // Writes the current record with its new trajectory number.
  [[nodiscard]] absl::Status WriteRecord(
      const std::map<int, Rigid3>& T_joined_map,
      RecordWriter* const writer) const {
    const std::optional<int> trajectory = TrajectoryOfRecord(data());
    if (!trajectory) return writer->WriteCompressed(reader_.compressed());
    const auto number = part_->trajectories.find(*trajectory);
    CHECK(number != part_->trajectories.end()) << *trajectory;
    if (data().trajectory_data().has_fixed_frame_origin_in_map()) {
      const absl::StatusOr<std::string> moved =
          MovedTrajectoryData(number->second, T_joined_map);
      return moved.ok() ? writer->Write(*moved) : moved.status();
    }
    if (number->first == number->second) {
      return writer->WriteCompressed(reader_.compressed());
    }
    return writer->Write(
        WithTrajectory(reader_.record(), data(), number->second));
  }

 private:
  PartReader(const MapPart& part, MapReader reader)
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
        return reader_.Corrupted(
            absl::StrCat("has a GPS origin that ", before.status().message()));
      }
      origin = ToProto(T->second * *before);
    }
    return moved.SerializeAsString();
  }

  const MapPart* part_;
  MapReader reader_;
  bool is_at_end_ = false;
};

// Returns the motion of the first node of each trajectory.
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

// Returns the motion of the first node of each trajectory.
absl::StatusOr<std::map<int, Rigid3>> WriteBeginning(
    PoseGraph pose_graph, const RecordedElements& assumed,
    const std::string& output, Beginning* const beginning,
    RecordWriter* const writer) {
  proto::PoseGraph* const stored = beginning->pose_graph.mutable_pose_graph();
  if (DropUnrecorded(assumed, stored)) DropUnrecorded(assumed, &pose_graph);
  const PoseGraph before = ToPoseGraph(*stored, assumed.attitudes).value();
  const absl::StatusOr<bool> changed =
      UpdatePoseGraph(before, pose_graph, stored);
  if (!changed.ok()) {
    return absl::InvalidArgumentError(absl::StrCat("cannot write ", output,
                                                   ": the joined map ",
                                                   changed.status().message()));
  }
  const std::pair<const char*, const google::protobuf::MessageLite*>
      messages[] = {{"header", &beginning->header},
                    {"pose graph", &beginning->pose_graph},
                    {"list of options", &beginning->options}};
  for (const auto& [name, message] : messages) {
    std::string record;
    if (!message->SerializeToString(&record)) {
      return absl::ResourceExhaustedError(absl::StrCat(
          "cannot write ", output, ": its ", name, " is larger than 2 GiB"));
    }
    const absl::Status status = writer->Write(record);
    if (!status.ok()) return status;
  }
  return FirstNodesMoved(before, pose_graph);
}

// Reads each file once: in turn for each kind, writes the records of that kind
// from all files. A record that comes too late in its file is written where it
// comes.
absl::Status WriteRecords(const std::map<int, Rigid3>& T_joined_map,
                          std::vector<PartReader>* const parts,
                          RecordWriter* const writer) {
  for (size_t turn = 0; turn <= std::size(kOrder); ++turn) {
    for (PartReader& part : *parts) {
      while (!part.is_at_end()) {
        const auto* const kind = std::find(std::begin(kOrder), std::end(kOrder),
                                           part.data().data_case());
        if (kind - std::begin(kOrder) > static_cast<std::ptrdiff_t>(turn)) {
          break;
        }
        absl::Status status = part.WriteRecord(T_joined_map, writer);
        if (status.ok()) status = part.Advance();
        if (!status.ok()) return status;
      }
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<WrittenMap> JoinMaps(const std::vector<MapPart>& parts,
                                    const PoseGraph& pose_graph,
                                    const RecordedElements& assumed,
                                    const std::string& output,
                                    const ProgressCallback& on_progress) {
  // Progress of each part; the total is their mean.
  std::vector<double> fractions(parts.size(), 0.);
  Beginning beginning;
  std::vector<PartReader> readers;
  for (size_t k = 0; k < parts.size(); ++k) {
    const auto on_part = [&fractions, &on_progress, k](const double fraction) {
      fractions[k] = fraction;
      if (!on_progress) return;
      on_progress(std::accumulate(fractions.begin(), fractions.end(), 0.) /
                  static_cast<double>(fractions.size()));
    };
    absl::StatusOr<PartReader> reader =
        PartReader::Open(parts[k], on_part, &beginning);
    if (!reader.ok()) return reader.status();
    readers.push_back(*std::move(reader));
  }
  absl::StatusOr<RecordWriter> writer = RecordWriter::Open(output);
  if (!writer.ok()) return writer.status();
  const absl::StatusOr<std::map<int, Rigid3>> T_joined_map =
      WriteBeginning(pose_graph, assumed, output, &beginning, &*writer);
  if (!T_joined_map.ok()) return T_joined_map.status();
  const absl::Status status = WriteRecords(*T_joined_map, &readers, &*writer);
  if (!status.ok()) return status;
  WrittenMap map{*std::move(writer), {}};
  for (const PartReader& reader : readers) {
    reader.AppendRecorded(&map.recorded);
  }
  return map;
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
    MapPart part{paths[k], {}, maps[k]->odometry_records};
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
  PoseGraph& graph = joined->pose_graph;
  for (const auto& [id, pose] : map.pose_graph.submap_poses) {
    CHECK(graph.submap_poses.emplace(Renumbered(part, id), pose).second);
  }
  for (const auto& [id, node] : map.pose_graph.nodes) {
    CHECK(graph.nodes.emplace(Renumbered(part, id), node).second);
  }
  for (Constraint constraint : map.pose_graph.constraints) {
    constraint.submap = Renumbered(part, constraint.submap);
    constraint.node = Renumbered(part, constraint.node);
    graph.constraints.push_back(constraint);
  }
  graph.landmark_poses.insert(map.pose_graph.landmark_poses.begin(),
                              map.pose_graph.landmark_poses.end());
  for (const auto& [id, submap] : map.submaps) {
    CHECK(joined->submaps.emplace(Renumbered(part, id), submap).second);
  }
  for (const int trajectory : map.trajectories) {
    joined->trajectories.push_back(part.trajectories.at(trajectory));
  }
  joined->num_unrecorded_submaps += map.num_unrecorded_submaps;
  joined->num_unrecorded_nodes += map.num_unrecorded_nodes;
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
  absl::StatusOr<RecordWriter> file =
      WriteAssuming(pose_graph, [&](const RecordedElements& assumed) {
        return JoinMaps(parts, pose_graph, assumed, output, on_progress);
      });
  if (!file.ok()) return file.status();
  return file->Commit();
}

}  // namespace cartographer_sdf
