// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/drive.h"

#include <algorithm>
#include <cmath>

#include "cartographer_sdf/simulation/office.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::drive_test {
namespace {

using Eigen::Array2i;

double Clearance(const FloorPlan& plan, const Eigen::Vector2d& p_world,
                 const double window) {
  const int reach = static_cast<int>(window / plan.geometry.resolution) + 1;
  const Array2i centre = plan.geometry.CellAt(p_world);
  double nearest = window;
  for (int j = -reach; j <= reach; ++j) {
    for (int i = -reach; i <= reach; ++i) {
      const Array2i cell = centre + Array2i(i, j);
      if (plan.geometry.Contains(cell) && !plan.occupied(cell.x(), cell.y())) {
        continue;
      }
      nearest =
          std::min(nearest, (plan.geometry.CellCentre(cell) - p_world).norm());
    }
  }
  return nearest;
}

TEST(DriveTest, KeepsClearanceSpeedAndLength) {
  const DriveOptions options;
  for (uint32_t seed = 1; seed != 6; ++seed) {
    const FloorPlan plan = MakeOffice({}, seed);
    const absl::StatusOr<std::vector<DrivenPose>> drive =
        Drive(plan, options, seed + 10);
    ASSERT_TRUE(drive.ok()) << drive.status();
    double length = 0.;
    double clearance = 1.;
    for (size_t k = 1; k != drive->size(); ++k) {
      const Rigid2 T_previous_robot =
          (*drive)[k - 1].T_world_robot.Inverse() * (*drive)[k].T_world_robot;
      EXPECT_NEAR((*drive)[k].seconds - (*drive)[k - 1].seconds, 0.05, 1e-9);
      const double advance = T_previous_robot.translation().norm();
      length += advance;
      ASSERT_LE(advance, 0.5 * 0.05 + 1e-9);
      ASSERT_LE(std::abs(T_previous_robot.rotation()), 0.8 * 0.05 + 1e-9);
      if (k % 10 == 0) {
        clearance = std::min(
            clearance,
            Clearance(plan, (*drive)[k].T_world_robot.translation(), 0.6));
      }
    }
    EXPECT_NEAR(length, options.length, 0.05);
    // The declared 0.1 m of cut corners, and never far from the planned 0.4 m
    // in doors of 1.1 m.
    EXPECT_GE(clearance, options.clearance - 0.1) << seed;
    EXPECT_LE(clearance, 0.56) << seed;
  }
}

// Fractions of the poses to which the robot came back more than a minute apart
// with about the same, and with about the opposite heading.
struct Revisits {
  double any = 0., same = 0., opposite = 0.;
};

Revisits CountRevisits(const std::vector<DrivenPose>& drive) {
  constexpr size_t kStride = 20;    // A second.
  constexpr double kNear = 1.5;     // [m]
  constexpr double kApart = 60.;    // [s]
  constexpr double kAligned = 0.8;  // Cosine of the difference in heading.
  double num = 0.;
  Revisits revisits;
  for (size_t a = 0; a < drive.size(); a += kStride) {
    bool same = false, opposite = false, any = false;
    for (size_t b = 0; b < drive.size(); b += kStride) {
      const Rigid2 T_a_b =
          drive[a].T_world_robot.Inverse() * drive[b].T_world_robot;
      if (std::abs(drive[a].seconds - drive[b].seconds) < kApart ||
          T_a_b.translation().norm() > kNear) {
        continue;
      }
      any = true;
      same |= std::cos(T_a_b.rotation()) > kAligned;
      opposite |= std::cos(T_a_b.rotation()) < -kAligned;
    }
    num += 1.;
    revisits.any += any;
    revisits.same += same;
    revisits.opposite += opposite;
  }
  return {revisits.any / num, revisits.same / num, revisits.opposite / num};
}

TEST(DriveTest, ReturnsInBothDirections) {
  for (uint32_t seed = 1; seed != 6; ++seed) {
    const absl::StatusOr<std::vector<DrivenPose>> drive =
        Drive(MakeOffice({}, seed), {}, seed);
    ASSERT_TRUE(drive.ok()) << drive.status();
    const Revisits revisits = CountRevisits(*drive);
    EXPECT_GT(revisits.any, 0.85) << seed;
    EXPECT_GT(revisits.same, 0.3) << seed;
    EXPECT_GT(revisits.opposite, 0.3) << seed;
  }
}

TEST(DriveTest, SameSeedSameDriveOtherSeedOther) {
  const FloorPlan plan = MakeOffice({}, 42);
  const std::vector<DrivenPose> drive = *Drive(plan, {}, 1);
  const std::vector<DrivenPose> again = *Drive(plan, {}, 1);
  const std::vector<DrivenPose> other = *Drive(plan, {}, 2);
  ASSERT_EQ(drive.size(), again.size());
  double largest = 0.;
  for (size_t k = 0; k != drive.size(); ++k) {
    EXPECT_EQ(drive[k].T_world_robot.translation(),
              again[k].T_world_robot.translation());
    EXPECT_EQ(drive[k].T_world_robot.rotation(),
              again[k].T_world_robot.rotation());
    if (k < other.size()) {
      largest = std::max(largest, (drive[k].T_world_robot.translation() -
                                   other[k].T_world_robot.translation())
                                      .norm());
    }
  }
  EXPECT_GT(largest, 5.);
}

TEST(DriveTest, GoesBackAndForthInASmallRoom) {
  DriveOptions options;
  options.length = 50.;
  const absl::StatusOr<std::vector<DrivenPose>> drive =
      Drive(EmptyFloorPlan({4., 4.}, 0.05), options, 42);
  ASSERT_TRUE(drive.ok()) << drive.status();
  for (const DrivenPose& pose : *drive) {
    const Eigen::Array2d p = pose.T_world_robot.translation().array();
    ASSERT_TRUE((p > 0.3).all() && (p < 3.7).all());
  }
}

TEST(DriveTest, RefusesPlansWithoutRoom) {
  FloorPlan wall = EmptyFloorPlan({10., 10.}, 0.1);
  FillRectangle({5., 5.}, {11., 11.}, 0., true, &wall);
  EXPECT_FALSE(Drive(wall, {}, 1).ok());
  const absl::StatusOr<std::vector<DrivenPose>> drive =
      Drive(EmptyFloorPlan({0.6, 100.}, 0.1), {}, 1);
  EXPECT_THAT(std::string(drive.status().message()),
              ::testing::HasSubstr("no connected free area"));
}

TEST(DriveTest, ValidatesOptions) {
  EXPECT_EQ(Validate(DriveOptions{}), "");
  for (double DriveOptions::*const field :
       {&DriveOptions::length, &DriveOptions::clearance, &DriveOptions::speed,
        &DriveOptions::turn_rate, &DriveOptions::time_step}) {
    for (const double invalid : {0., -1., 1e9, std::nan("")}) {
      DriveOptions options;
      options.*field = invalid;
      EXPECT_NE(Validate(options), "") << invalid;
    }
  }
}

}  // namespace
}  // namespace cartographer_sdf::drive_test
