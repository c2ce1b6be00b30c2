// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/geometry/rigid3.h"

#include <cmath>
#include <random>

#include "gtest/gtest.h"
#include "test/testing/random_number.h"

namespace cartographer_sdf::rigid3_test {
namespace {

using testing::Uniform;

constexpr double kExact = 1e-13;

Rigid3 RandomPose(std::mt19937* const engine) {
  Rigid3 pose;
  for (double& value : pose.translation) value = Uniform(-10., 10., engine);
  for (double& value : pose.rotation.coeffs()) {
    value = Uniform(-1., 1., engine);
  }
  pose.rotation.normalize();
  return pose;
}

Eigen::Isometry3d ToIsometry(const Rigid3& pose) {
  return Eigen::Translation3d(pose.translation) * pose.rotation;
}

Eigen::Quaterniond RollPitchYaw(const double roll, const double pitch,
                                const double yaw) {
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
}

TEST(Rigid3Test, ComposesAndInvertsAsEigenDoes) {
  std::mt19937 engine(42);
  for (int k = 0; k < 1000; ++k) {
    const Rigid3 T_a_b = RandomPose(&engine), T_b_c = RandomPose(&engine);
    EXPECT_TRUE(ToIsometry(T_a_b * T_b_c)
                    .isApprox(ToIsometry(T_a_b) * ToIsometry(T_b_c), kExact));
    EXPECT_TRUE(ToIsometry(T_a_b.Inverse())
                    .isApprox(ToIsometry(T_a_b).inverse(), kExact));
  }
}

TEST(Rigid3Test, StaysOfUnitNormOverManyProducts) {
  const Rigid3 step{{0.1, 0., 0.}, RollPitchYaw(0.01, 0.02, 0.03)};
  Rigid3 pose;
  for (int k = 0; k < 100000; ++k) pose = pose * step;
  EXPECT_NEAR(pose.rotation.norm(), 1., kExact);
}

TEST(Project2DTest, InvertsEmbed3D) {
  for (int k = -314; k <= 314; ++k) {
    const Rigid2 pose(1.5, -2.5, 0.01 * k);
    const Rigid2 back = Project2D(Embed3D(pose));
    EXPECT_EQ(back.translation(), pose.translation());
    EXPECT_NEAR(back.rotation(), pose.rotation(), kExact);
  }
  EXPECT_NEAR(std::abs(Project2D(Embed3D(Rigid2(0., 0., M_PI))).rotation()),
              M_PI, kExact);
}

TEST(Embed3DTest, IsAHomomorphism) {
  const Rigid2 a(1., 2., 3.), b(-4., 0.5, -2.);
  EXPECT_TRUE(ToIsometry(Embed3D(a) * Embed3D(b))
                  .isApprox(ToIsometry(Embed3D(a * b)), kExact));
  EXPECT_EQ(Embed3D(a).translation.z(), 0.);
}

TEST(Project2DTest, DropsHeightRollAndPitch) {
  for (const double roll : {-0.5, 0., 1.2}) {
    for (const double pitch : {-0.7, 0., 0.4}) {
      for (const double yaw : {-3., -1., 0., 2.}) {
        const Rigid2 pose =
            Project2D(Rigid3{{1., 2., 3.}, RollPitchYaw(roll, pitch, yaw)});
        EXPECT_EQ(pose.translation(), Eigen::Vector2d(1., 2.));
        EXPECT_NEAR(pose.rotation(), yaw, kExact);
      }
    }
  }
}

// A node's pose is aligned with gravity before it is projected: turning by
// roll and pitch alone, then by the node's yaw, changes nothing in the plane.
TEST(Project2DTest, GravityAlignmentKeepsTheYaw) {
  const Rigid3 T_map_aligned = Embed3D(Rigid2(1., 2., 0.7));
  const Rigid3 R_aligned_tracking =
      Rigid3::Rotation(RollPitchYaw(0.1, -0.2, 0.));
  const Rigid2 pose = Project2D(T_map_aligned * R_aligned_tracking);
  EXPECT_NEAR(pose.rotation(), 0.7, kExact);
  const Rigid3 back =
      (T_map_aligned * R_aligned_tracking) * R_aligned_tracking.Inverse();
  EXPECT_TRUE(ToIsometry(back).isApprox(ToIsometry(T_map_aligned), kExact));
}

}  // namespace
}  // namespace cartographer_sdf::rigid3_test
