// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Registration of a sweep, and what its beams say of a pose.

#include "cartographer_sdf/localization/sweep_registration.h"

#include <cmath>
#include <optional>

#include "cartographer_sdf/geometry/distinct_poses.h"
#include "cartographer_sdf/localization/beam_evidence.h"
#include "cartographer_sdf/localization/ray_map.h"
#include "gtest/gtest.h"
#include "test/testing/drawn_map.h"

namespace cartographer_sdf::sweep_registration_test {
namespace {

class SweepRegistrationTest : public ::testing::Test {
 protected:
  SweepRegistrationTest()
      : map_(*MakeRayMap(testing::TwoRoomsGrid())),
        sweep_(MakeSweep({testing::ScanFrom(testing::TwoRooms(), kTruth)}, 360,
                         30.)) {}
  [[nodiscard]] Rigid2 InGrid(const Rigid2& T_map_robot) const {
    return map_.geometry().T_submap_grid.Inverse() * T_map_robot;
  }
  static const Rigid2 kTruth;
  const RayMap map_;
  const Sweep sweep_;
};
const Rigid2 SweepRegistrationTest::kTruth(4.6, 3.8, -2.5);

TEST_F(SweepRegistrationTest, FindsThePoseNearby) {
  const Rigid2 guess = InGrid(kTruth) * Rigid2(0.2, -0.15, 0.05);
  const std::optional<RegisteredSweep> found =
      RegisterSweep(map_.field, sweep_, kNoLimit, 0.8, guess);
  ASSERT_TRUE(found);
  const Rigid2 error = InGrid(kTruth).Inverse() * found->T_grid_robot;
  EXPECT_LT(error.translation().norm(), 0.06);
  EXPECT_LT(std::abs(error.rotation()), 0.02);
  for (int k = 0; k < 2; ++k) {
    EXPECT_LT(std::sqrt(found->covariance(k, k)), 0.1);
    EXPECT_GT(std::sqrt(found->covariance(k, k)), 0.02);
  }
}

TEST_F(SweepRegistrationTest, NeedsEchoesInTheField) {
  EXPECT_FALSE(RegisterSweep(map_.field, sweep_, kNoLimit, 0.8,
                             Rigid2(1000., 1000., 0.)));
  EXPECT_FALSE(
      RegisterSweep(map_.field, Sweep(), kNoLimit, 0.8, InGrid(kTruth)));
}

TEST_F(SweepRegistrationTest, AtTheRightPoseBeamsEndAtWalls) {
  const BeamEvidence evidence = MeasureBeams(map_, sweep_, InGrid(kTruth));
  EXPECT_GT(evidence.num_beams, 300);
  EXPECT_GT(evidence.at_wall, 0.95);
  EXPECT_GT(evidence.fit, 0.8);
  EXPECT_LT(evidence.wall_distance, 0.08);
  EXPECT_NEAR(evidence.at_wall + evidence.through_wall +
                  evidence.in_free_space + evidence.in_unknown,
              1., 1e-9);
}

TEST_F(SweepRegistrationTest, ElsewhereBeamsCrossWallsAndEndInFreeSpace) {
  // In the corridor, and turned.
  const BeamEvidence evidence =
      MeasureBeams(map_, sweep_, InGrid(Rigid2(8., 6.1, 0.5)));
  EXPECT_LT(evidence.fit, 0.3);
  EXPECT_GT(evidence.through_wall, 0.3);
  const BeamEvidence larger_room = MeasureBeams(
      map_,
      MakeSweep({testing::ScanFrom(testing::BareRoom(2., 2.), Rigid2())}, 360,
                30.),
      InGrid(Rigid2(12., 3.2, 0.)));
  EXPECT_GT(larger_room.in_free_space, 0.5);
}

TEST_F(SweepRegistrationTest, OutsideTheMapNothingIsKnown) {
  const BeamEvidence evidence =
      MeasureBeams(map_, sweep_, Rigid2(-500., -500., 0.));
  EXPECT_EQ(evidence.in_unknown, 1.);
  EXPECT_EQ(evidence.fit, 0.);
}

// It may have met glass: nothing tells that from free space.
TEST_F(SweepRegistrationTest, BeamsWithoutEchoSayNothing) {
  const Rigid2 T_grid_robot = InGrid(Rigid2(3., 2., 0.));
  const BeamEvidence evidence = MeasureBeams(map_, sweep_, T_grid_robot);
  Sweep sweep = sweep_;
  // Through the walls all around.
  for (int k = 0; k < 100; ++k) {
    const Eigen::Rotation2Dd turn(0.06 * k);
    sweep.beams.push_back(
        {sweep.centre, sweep.centre + turn * Eigen::Vector2d(30., 0.), false});
  }
  const BeamEvidence with_silent = MeasureBeams(map_, sweep, T_grid_robot);
  EXPECT_EQ(with_silent.num_beams, evidence.num_beams);
  EXPECT_EQ(with_silent.through_wall, evidence.through_wall);
  EXPECT_EQ(with_silent.fit, evidence.fit);
}

}  // namespace
}  // namespace cartographer_sdf::sweep_registration_test
