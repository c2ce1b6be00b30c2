// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/map_file.h"

#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/pbstream/map_reader.h"
#include "cartographer_sdf/pbstream/pose_graph_codec.h"

namespace cartographer_sdf {
namespace {

// Returns the changed pose graph; none if nothing differs.
absl::StatusOr<std::optional<std::string>> ChangedPoseGraph(
    const PoseGraph& pose_graph, const Attitudes& attitudes,
    proto::SerializedData record) {
  const absl::StatusOr<bool> changed =
      UpdatePoseGraph(ToPoseGraph(record.pose_graph(), attitudes).value(),
                      pose_graph, record.mutable_pose_graph());
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
                    : writer->WriteCompressed(reader->compressed());
    if (!status.ok()) return status;
    const absl::StatusOr<bool> has_record = reader->Next();
    if (!has_record.ok()) return has_record.status();
    if (!*has_record) {
      return WrittenMap{*std::move(writer), reader->attitudes()};
    }
    replacement.reset();
    if (!reader->data().has_pose_graph()) continue;
    absl::StatusOr<std::optional<std::string>> changed =
        ChangedPoseGraph(pose_graph, attitudes, reader->data());
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
  std::map<NodeId, PointCloud2> clouds;
  const auto keep = [&](const NodeId& id, PointCloud2 cloud) {
    if (nodes.count(id) > 0) clouds.emplace(id, std::move(cloud));
  };
  const absl::StatusOr<MapState> map = ReadMap(path, {{}, keep}, on_progress);
  if (!map.ok()) return map.status();
  return clouds;
}

absl::Status WriteMap(const std::string& input, const std::string& output,
                      const PoseGraph& pose_graph,
                      const ProgressCallback& on_progress) {
  absl::StatusOr<RecordWriter> map =
      PrepareMap(input, output, pose_graph, {}, on_progress);
  if (!map.ok()) return map.status();
  return map->Commit();
}

absl::StatusOr<RecordWriter> PrepareMap(const std::string& input,
                                        const std::string& output,
                                        const PoseGraph& pose_graph,
                                        const MapVisitor& visitor,
                                        const ProgressCallback& on_progress) {
  // A visitor that has seen the whole map is not called again.
  MapVisitor next_visitor = visitor;
  return WriteWithAssumedAttitudes(pose_graph, [&](const Attitudes& attitudes) {
    return CopyMap(input, output, pose_graph, attitudes,
                   std::exchange(next_visitor, {}), on_progress);
  });
}

}  // namespace cartographer_sdf
