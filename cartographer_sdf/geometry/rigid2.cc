// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/geometry/rigid2.h"

#include <cmath>

namespace cartographer_sdf {

double NormalizeAngle(const double angle) {
  const double wrapped = std::remainder(angle, 2. * M_PI);
  return wrapped <= -M_PI ? M_PI : wrapped;
}

Rigid2 Rigid2::Inverse() const {
  return Rigid2(Eigen::Rotation2Dd(-rotation_) * (-translation_), -rotation_);
}

Rigid2 operator*(const Rigid2& T_a_b, const Rigid2& T_b_c) {
  return Rigid2(T_a_b * T_b_c.translation(),
                T_a_b.rotation() + T_b_c.rotation());
}

Eigen::Vector2d operator*(const Rigid2& T_a_b, const Eigen::Vector2d& p_b) {
  return T_a_b.translation() + Eigen::Rotation2Dd(T_a_b.rotation()) * p_b;
}

std::ostream& operator<<(std::ostream& out, const Rigid2& pose) {
  return out << "[" << pose.translation().x() << " m, "
             << pose.translation().y() << " m, " << pose.rotation() << " rad]";
}

}  // namespace cartographer_sdf
