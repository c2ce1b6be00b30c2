// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Poses as the file has them. The message of an error is a predicate ("has no
// rotation"), for callers to put a subject before it.

#ifndef CARTOGRAPHER_SDF_PBSTREAM_POSE_CODEC_H_
#define CARTOGRAPHER_SDF_PBSTREAM_POSE_CODEC_H_

#include <Eigen/Geometry>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "cartographer_sdf/geometry/rigid3.h"
#include "cartographer_sdf/serialized_state.pb.h"

namespace cartographer_sdf {

// Of a translation and of a corner of a grid [m]: no robot goes there, and
// products of poses stay finite.
constexpr double kMaxCoordinate = 1e9;

// "submap 0,3", say, for errors.
template <typename IdType>
[[nodiscard]] std::string Name(const char* const kind, const IdType& id) {
  return absl::StrCat(kind, " ", id.trajectory, ",", id.index);
}
[[nodiscard]] inline std::string Name(const char* const kind,
                                      const std::string& id) {
  return absl::StrCat(kind, " ", id);
}

// Normalises. An error unless the norm is a positive finite number.
[[nodiscard]] absl::StatusOr<Eigen::Quaterniond> FromProto(
    const proto::Quaterniond& rotation);
// A translation may be absent, which is zero to protocol buffers; a rotation
// may not, because the default is no rotation.
[[nodiscard]] absl::StatusOr<Rigid3> FromProto(const proto::Rigid3d& pose);

[[nodiscard]] proto::Quaterniond ToProto(const Eigen::Quaterniond& rotation);
[[nodiscard]] proto::Rigid3d ToProto(const Rigid3& pose);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_POSE_CODEC_H_
