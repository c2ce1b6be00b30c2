// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/map_file.h"

#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/pbstream/assumed_attitudes.h"
#include "cartographer_sdf/pbstream/map_reader.h"
#include "cartographer_sdf/pbstream/point_cloud_codec.h"
#include "cartographer_sdf/pbstream/pose_graph_codec.h"
#include "cartographer_sdf/pbstream/pose_graph_update.h"
#include "cartographer_sdf/pbstream/state_reader.h"

namespace cartographer_sdf {
namespace {

// The pose graph with the changes; none where nothing differs.
absl::StatusOr<std::optional<std::string>> ChangedPoseGraph(
    const PoseGraph& pose_graph, const Attitudes& attitudes,
    proto::SerializedData record) {
  const absl::StatusOr<bool> changed =
      UpdatePoseGraph(ToPoseGraph(record.pose_graph(), attitudes), pose_graph,
                      record.mutable_pose_graph());
  if (!changed.ok()) return changed.status();
  std::optional<std::string> result;
  if (*changed && !record.SerializeToString(&result.emplace())) {
    return absl::ResourceExhaustedError(
        "would have a pose graph larger than 2 GiB");
  }
  return result;
}

absl::StatusOr<WrittenMap> CopyMap(const std::string& input,
                                   const std::string& output,
                                   const PoseGraph& pose_graph,
                                   const Attitudes& attitudes,
                                   const MapVisitor& visitor,
                                   const ProgressCallback& on_progress) {
  absl::StatusOr<MapReader> reader =
      MapReader::Open(input, visitor, on_progress);
  if (!reader.ok()) return reader.status();
  absl::StatusOr<RecordWriter> writer = RecordWriter::Open(output);
  if (!writer.ok()) return writer.status();
  std::optional<std::string> replacement;
  while (true) {
    const absl::Status status =
        replacement ? writer->Write(*replacement)
                    : writer->WriteCompressed(reader->record().compressed());
    if (!status.ok()) return status;
    const absl::StatusOr<bool> has_record = reader->Next();
    if (!has_record.ok()) return has_record.status();
    if (!*has_record) {
      return WrittenMap{*std::move(writer), reader->attitudes()};
    }
    replacement.reset();
    if (!reader->record().data().has_pose_graph()) continue;
    absl::StatusOr<std::optional<std::string>> changed =
        ChangedPoseGraph(pose_graph, attitudes, reader->record().data());
    if (!changed.ok()) {
      return absl::Status(changed.status().code(),
                          absl::StrCat("cannot write ", output, ": ", input,
                                       " ", changed.status().message()));
    }
    replacement = *std::move(changed);
  }
}

}  // namespace

absl::StatusOr<MapState> ReadMap(const std::string& path,
                                 const MapVisitor& visitor,
                                 const ProgressCallback& on_progress) {
  absl::StatusOr<MapReader> reader =
      MapReader::Open(path, visitor, on_progress);
  if (!reader.ok()) return reader.status();
  while (true) {
    const absl::StatusOr<bool> has_record = reader->Next();
    if (!has_record.ok()) return has_record.status();
    if (!*has_record) return reader->Finish();
  }
}

absl::StatusOr<std::map<NodeId, PointCloud2>> ReadPointClouds(
    const std::string& path, const std::set<NodeId>& nodes,
    const ProgressCallback& on_progress) {
  absl::StatusOr<StateReader> reader = StateReader::Open(path, on_progress);
  if (!reader.ok()) return reader.status();
  std::map<NodeId, PointCloud2> clouds;
  while (true) {
    const absl::StatusOr<bool> has_record = reader->Next();
    if (!has_record.ok()) return has_record.status();
    if (!*has_record) return clouds;
    const proto::Node& node = reader->data().node();
    const NodeId id{node.node_id().trajectory_id(), node.node_id().index()};
    if (!reader->data().has_node() || nodes.count(id) == 0 ||
        !node.node_data().has_filtered_gravity_aligned_point_cloud()) {
      continue;
    }
    absl::StatusOr<PointCloud2> cloud = DecompressPointCloud(
        node.node_data().filtered_gravity_aligned_point_cloud());
    if (!cloud.ok()) return reader->Corrupted(cloud.status().message());
    if (!clouds.emplace(id, *std::move(cloud)).second) {
      return reader->Corrupted(
          absl::StrCat("is the second of node ", id.trajectory, ",", id.index));
    }
  }
}

absl::Status WriteMap(const std::string& input, const std::string& output,
                      const PoseGraph& pose_graph,
                      const ProgressCallback& on_progress) {
  absl::StatusOr<PreparedMap> map =
      PrepareMap(input, output, pose_graph, {}, on_progress);
  if (!map.ok()) return map.status();
  return map->Commit();
}

absl::StatusOr<PreparedMap> PrepareMap(const std::string& input,
                                       const std::string& output,
                                       const PoseGraph& pose_graph,
                                       const MapVisitor& visitor,
                                       const ProgressCallback& on_progress) {
  // Who has seen all is not called again.
  MapVisitor next_visitor = visitor;
  absl::StatusOr<RecordWriter> file =
      WriteWithAssumedAttitudes(pose_graph, [&](const Attitudes& attitudes) {
        return CopyMap(input, output, pose_graph, attitudes,
                       std::exchange(next_visitor, {}), on_progress);
      });
  if (!file.ok()) return file.status();
  return PreparedMap(*std::move(file));
}

}  // namespace cartographer_sdf
