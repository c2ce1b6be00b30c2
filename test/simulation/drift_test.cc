// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/drift.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_sdf::drift_test {
namespace {

DriftOptions NoDrift() {
  DriftOptions options;
  options.odometry_scale_error = 0.;
  options.odometry_yaw_bias = 0.;
  options.odometry_yaw_noise = 0.;
  options.local_slam_noise_translation = 0.;
  options.local_slam_noise_rotation = 0.;
  return options;
}

// A straight drive of `num_steps` times 0.05 m from (3, 4) at 0.5 rad.
std::vector<DrivenPose> StraightDrive(const int num_steps) {
  std::vector<DrivenPose> drive;
  for (int k = 0; k <= num_steps; ++k) {
    drive.push_back({0.1 * k, Rigid2(3., 4., 0.5) * Rigid2(0.05 * k, 0., 0.)});
  }
  return drive;
}

TEST(DriftTest, WithoutErrorsOnlyTheFrameChanges) {
  std::vector<DrivenPose> drive;
  for (int k = 0; k != 100; ++k) {
    drive.push_back({0.1 * k, Rigid2(std::sin(0.1 * k), 0.2 * k, 0.3 * k)});
  }
  RandomNumbers random(42);
  const std::vector<DriftedPose> drifted = AddDrift(drive, NoDrift(), &random);
  ASSERT_EQ(drifted.size(), drive.size());
  for (size_t k = 0; k != drive.size(); ++k) {
    const Rigid2 T_start_robot =
        drive[0].T_world_robot.Inverse() * drive[k].T_world_robot;
    for (const Rigid2& T :
         {drifted[k].T_odometry_robot, drifted[k].T_local_robot}) {
      const Rigid2 error = T_start_robot.Inverse() * T;
      EXPECT_NEAR(error.translation().norm(), 0., 1e-9);
      EXPECT_NEAR(error.rotation(), 0., 1e-9);
    }
  }
}

TEST(DriftTest, ScaleErrorLengthensOrShortensTheWay) {
  DriftOptions options = NoDrift();
  options.odometry_scale_error = 0.01;
  options.local_slam_fraction = 0.25;
  int num_longer = 0;
  for (uint32_t seed = 0; seed != 20; ++seed) {
    RandomNumbers random(seed);
    const DriftedPose end =
        AddDrift(StraightDrive(2000), options, &random).back();
    const double error = end.T_odometry_robot.translation().x() - 100.;
    EXPECT_NEAR(std::abs(error), 1., 1e-6);
    EXPECT_NEAR(end.T_local_robot.translation().x() - 100., 0.25 * error, 1e-6);
    num_longer += error > 0.;
  }
  EXPECT_GE(num_longer, 4);
  EXPECT_LE(num_longer, 16);
}

TEST(DriftTest, YawBiasBendsTheWay) {
  DriftOptions options = NoDrift();
  options.odometry_yaw_bias = 2e-3;
  options.local_slam_fraction = 0.5;
  RandomNumbers random(42);
  const DriftedPose end =
      AddDrift(StraightDrive(2000), options, &random).back();
  EXPECT_NEAR(std::abs(end.T_odometry_robot.rotation()), 0.2, 1e-9);
  EXPECT_NEAR(end.T_local_robot.rotation(),
              0.5 * end.T_odometry_robot.rotation(), 1e-9);
  // A circular arc of 100 m and 0.1 rad; steps of 0.05 m are chords of it.
  const double yaw = end.T_local_robot.rotation();
  EXPECT_NEAR(end.T_local_robot.translation().x(), 100. / yaw * std::sin(yaw),
              1e-2);
  EXPECT_NEAR(end.T_local_robot.translation().y(),
              100. / yaw * (1. - std::cos(yaw)), 1e-2);
}

TEST(DriftTest, NoiseHasItsSize) {
  DriftOptions options = NoDrift();
  options.odometry_yaw_noise = 0.01;
  options.local_slam_noise_translation = 0.02;
  options.local_slam_noise_rotation = 0.003;
  options.local_slam_fraction = 0.;
  constexpr int kNumDrives = 400;
  double yaw_squared = 0., x_squared = 0., rotation_squared = 0.;
  for (int seed = 0; seed != kNumDrives; ++seed) {
    RandomNumbers random(seed);
    const DriftedPose end =
        AddDrift(StraightDrive(80), options, &random).back();
    yaw_squared += std::pow(end.T_odometry_robot.rotation(), 2);
    x_squared += std::pow(end.T_local_robot.translation().x() - 4., 2);
    rotation_squared += std::pow(end.T_local_robot.rotation(), 2);
  }
  // Four standard deviations of a standard deviation of 400 samples.
  const double tolerance = 4. / std::sqrt(2. * kNumDrives);
  // After 4 m.
  EXPECT_NEAR(std::sqrt(yaw_squared / kNumDrives) / 0.02, 1., tolerance);
  EXPECT_NEAR(std::sqrt(x_squared / kNumDrives) / 0.02, 1., tolerance);
  EXPECT_NEAR(std::sqrt(rotation_squared / kNumDrives) / 0.003, 1., tolerance);
}

TEST(DriftTest, ValidatesOptions) {
  EXPECT_EQ(Validate(DriftOptions{}), "");
  for (double DriftOptions::*const field :
       {&DriftOptions::odometry_scale_error, &DriftOptions::odometry_yaw_bias,
        &DriftOptions::odometry_yaw_noise, &DriftOptions::local_slam_fraction,
        &DriftOptions::local_slam_noise_translation,
        &DriftOptions::local_slam_noise_rotation}) {
    for (const double invalid : {-2., 2., std::nan("")}) {
      DriftOptions options;
      options.*field = invalid;
      EXPECT_NE(Validate(options), "") << invalid;
    }
  }
}

}  // namespace
}  // namespace cartographer_sdf::drift_test
