// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Rigid motions of space, which Cartographer stores even for 2D maps, and their
// conversion to the plane and back. Names as in rigid2.h.

#ifndef CARTOGRAPHER_SDF_GEOMETRY_RIGID3_H_
#define CARTOGRAPHER_SDF_GEOMETRY_RIGID3_H_

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "cartographer_sdf/geometry/rigid2.h"

namespace cartographer_sdf {

struct Rigid3 {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  // Has unit norm.
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

  [[nodiscard]] static Rigid3 Rotation(const Eigen::Quaterniond& rotation) {
    return Rigid3{Eigen::Vector3d::Zero(), rotation};
  }
  [[nodiscard]] Rigid3 Inverse() const;
};

[[nodiscard]] Rigid3 operator*(const Rigid3& T_a_b, const Rigid3& T_b_c);

// Drops z, roll and pitch; the yaw is that of the image of the x axis, as in
// the host's Project2D.
[[nodiscard]] Rigid2 Project2D(const Rigid3& pose);
[[nodiscard]] Rigid3 Embed3D(const Rigid2& pose);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_GEOMETRY_RIGID3_H_
