// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/map_file.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "cartographer_sdf/pbstream/map_reader.h"
#include "cartographer_sdf/pbstream/pose_graph_codec.h"

namespace cartographer_sdf {
namespace {

// Returns the changed pose graph; none if nothing differs.
absl::StatusOr<std::optional<std::string>> ChangedPoseGraph(
    PoseGraph pose_graph, const RecordedElements& recorded,
    proto::SerializedData record) {
  proto::PoseGraph* const stored = record.mutable_pose_graph();
  const bool dropped = DropUnrecorded(recorded, stored);
  if (dropped) DropUnrecorded(recorded, &pose_graph);
  const absl::StatusOr<bool> changed = UpdatePoseGraph(
      ToPoseGraph(*stored, recorded.attitudes).value(), pose_graph, stored);
  if (!changed.ok()) return changed.status();
  std::optional<std::string> result;
  if ((dropped || *changed) && !record.SerializeToString(&result.emplace())) {
    return absl::ResourceExhaustedError(
        "would have a pose graph larger than 2 GiB");
  }
  return result;
}

absl::StatusOr<WrittenMap> CopyMap(const MapSource& input,
                                   const std::string& output,
                                   const PoseGraph& pose_graph,
                                   const RecordedElements& assumed,
                                   const MapVisitor& visitor,
                                   const ProgressCallback& on_progress) {
  absl::StatusOr<MapReader> reader =
      MapReader::Open(input.path, visitor, on_progress, input.odometry_records);
  if (!reader.ok()) return reader.status();
  absl::StatusOr<RecordWriter> writer = RecordWriter::Open(output);
  if (!writer.ok()) return writer.status();
  std::optional<std::string> replacement;
  while (true) {
    const absl::Status status =
        replacement ? writer->Write(*replacement)
                    : writer->WriteCompressed(reader->compressed());
    if (!status.ok()) return status;
    const absl::StatusOr<bool> has_record = reader->Next();
    if (!has_record.ok()) return has_record.status();
    if (!*has_record) {
      if (input.missing_records == MissingRecords::kRefuse) {
        const absl::Status whole = reader->CheckIsWhole();
        if (!whole.ok()) return whole;
      }
      return WrittenMap{*std::move(writer), reader->recorded()};
    }
    replacement.reset();
    if (!reader->data().has_pose_graph()) continue;
    absl::StatusOr<std::optional<std::string>> changed =
        ChangedPoseGraph(pose_graph, assumed, reader->data());
    if (!changed.ok()) {
      return absl::Status(
          changed.status().code(),
          absl::StrCat("cannot write ", output, ": ", input.path, " ",
                       changed.status().message()));
    }
    replacement = *std::move(changed);
  }
}

}  // namespace

absl::StatusOr<MapState> ReadMap(const MapSource& source,
                                 const MapVisitor& visitor,
                                 const ProgressCallback& on_progress) {
  absl::StatusOr<MapReader> reader = MapReader::Open(
      source.path, visitor, on_progress, source.odometry_records);
  if (!reader.ok()) return reader.status();
  while (true) {
    const absl::StatusOr<bool> has_record = reader->Next();
    if (!has_record.ok()) return has_record.status();
    if (!*has_record) return reader->Finish(source.missing_records);
  }
}

absl::StatusOr<std::vector<int>> ReadTrajectories(const std::string& path) {
  absl::StatusOr<MapReader> reader = MapReader::Open(path, {}, {});
  if (!reader.ok()) return reader.status();
  const absl::StatusOr<bool> has_pose_graph = reader->Next();
  if (!has_pose_graph.ok()) return has_pose_graph.status();
  std::vector<int> trajectories;
  for (const proto::Trajectory& trajectory :
       reader->data().pose_graph().trajectory()) {
    trajectories.push_back(trajectory.trajectory_id());
  }
  return trajectories;
}

absl::Status CheckHasTrajectories(const std::string& path,
                                  const std::set<int>& trajectories) {
  if (trajectories.empty()) return absl::OkStatus();
  const absl::StatusOr<std::vector<int>> known = ReadTrajectories(path);
  if (!known.ok()) return known.status();
  for (const int trajectory : trajectories) {
    if (std::count(known->begin(), known->end(), trajectory) > 0) continue;
    return absl::NotFoundError(
        absl::StrCat(path, " has no trajectory ", trajectory, "; it has ",
                     known->empty() ? "none" : absl::StrJoin(*known, ", ")));
  }
  return absl::OkStatus();
}

absl::StatusOr<std::map<NodeId, PointCloud2>> ReadPointClouds(
    const MapSource& source, const std::set<NodeId>& nodes,
    const ProgressCallback& on_progress) {
  std::map<NodeId, PointCloud2> clouds;
  const auto keep = [&](const NodeId& id, PointCloud2 cloud) {
    if (nodes.count(id) > 0) clouds.emplace(id, std::move(cloud));
  };
  const absl::StatusOr<MapState> map = ReadMap(source, {{}, keep}, on_progress);
  if (!map.ok()) return map.status();
  return clouds;
}

absl::Status WriteMap(const MapSource& input, const std::string& output,
                      const PoseGraph& pose_graph,
                      const ProgressCallback& on_progress) {
  absl::StatusOr<RecordWriter> map =
      PrepareMap(input, output, pose_graph, {}, on_progress);
  if (!map.ok()) return map.status();
  return map->Commit();
}

absl::StatusOr<RecordWriter> PrepareMap(const MapSource& input,
                                        const std::string& output,
                                        const PoseGraph& pose_graph,
                                        const MapVisitor& visitor,
                                        const ProgressCallback& on_progress) {
  // A visitor that has seen the whole map is not called again.
  MapVisitor next_visitor = visitor;
  return WriteAssuming(pose_graph, [&](const RecordedElements& assumed) {
    return CopyMap(input, output, pose_graph, assumed,
                   std::exchange(next_visitor, {}), on_progress);
  });
}

}  // namespace cartographer_sdf
