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

// Sets the number at path[depth...] of a message's raw fields, each of which
// keeps its place. A nested message that occurs twice is one message in two
// parts, of which the later one counts: both are set. A field of another type
// is unknown to every reader.
void SetNumber(const std::vector<int>& path, const size_t depth,
               const int number, UnknownFieldSet* const message) {
  const bool is_leaf = depth + 1 == path.size();
  const auto set = [&](UnknownField* const field) {
    if (is_leaf) return field->set_varint(static_cast<uint64_t>(number));
    UnknownFieldSet inner;
    CHECK(inner.ParseFromString(field->length_delimited()));
    SetNumber(path, depth + 1, number, &inner);
    CHECK(inner.SerializeToString(field->mutable_length_delimited()));
  };
  bool is_set = false;
  for (int i = 0; i < message->field_count(); ++i) {
    UnknownField* const field = message->mutable_field(i);
    if (field->number() != path[depth] ||
        field->type() != (is_leaf ? UnknownField::TYPE_VARINT
                                  : UnknownField::TYPE_LENGTH_DELIMITED)) {
      continue;
    }
    set(field);
    is_set = true;
  }
  if (is_set) return;
  // A zero is not stored; the field belongs at the beginning.
  UnknownFieldSet with_number;
  if (is_leaf) {
    with_number.AddVarint(path[depth], 0);
  } else {
    with_number.AddLengthDelimited(path[depth]);
  }
  set(with_number.mutable_field(0));
  with_number.MergeFrom(*message);
  message->Swap(&with_number);
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
  const Kind kind = data.data_case();
  // Submaps and nodes store it in a nested id.
  const std::vector<int> path = kind == Kind::kSubmap || kind == Kind::kNode
                                    ? std::vector<int>{kind, 1, 1}
                                    : std::vector<int>{kind, 1};
  SetNumber(path, 0, trajectory, &fields);
  std::string result;
  CHECK(fields.SerializeToString(&result));
  return result;
}

}  // namespace cartographer_sdf
