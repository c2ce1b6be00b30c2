// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/geometry/rigid3.h"

#include <cmath>

namespace cartographer_sdf {

Rigid3 Rigid3::Inverse() const {
  const Eigen::Quaterniond inverse = rotation.conjugate();
  return Rigid3{-(inverse * translation), inverse};
}

Rigid3 operator*(const Rigid3& T_a_b, const Rigid3& T_b_c) {
  return Rigid3{T_a_b.translation + T_a_b.rotation * T_b_c.translation,
                (T_a_b.rotation * T_b_c.rotation).normalized()};
}

Rigid2 Project2D(const Rigid3& pose) {
  const Eigen::Vector3d x_axis = pose.rotation * Eigen::Vector3d::UnitX();
  return Rigid2(pose.translation.head<2>(), std::atan2(x_axis.y(), x_axis.x()));
}

Rigid3 Embed3D(const Rigid2& pose) {
  return Rigid3{
      Eigen::Vector3d(pose.translation().x(), pose.translation().y(), 0.),
      Eigen::Quaterniond(
          Eigen::AngleAxisd(pose.rotation(), Eigen::Vector3d::UnitZ()))};
}

}  // namespace cartographer_sdf
