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

// A trajectory's new number and where it belongs, see PathToTrajectory.
struct NewNumber {
  std::vector<int> path;
  int number;
};

bool IsLeaf(const NewNumber& target, const size_t depth) {
  return depth + 1 == target.path.size();
}

// Whether the field is path[depth]. One of another type is unknown to every
// reader.
bool IsOnPath(const UnknownField& field, const NewNumber& target,
              const size_t depth) {
  return field.number() == target.path[depth] &&
         field.type() == (IsLeaf(target, depth)
                              ? UnknownField::TYPE_VARINT
                              : UnknownField::TYPE_LENGTH_DELIMITED);
}

bool HasPath(const UnknownFieldSet& message, const NewNumber& target,
             const size_t depth) {
  for (int i = 0; i < message.field_count(); ++i) {
    if (IsOnPath(message.field(i), target, depth)) return true;
  }
  return false;
}

void CopyWithNumber(const UnknownFieldSet& message, const NewNumber& target,
                    size_t depth, UnknownFieldSet* result);

// Adds a copy of a message as path[depth].
void AddWithNumber(const UnknownFieldSet& message, const NewNumber& target,
                   const size_t depth, UnknownFieldSet* const result) {
  UnknownFieldSet copy;
  CopyWithNumber(message, target, depth + 1, &copy);
  CHECK(copy.SerializeToString(result->AddLengthDelimited(target.path[depth])));
}

void AddNumber(const NewNumber& target, const size_t depth,
               UnknownFieldSet* const result) {
  if (IsLeaf(target, depth)) {
    result->AddVarint(target.path[depth], static_cast<uint64_t>(target.number));
  } else {
    AddWithNumber(UnknownFieldSet(), target, depth, result);
  }
}

// Copies the bare fields of a message, in order, with the number at
// path[depth...] set. A message within that occurs twice is one message in two
// parts, of which the later one counts: both are set.
void CopyWithNumber(const UnknownFieldSet& message, const NewNumber& target,
                    const size_t depth, UnknownFieldSet* const result) {
  // A number that is zero is absent; it belongs at the beginning.
  if (!HasPath(message, target, depth)) AddNumber(target, depth, result);
  bool is_set = false;
  for (int i = 0; i < message.field_count(); ++i) {
    const UnknownField& field = message.field(i);
    if (!IsOnPath(field, target, depth)) {
      result->AddField(field);
    } else if (!IsLeaf(target, depth)) {
      UnknownFieldSet inner;
      CHECK(inner.ParseFromString(field.length_delimited()));
      AddWithNumber(inner, target, depth, result);
    } else if (!is_set) {
      AddNumber(target, depth, result);
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
  CopyWithNumber(fields, {PathToTrajectory(data.data_case()), trajectory}, 0,
                 &copy);
  std::string result;
  CHECK(copy.SerializeToString(&result));
  return result;
}

}  // namespace cartographer_sdf
