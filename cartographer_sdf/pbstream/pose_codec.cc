// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/pose_codec.h"

#include <cmath>

#include "absl/status/status.h"

namespace cartographer_sdf {

absl::StatusOr<Eigen::Quaterniond> FromProto(
    const proto::Quaterniond& rotation) {
  const Eigen::Quaterniond quaternion(rotation.w(), rotation.x(), rotation.y(),
                                      rotation.z());
  if (!std::isnormal(quaternion.squaredNorm())) {
    return absl::DataLossError("has a rotation that is not a quaternion");
  }
  return quaternion.normalized();
}

absl::StatusOr<Rigid3> FromProto(const proto::Rigid3d& pose) {
  const Eigen::Vector3d translation(
      pose.translation().x(), pose.translation().y(), pose.translation().z());
  // Written so that NaN fails.
  if (!(translation.array().abs() <= kMaxCoordinate).all()) {
    return absl::DataLossError("has a translation that is not finite");
  }
  if (!pose.has_rotation()) return absl::DataLossError("has no rotation");
  const absl::StatusOr<Eigen::Quaterniond> rotation =
      FromProto(pose.rotation());
  if (!rotation.ok()) return rotation.status();
  return Rigid3{translation, *rotation};
}

proto::Quaterniond ToProto(const Eigen::Quaterniond& rotation) {
  proto::Quaterniond result;
  result.set_x(rotation.x());
  result.set_y(rotation.y());
  result.set_z(rotation.z());
  result.set_w(rotation.w());
  return result;
}

proto::Rigid3d ToProto(const Rigid3& pose) {
  proto::Rigid3d result;
  result.mutable_translation()->set_x(pose.translation.x());
  result.mutable_translation()->set_y(pose.translation.y());
  result.mutable_translation()->set_z(pose.translation.z());
  *result.mutable_rotation() = ToProto(pose.rotation);
  return result;
}

}  // namespace cartographer_sdf
