// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Rigid motions of the plane, in metres and radians. `T_a_b` maps the
// coordinates of a point in frame b to its coordinates in frame a:
// p_a = T_a_b * p_b, and T_a_c = T_a_b * T_b_c.

#ifndef CARTOGRAPHER_SDF_GEOMETRY_RIGID2_H_
#define CARTOGRAPHER_SDF_GEOMETRY_RIGID2_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <ostream>

namespace cartographer_sdf {

// Returns the equivalent angle in (-pi, pi].
[[nodiscard]] double NormalizeAngle(double angle);

class Rigid2 {
 public:
  // The identity.
  Rigid2() = default;
  Rigid2(const Eigen::Vector2d& translation, double rotation)
      : translation_(translation), rotation_(NormalizeAngle(rotation)) {}
  Rigid2(double x, double y, double rotation)
      : Rigid2(Eigen::Vector2d(x, y), rotation) {}

  [[nodiscard]] const Eigen::Vector2d& translation() const {
    return translation_;
  }
  // In (-pi, pi].
  [[nodiscard]] double rotation() const { return rotation_; }
  [[nodiscard]] Eigen::Matrix2d RotationMatrix() const {
    return Eigen::Rotation2Dd(rotation_).toRotationMatrix();
  }
  [[nodiscard]] Rigid2 Inverse() const;

 private:
  Eigen::Vector2d translation_ = Eigen::Vector2d::Zero();
  double rotation_ = 0.;
};

[[nodiscard]] Rigid2 operator*(const Rigid2& T_a_b, const Rigid2& T_b_c);
[[nodiscard]] Eigen::Vector2d operator*(const Rigid2& T_a_b,
                                        const Eigen::Vector2d& p_b);
std::ostream& operator<<(std::ostream& out, const Rigid2& pose);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_GEOMETRY_RIGID2_H_
