// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/map_file.h"

#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/pbstream/point_cloud_codec.h"
#include "cartographer_sdf/pbstream/pose_graph_update.h"
#include "cartographer_sdf/pbstream/record_stream.h"
#include "cartographer_sdf/pbstream/state_reader.h"
#include "cartographer_sdf/pbstream/stored_map.h"

namespace cartographer_sdf {
namespace {

// Of the records of a file: the header is the first.
constexpr int kPoseGraphRecord = 1;

// The progress of a part of the work, as that of the whole.
ProgressCallback Part(const ProgressCallback& on_progress, const double start,
                      const double size) {
  if (!on_progress) return {};
  return [&on_progress, start, size](const double fraction) {
    on_progress(start + size * fraction);
  };
}

// Copies all records but the pose graph, which may be replaced.
absl::Status CopyRecords(const std::string& input, const std::string& output,
                         const std::optional<std::string>& pose_graph_record,
                         const ProgressCallback& on_progress) {
  absl::StatusOr<RecordReader> reader = RecordReader::Open(input);
  if (!reader.ok()) return reader.status();
  absl::StatusOr<RecordWriter> writer = RecordWriter::Open(output);
  if (!writer.ok()) return writer.status();
  std::string record;
  for (int i = 0;; ++i) {
    const absl::StatusOr<bool> has_record = reader->Read(&record);
    if (!has_record.ok()) return has_record.status();
    if (!*has_record) return writer->Commit();
    const bool is_replaced =
        i == kPoseGraphRecord && pose_graph_record.has_value();
    const absl::Status status =
        writer->Write(is_replaced ? *pose_graph_record : record);
    if (!status.ok()) return status;
    if (on_progress) {
      on_progress(static_cast<double>(reader->position()) /
                  static_cast<double>(reader->size()));
    }
  }
}

}  // namespace

absl::StatusOr<MapState> ReadMap(const std::string& path,
                                 const SubmapCallback& on_submap,
                                 const ProgressCallback& on_progress) {
  absl::StatusOr<StoredMap> map = ReadStoredMap(path, on_submap, on_progress);
  if (!map.ok()) return map.status();
  return std::move(map->state);
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
  absl::StatusOr<StoredMap> map =
      ReadStoredMap(input, {}, Part(on_progress, 0., 0.5));
  if (!map.ok()) return map.status();
  proto::SerializedData& record = map->pose_graph_record;
  const absl::StatusOr<bool> changed = UpdatePoseGraph(
      map->state.pose_graph, pose_graph, record.mutable_pose_graph());
  if (!changed.ok()) {
    return absl::InvalidArgumentError(absl::StrCat(
        "cannot write ", output, ": ", input, " ", changed.status().message()));
  }
  std::optional<std::string> new_record;
  if (*changed && !record.SerializeToString(&new_record.emplace())) {
    return absl::ResourceExhaustedError(absl::StrCat(
        "cannot write ", output, ": its pose graph is larger than 2 GiB"));
  }
  return CopyRecords(input, output, new_record, Part(on_progress, 0.5, 0.5));
}

}  // namespace cartographer_sdf
