// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/geometry/rigid2.h"

#include <cmath>
#include <random>
#include <sstream>

#include "gtest/gtest.h"
#include "test/testing/random_number.h"

namespace cartographer_sdf::rigid2_test {
namespace {

using testing::Uniform;

// Rounding of coordinates of some 10 m.
constexpr double kExact = 1e-13;

Rigid2 RandomPose(std::mt19937* const engine) {
  const double x = Uniform(-10., 10., engine);
  const double y = Uniform(-10., 10., engine);
  return Rigid2(x, y, Uniform(-7., 7., engine));
}

Eigen::Matrix3d HomogeneousMatrix(const Rigid2& pose) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  matrix.topLeftCorner<2, 2>() = pose.RotationMatrix();
  matrix.topRightCorner<2, 1>() = pose.translation();
  return matrix;
}

TEST(NormalizeAngleTest, LiesInTheHalfOpenInterval) {
  EXPECT_EQ(NormalizeAngle(0.), 0.);
  EXPECT_EQ(NormalizeAngle(M_PI), M_PI);
  EXPECT_EQ(NormalizeAngle(-M_PI), M_PI);
  EXPECT_EQ(NormalizeAngle(2. * M_PI), 0.);
  const double below_pi = std::nextafter(M_PI, 0.);
  EXPECT_EQ(NormalizeAngle(below_pi), below_pi);
  EXPECT_EQ(NormalizeAngle(-below_pi), -below_pi);
  EXPECT_LT(NormalizeAngle(std::nextafter(M_PI, 4.)), 0.);
  EXPECT_NEAR(NormalizeAngle(3. * M_PI + 0.1), -M_PI + 0.1, kExact);
  EXPECT_NEAR(NormalizeAngle(-3. * M_PI - 0.1), M_PI - 0.1, kExact);
}

TEST(NormalizeAngleTest, KeepsTheDirectionOfAnyAngle) {
  for (int k = -2000; k <= 2000; ++k) {
    const double angle = 0.01 * k;
    const double normalized = NormalizeAngle(angle);
    EXPECT_GT(normalized, -M_PI);
    EXPECT_LE(normalized, M_PI);
    EXPECT_NEAR(std::cos(normalized), std::cos(angle), kExact);
    EXPECT_NEAR(std::sin(normalized), std::sin(angle), kExact);
  }
}

TEST(Rigid2Test, TurnsCounterclockwiseThenShifts) {
  const Eigen::Vector2d p = Rigid2(10., 20., M_PI_2) * Eigen::Vector2d(1., 2.);
  EXPECT_NEAR(p.x(), 8., kExact);
  EXPECT_NEAR(p.y(), 21., kExact);
  EXPECT_EQ(Rigid2() * Eigen::Vector2d(3., 4.), Eigen::Vector2d(3., 4.));
}

TEST(Rigid2Test, ComposesAndInvertsAsMatricesDo) {
  std::mt19937 engine(42);
  for (int k = 0; k < 1000; ++k) {
    const Rigid2 T_a_b = RandomPose(&engine), T_b_c = RandomPose(&engine);
    const Rigid2 T_a_c = T_a_b * T_b_c;
    EXPECT_LE(std::abs(T_a_c.rotation()), M_PI);
    EXPECT_TRUE(HomogeneousMatrix(T_a_c).isApprox(
        HomogeneousMatrix(T_a_b) * HomogeneousMatrix(T_b_c), kExact));
    EXPECT_TRUE(HomogeneousMatrix(T_a_b.Inverse())
                    .isApprox(HomogeneousMatrix(T_a_b).inverse(), kExact));
    const Eigen::Vector2d p_c(1., -2.);
    EXPECT_LT((T_a_c * p_c - T_a_b * (T_b_c * p_c)).norm(), kExact);
  }
}

TEST(Rigid2Test, HalfTurnsMeetAtPi) {
  EXPECT_EQ(Rigid2(0., 0., -M_PI).rotation(), M_PI);
  EXPECT_EQ(Rigid2(0., 0., M_PI).Inverse().rotation(), M_PI);
  EXPECT_EQ((Rigid2(0., 0., M_PI_2) * Rigid2(0., 0., M_PI_2)).rotation(), M_PI);
  EXPECT_EQ((Rigid2(0., 0., -M_PI_2) * Rigid2(0., 0., -M_PI_2)).rotation(),
            M_PI);
  EXPECT_EQ((Rigid2(0., 0., M_PI) * Rigid2(0., 0., M_PI)).rotation(), 0.);
}

TEST(Rigid2Test, PrintsItsUnits) {
  std::ostringstream out;
  out << Rigid2(1., -2.5, 0.5);
  EXPECT_EQ(out.str(), "[1 m, -2.5 m, 0.5 rad]");
}

}  // namespace
}  // namespace cartographer_sdf::rigid2_test
