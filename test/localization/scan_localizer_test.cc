// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/scan_localizer.h"

#include <cmath>
#include <optional>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/drawn_map.h"

namespace cartographer_sdf::scan_localizer_test {
namespace {

using ::testing::AnyOf;
using testing::Building;
using ::testing::DoubleNear;
using ::testing::HasSubstr;
using testing::ScanFrom;
using testing::Wall;

PanoramaMap MapOf(const OccupancyGrid& grid) {
  std::optional<PanoramaMap> map = MakePanoramaMap({}, grid, {});
  CHECK(map.has_value());
  return *std::move(map);
}

double SumOfProbabilities(const ScanLocalization& result) {
  double sum = result.elsewhere_probability.value();
  for (const ScanCandidate& candidate : result.candidates) {
    sum += candidate.probability;
  }
  return sum;
}

bool IsNear(const Rigid2& pose, const Rigid2& truth, const double meters,
            const double radians) {
  return (pose.translation() - truth.translation()).norm() < meters &&
         std::abs(NormalizeAngle(pose.rotation() - truth.rotation())) < radians;
}

// A building that has nothing in common with the two rooms.
Building StrangeBuilding() {
  return {Wall({0., 0.}, {3., 0.}),
          Wall({3., 0.}, {5.5, 2.}),
          Wall({5.5, 2.}, {5., 6.}),
          Wall({5., 6.}, {1., 7.5}),
          Wall({1., 7.5}, {-2., 5.}),
          Wall({-2., 5.}, {-1., 2.}),
          Wall({-1., 2.}, {0., 0.}),
          testing::Furniture(2., 5., 0.8, 0.8, 0.5),
          testing::Furniture(3.5, 2.5, 1.4, 0.4, 1.2)};
}

class ScanLocalizerTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    two_rooms_ = new PanoramaMap(MapOf(testing::TwoRoomsGrid()));
  }
  static void TearDownTestSuite() { delete two_rooms_; }
  static ScanLocalization Locate(const std::vector<RobotScan>& scans) {
    return LocalizeScans({}, *two_rooms_, scans);
  }
  static PanoramaMap* two_rooms_;
};
PanoramaMap* ScanLocalizerTest::two_rooms_;

TEST_F(ScanLocalizerTest, FindsTheRightPose) {
  for (const Rigid2& truth :
       {Rigid2(2., 1.7, 0.3), Rigid2(4.6, 3.8, -2.5), Rigid2(12.2, 3.1, 1.),
        Rigid2(10.9, 0.7, 3.), Rigid2(13.9, 1.4, -0.7)}) {
    const ScanLocalization result =
        Locate({ScanFrom(testing::TwoRooms(), truth)});
    ASSERT_EQ(result.verdict, LocalizationVerdict::kLocalized)
        << truth << result.reason;
    EXPECT_GE(result.candidates.front().probability, 0.99);
    EXPECT_TRUE(
        IsNear(result.candidates.front().T_map_robot, truth, 0.06, 0.02))
        << result.candidates.front().T_map_robot << " is not " << truth;
    EXPECT_THAT(SumOfProbabilities(result), DoubleNear(1., 1e-9));
  }
}

TEST_F(ScanLocalizerTest, AHalfTurnOfFieldOfViewStillFindsTheRightPose) {
  const Rigid2 truth(12.2, 3.1, 1.);
  const ScanLocalization result =
      Locate({testing::Narrowed(ScanFrom(testing::TwoRooms(), truth), M_PI)});
  ASSERT_FALSE(result.candidates.empty());
  EXPECT_TRUE(IsNear(result.candidates.front().T_map_robot, truth, 0.1, 0.03));
}

TEST_F(ScanLocalizerTest, TwoSensorsThatLookEitherWayAreOneScan) {
  const Rigid2 truth(2., 1.7, 0.3);
  const Rigid2 front(0.3, 0.1, 0.), back(-0.3, 0., M_PI);
  std::vector<RobotScan> scans;
  for (const Rigid2& T_robot_sensor : {front, back}) {
    scans.push_back(testing::Narrowed(
        ScanFrom(testing::TwoRooms(), truth * T_robot_sensor), M_PI));
    scans.back().T_robot_sensor = T_robot_sensor;
  }
  const ScanLocalization result = Locate(scans);
  ASSERT_EQ(result.verdict, LocalizationVerdict::kLocalized) << result.reason;
  EXPECT_TRUE(IsNear(result.candidates.front().T_map_robot, truth, 0.06, 0.02));
}

TEST_F(ScanLocalizerTest, ToleratesWhatIsNotInTheMap) {
  const Rigid2 truth(12.2, 3.1, 1.);
  RobotScan scan = ScanFrom(testing::TwoRooms(), truth);
  // Someone stands before a seventh of the field of view.
  for (Eigen::Vector2f& point : scan.scan.returns) {
    if (std::abs(std::atan2(point.y(), point.x()) - 0.5f) < 0.45f) {
      point *= 0.8f / point.norm();
    }
  }
  const ScanLocalization result = Locate({scan});
  ASSERT_FALSE(result.candidates.empty());
  EXPECT_TRUE(IsNear(result.candidates.front().T_map_robot, truth, 0.1, 0.03));
  EXPECT_GT(result.candidates.front().probability, 0.5);
  EXPECT_GT(result.candidates.front().evidence.in_free_space, 0.1);
}

TEST_F(ScanLocalizerTest, RefusesAnotherBuilding) {
  for (const Rigid2& pose :
       {Rigid2(1., 3., 0.2), Rigid2(3.5, 4.5, 1.), Rigid2(0., 5., 2.)}) {
    const ScanLocalization result = Locate({ScanFrom(StrangeBuilding(), pose)});
    EXPECT_THAT(result.verdict, AnyOf(LocalizationVerdict::kNothingAlike,
                                      LocalizationVerdict::kUncertain))
        << result.reason;
    EXPECT_THAT(SumOfProbabilities(result), DoubleNear(1., 1e-9));
    EXPECT_THAT(result.reason, HasSubstr("drive"));
  }
}

TEST_F(ScanLocalizerTest, FewEchoesAreTooLittle) {
  RobotScan scan = ScanFrom(testing::TwoRooms(), Rigid2(2., 1.7, 0.3));
  scan.scan.returns.resize(20);
  const ScanLocalization result = Locate({scan});
  EXPECT_EQ(result.verdict, LocalizationVerdict::kTooLittleSeen);
  EXPECT_THAT(result.reason, HasSubstr("turn around"));
  EXPECT_FALSE(result.elsewhere_probability.has_value());
  EXPECT_EQ(Locate({}).verdict, LocalizationVerdict::kTooLittleSeen);
}

TEST_F(ScanLocalizerTest, AnyNumbersAreSafe) {
  RobotScan scan = ScanFrom(testing::TwoRooms(), Rigid2(2., 1.7, 0.3));
  scan.scan.returns[0] = {NAN, 1.f};
  scan.scan.returns[1] = {INFINITY, -INFINITY};
  scan.scan.returns[2] = {1e30f, 0.f};
  scan.scan.returns[3] = {0.f, 0.f};
  scan.scan.misses = {{NAN, NAN}, {3e38f, 3e38f}};
  EXPECT_EQ(Locate({scan}).verdict, LocalizationVerdict::kLocalized);
}

TEST(SymmetricScanLocalizerTest, ARoomThatLooksTheSameIsAmbiguous) {
  const Building room = testing::BareRoom(8., 5.);
  const PanoramaMap map =
      MapOf(testing::SeeFrom(room, Rigid2(), {{0., 0.}, {2., 1.}, {-2., -1.}}));
  const Rigid2 truth(1.6, 0.7, 0.4);
  const ScanLocalization result =
      LocalizeScans({}, map, {ScanFrom(room, truth)});
  ASSERT_EQ(result.verdict, LocalizationVerdict::kAmbiguous) << result.reason;
  ASSERT_GE(result.candidates.size(), 2u);
  const Rigid2 twin = Rigid2(0., 0., M_PI) * truth;
  for (const Rigid2& pose : {truth, twin}) {
    const bool is_named =
        IsNear(result.candidates[0].T_map_robot, pose, 0.06, 0.02) ||
        IsNear(result.candidates[1].T_map_robot, pose, 0.06, 0.02);
    EXPECT_TRUE(is_named) << pose;
  }
  EXPECT_NEAR(result.candidates[0].probability, 0.5, 0.3);
  EXPECT_NEAR(result.candidates[1].probability, 0.5, 0.3);
  EXPECT_THAT(result.reason, HasSubstr("look alike"));
}

TEST(SymmetricScanLocalizerTest, ASquareRoomHasFourPoses) {
  const Building room = testing::BareRoom(6., 6.);
  const PanoramaMap map =
      MapOf(testing::SeeFrom(room, Rigid2(), {{0., 0.}, {2., 1.}, {-2., -1.}}));
  const Rigid2 truth(1.6, 0.7, 0.4);
  const ScanLocalization result =
      LocalizeScans({}, map, {ScanFrom(room, truth)});
  ASSERT_EQ(result.verdict, LocalizationVerdict::kAmbiguous) << result.reason;
  for (int k = 0; k < 4; ++k) {
    const Rigid2 twin = Rigid2(0., 0., 0.5 * M_PI * k) * truth;
    bool is_named = false;
    for (const ScanCandidate& candidate : result.candidates) {
      is_named |= candidate.probability > 0.05 &&
                  IsNear(candidate.T_map_robot, twin, 0.06, 0.02);
    }
    EXPECT_TRUE(is_named) << twin;
  }
}

TEST(SymmetricScanLocalizerTest, ACorridorIsUncertainAlongItself) {
  const Building corridor = {Wall({-20., -1.}, {20., -1.}),
                             Wall({-20., 1.}, {20., 1.})};
  testing::Viewpoints viewpoints;
  for (double x = -16.; x <= 16.; x += 4.) viewpoints.emplace_back(x, 0.);
  const PanoramaMap map =
      MapOf(testing::SeeFrom(corridor, Rigid2(), viewpoints));
  const ScanLocalization result =
      LocalizeScans({}, map, {ScanFrom(corridor, Rigid2(1., 0.2, 0.1))});
  ASSERT_FALSE(result.candidates.empty());
  EXPECT_NE(result.verdict, LocalizationVerdict::kLocalized);
  const Eigen::Matrix3d& covariance = result.candidates.front().covariance;
  EXPECT_GT(std::sqrt(covariance(0, 0)), 0.5);
  EXPECT_LT(std::sqrt(covariance(1, 1)), 0.1);
  EXPECT_LT(std::sqrt(covariance(2, 2)), 0.05);
}

TEST(PanoramaMapTest, NeedsAWallAndFreeSpace) {
  OccupancyGrid grid = UnknownGrid({{40, 40}, 0.05, Rigid2()});
  EXPECT_FALSE(MakePanoramaMap({}, grid, {}));
  grid.known.setConstant(true);
  grid.probability.setConstant(0.1f);
  EXPECT_FALSE(MakePanoramaMap({}, grid, {}));
  grid.probability.setConstant(0.9f);
  EXPECT_FALSE(MakePanoramaMap({}, grid, {}));
  grid.probability.block(5, 5, 30, 30).setConstant(0.1f);
  EXPECT_TRUE(MakePanoramaMap({}, grid, {}));
  // Nobody ever drove there.
  EXPECT_FALSE(MakePanoramaMap({}, grid, {{100., 100.}}));
}

TEST(ScanLocalizationOptionsTest, AreValidated) {
  EXPECT_EQ(Validate(ScanLocalizationOptions()), "");
  ScanLocalizationOptions options;
  options.min_probability = 1.;
  EXPECT_THAT(Validate(options), HasSubstr("min_probability"));
  options = {};
  options.num_registered_poses = 0;
  EXPECT_THAT(Validate(options), HasSubstr("num_registered_poses"));
  options = {};
  options.num_echo_poses = 10'001;
  EXPECT_THAT(Validate(options), HasSubstr("num_echo_poses"));
  options = {};
  options.min_num_beams = 0;
  EXPECT_THAT(Validate(options), HasSubstr("min_num_beams"));
  options = {};
  options.max_range_meters = NAN;
  EXPECT_THAT(Validate(options), HasSubstr("max_range_meters"));
  EXPECT_NE(Validate(CandidateWeights{NAN}), "");
  EXPECT_NE(Validate(PresenceWeights{INFINITY}), "");
}

}  // namespace
}  // namespace cartographer_sdf::scan_localizer_test
