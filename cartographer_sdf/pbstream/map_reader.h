// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_PBSTREAM_MAP_READER_H_
#define CARTOGRAPHER_SDF_PBSTREAM_MAP_READER_H_

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/pbstream/node_odometry.h"
#include "cartographer_sdf/pbstream/pose_graph_codec.h"
#include "cartographer_sdf/pbstream/record_stream.h"
#include "cartographer_sdf/serialized_state.pb.h"

namespace cartographer_sdf {

// ReadMap() record by record, with all its checks, for callers that copy the
// records as they pass. The first call of Next() advances to the pose graph,
// the second to the options, later ones to whatever the file has.
class MapReader {
 public:
  // Reads the header. `on_progress` may be empty.
  [[nodiscard]] static absl::StatusOr<MapReader> Open(
      const std::string& path, MapVisitor visitor,
      const ProgressCallback& on_progress,
      OdometryRecords odometry_records = OdometryRecords::kKeep);

  // Advances to the next record and checks it; false at the end of the file. A
  // file that ends before the options is an error. Where odometry is left out,
  // its records are checked and passed over.
  [[nodiscard]] absl::StatusOr<bool> Next();

  // The current record decoded, as bytes, and compressed as in the file.
  // Initially the header.
  [[nodiscard]] const proto::SerializedData& data() const { return data_; }
  [[nodiscard]] const std::string& record() const { return record_; }
  [[nodiscard]] const std::string& compressed() const {
    return records_.compressed();
  }
  [[nodiscard]] absl::Status Corrupted(absl::string_view problem) const {
    return records_.Corrupted(problem);
  }
  [[nodiscard]] int format_version() const { return state_.format_version; }
  // The submaps and nodes whose records have been read so far.
  [[nodiscard]] const RecordedElements& recorded() const { return recorded_; }

  // At the end of the file: an error if submaps or nodes have no record of
  // their own.
  [[nodiscard]] absl::Status CheckIsWhole() const;
  // Returns the result of ReadMap(). Call once, at the end of the file.
  [[nodiscard]] absl::StatusOr<MapState> Finish(MissingRecords missing_records);

 private:
  explicit MapReader(RecordReader records) : records_(std::move(records)) {}

  [[nodiscard]] absl::Status ReadHeader();
  // Next(), without passing over anything.
  [[nodiscard]] absl::StatusOr<bool> ReadRecord();
  // Returns an error unless the current record is of this kind.
  [[nodiscard]] absl::Status Expect(proto::SerializedData::DataCase kind,
                                    const char* name) const;
  [[nodiscard]] absl::Status ReadPoseGraph();
  [[nodiscard]] absl::Status ReadOptions();
  [[nodiscard]] absl::Status ReadOther();
  [[nodiscard]] absl::Status ReadSubmap(const proto::Submap& stored);
  [[nodiscard]] absl::Status ReadNode(const proto::Node& stored);
  [[nodiscard]] absl::Status ReadOdometry(const proto::OdometryData& stored);
  // Returns an error unless the current record is of a trajectory of the map.
  [[nodiscard]] absl::Status CheckTrajectory() const;
  // Returns an error unless these data are later than those of the same kind
  // and trajectory before.
  [[nodiscard]] absl::Status CheckOrder(const proto::SensorData& stored);

  RecordReader records_;
  MapVisitor visitor_;
  ProgressCallback on_progress_;
  std::string record_;
  proto::SerializedData data_;
  int num_records_ = 0;  // without the header
  MapState state_;
  proto::PoseGraph stored_pose_graph_;
  RecordedElements recorded_;
  // Of the last sensor data of each kind and trajectory.
  std::map<std::pair<int, int>, int64_t> last_times_;
  std::optional<NodeOdometry> odometry_;  // set once the pose graph is read
};

// Writes a map while it is read. The pose graph comes first in the file, but
// changing it requires the nodes' gravity alignments, which come later, in the
// nodes' own records, as does what has no record at all. A pose graph returned
// by ReadMap() contains them; they are assumed to match the file and are
// compared with it at its end.
struct WrittenMap {
  RecordWriter file;  // complete, not yet committed
  // What was found in the file.
  RecordedElements recorded;
};
using AssumingWriter =
    std::function<absl::StatusOr<WrittenMap>(const RecordedElements& assumed)>;

// Calls `write` with the elements and gravity alignments of `pose_graph`, and
// once more with those of the file if they differ: where `pose_graph` lacks
// submaps or nodes, has some without a record of their own, or other gravity
// alignments. Fails as `write` does, or if the host would not load the result.
[[nodiscard]] absl::StatusOr<RecordWriter> WriteAssuming(
    const PoseGraph& pose_graph, const AssumingWriter& write);

// Reads what was written, which is complete but not committed, with all checks
// of ReadMap(), scans included. An error says that `output` cannot be written.
[[nodiscard]] absl::Status CheckLoads(const RecordWriter& output);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_MAP_READER_H_
