// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/trajectory_record.h"

#include <google/protobuf/unknown_field_set.h>

#include <cstdint>
#include <vector>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

using ::google::protobuf::UnknownField;
using ::google::protobuf::UnknownFieldSet;
using Kind = proto::SerializedData::DataCase;

// Numbers of the fields that lead to the trajectory's number: those of
// submaps and nodes are in an id of their own, that of others is the first
// field.
std::vector<int> PathToTrajectory(const Kind kind) {
  if (kind == Kind::kSubmap || kind == Kind::kNode) return {kind, 1, 1};
  return {kind, 1};
}

// Copies the bare fields of a message, in order, with the number at
// path[depth...] set. A message within that occurs twice is one message in two
// parts, of which the later one counts: both are set.
void CopyWithNumber(const UnknownFieldSet& message,
                    const std::vector<int>& path, const size_t depth,
                    const int number, UnknownFieldSet* const result) {
  const bool is_leaf = depth + 1 == path.size();
  // A field of another type is unknown to every reader.
  const auto is_on_path = [&](const UnknownField& field) {
    return field.number() == path[depth] &&
           field.type() == (is_leaf ? UnknownField::TYPE_VARINT
                                    : UnknownField::TYPE_LENGTH_DELIMITED);
  };
  const auto add_message = [&](const UnknownFieldSet& inner) {
    UnknownFieldSet copy;
    CopyWithNumber(inner, path, depth + 1, number, &copy);
    CHECK(copy.SerializeToString(result->AddLengthDelimited(path[depth])));
  };
  const auto add_number = [&] {
    if (is_leaf) {
      result->AddVarint(path[depth], static_cast<uint64_t>(number));
    } else {
      add_message(UnknownFieldSet());
    }
  };
  bool is_present = false;
  for (int i = 0; i < message.field_count(); ++i) {
    is_present |= is_on_path(message.field(i));
  }
  // A number that is zero is absent; it belongs at the beginning.
  if (!is_present) add_number();
  bool is_set = false;
  for (int i = 0; i < message.field_count(); ++i) {
    const UnknownField& field = message.field(i);
    if (!is_on_path(field)) {
      result->AddField(field);
    } else if (!is_leaf) {
      UnknownFieldSet inner;
      CHECK(inner.ParseFromString(field.length_delimited()));
      add_message(inner);
    } else if (!is_set) {
      add_number();
      is_set = true;
    }
  }
}

}  // namespace

std::optional<int> TrajectoryOfRecord(const proto::SerializedData& data) {
  switch (data.data_case()) {
    case Kind::kSubmap:
      return data.submap().submap_id().trajectory_id();
    case Kind::kNode:
      return data.node().node_id().trajectory_id();
    case Kind::kTrajectoryData:
      return data.trajectory_data().trajectory_id();
    case Kind::kImuData:
      return data.imu_data().trajectory_id();
    case Kind::kOdometryData:
      return data.odometry_data().trajectory_id();
    case Kind::kFixedFramePoseData:
      return data.fixed_frame_pose_data().trajectory_id();
    case Kind::kLandmarkData:
      return data.landmark_data().trajectory_id();
    case Kind::kPoseGraph:
    case Kind::kAllTrajectoryBuilderOptions:
    case Kind::DATA_NOT_SET:
      break;
  }
  return std::nullopt;
}

std::string WithTrajectory(const std::string& record,
                           const proto::SerializedData& data,
                           const int trajectory) {
  CHECK(TrajectoryOfRecord(data).has_value());
  CHECK_GE(trajectory, 0);
  UnknownFieldSet fields;
  CHECK(fields.ParseFromString(record));
  UnknownFieldSet copy;
  CopyWithNumber(fields, PathToTrajectory(data.data_case()), 0, trajectory,
                 &copy);
  std::string result;
  CHECK(copy.SerializeToString(&result));
  return result;
}

}  // namespace cartographer_sdf
