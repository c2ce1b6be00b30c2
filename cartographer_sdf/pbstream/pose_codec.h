// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Converts poses from and to the file format. The message of an error is a
// predicate ("has no rotation"), to which callers prepend a subject.

#ifndef CARTOGRAPHER_SDF_PBSTREAM_POSE_CODEC_H_
#define CARTOGRAPHER_SDF_PBSTREAM_POSE_CODEC_H_

#include <Eigen/Geometry>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "cartographer_sdf/geometry/rigid3.h"
#include "cartographer_sdf/serialized_state.pb.h"

namespace cartographer_sdf {

// Bound on translations and grid corners [m]: beyond any robot, and small
// enough that products of poses stay finite.
constexpr double kMaxCoordinate = 1e9;

// Returns a name for error messages, such as "submap 0,3".
template <typename IdType>
[[nodiscard]] std::string Name(const char* const kind, const IdType& id) {
  return absl::StrCat(kind, " ", id.trajectory, ",", id.index);
}
[[nodiscard]] inline std::string Name(const char* const kind,
                                      const std::string& id) {
  return absl::StrCat(kind, " ", id);
}

// Normalises the quaternion. Fails unless its norm is positive and finite.
[[nodiscard]] absl::StatusOr<Eigen::Quaterniond> FromProto(
    const proto::Quaterniond& rotation);
// A translation may be absent, which protocol buffers read as zero; a rotation
// may not, because its default value is not a rotation.
[[nodiscard]] absl::StatusOr<Rigid3> FromProto(const proto::Rigid3d& pose);

[[nodiscard]] proto::Quaterniond ToProto(const Eigen::Quaterniond& rotation);
[[nodiscard]] proto::Rigid3d ToProto(const Rigid3& pose);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_POSE_CODEC_H_
