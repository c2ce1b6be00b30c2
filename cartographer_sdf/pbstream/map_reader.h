// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_PBSTREAM_MAP_READER_H_
#define CARTOGRAPHER_SDF_PBSTREAM_MAP_READER_H_

#include <optional>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/pbstream/node_odometry.h"
#include "cartographer_sdf/pbstream/pose_graph_codec.h"
#include "cartographer_sdf/pbstream/state_reader.h"
#include "cartographer_sdf/serialized_state.pb.h"

namespace cartographer_sdf {

// ReadMap() record by record, with all its checks, for those who copy the
// records on the way. The first call of Next() goes to the pose graph, the
// second to the options, further ones to whatever the file has.
class MapReader {
 public:
  // Reads the header.
  [[nodiscard]] static absl::StatusOr<MapReader> Open(
      const std::string& path, MapVisitor visitor,
      const ProgressCallback& on_progress);

  // Goes to the next record and checks it; false at the end of the file. To end
  // before the options is an error.
  [[nodiscard]] absl::StatusOr<bool> Next();

  // The current record; the header at first.
  [[nodiscard]] const StateReader& record() const { return records_; }
  // Of the nodes whose records have come so far.
  [[nodiscard]] const Attitudes& attitudes() const { return attitudes_; }

  // What ReadMap() returns. Only at the end of the file, and once.
  [[nodiscard]] MapState Finish();

 private:
  MapReader(StateReader records, const std::string& path, MapVisitor visitor)
      : records_(std::move(records)),
        path_(path),
        visitor_(std::move(visitor)) {}

  // That the current record is of this kind.
  [[nodiscard]] absl::Status Expect(proto::SerializedData::DataCase kind,
                                    const char* name) const;
  [[nodiscard]] absl::Status ReadPoseGraph();
  [[nodiscard]] absl::Status ReadOptions();
  [[nodiscard]] absl::Status ReadOther();
  [[nodiscard]] absl::Status ReadSubmap(const proto::Submap& stored);
  [[nodiscard]] absl::Status AddSubmap(const SubmapId& id,
                                       const SubmapSummary& summary);
  [[nodiscard]] absl::Status ReadNode(const proto::Node& stored);
  [[nodiscard]] absl::Status ReadOdometry(const proto::OdometryData& stored);

  StateReader records_;
  std::string path_;
  MapVisitor visitor_;
  int num_records_ = 0;  // without the header
  MapState state_;
  proto::PoseGraph stored_pose_graph_;
  Attitudes attitudes_;
  std::optional<NodeOdometry> odometry_;  // from the pose graph on
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_MAP_READER_H_
