// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/scan_session.h"

#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "cartographer_sdf/apps/map_grid.h"
#include "cartographer_sdf/localization/scan_places.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/drawn_map.h"
#include "test/testing/shared_data.h"

namespace cartographer_sdf::scan_session_test {
namespace {

using testing::Building;
using testing::Narrowed;
using testing::ScanFrom;
using testing::TwoRooms;

PanoramaMap MapOf(const OccupancyGrid& grid) {
  std::optional<PanoramaMap> map = MakePanoramaMap({}, grid, {});
  CHECK(map.has_value());
  return *std::move(map);
}

bool IsNear(const Rigid2& pose, const Rigid2& truth, const double meters,
            const double radians) {
  return (pose.translation() - truth.translation()).norm() < meters &&
         std::abs(NormalizeAngle(pose.rotation() - truth.rotation())) < radians;
}

// A robot that drives from pose to pose in steps of at most 0.1 m and 0.1 rad,
// ten scans a second; its odometry has another origin and runs 3 % short.
class Robot {
 public:
  Robot(const Building& building, const Rigid2& T_world_robot)
      : building_(building), T_world_robot_(T_world_robot) {}

  [[nodiscard]] const Rigid2& T_world_robot() const { return T_world_robot_; }
  [[nodiscard]] OdometryScan See(const double field_of_view = 7.) {
    time_ += 0.1;
    return {time_,
            T_odometry_robot_,
            {Narrowed(ScanFrom(building_, T_world_robot_), field_of_view)}};
  }
  // Straight ahead, after turning on the spot; adds all scans.
  void DriveTo(const Eigen::Vector2d& target, ScanSession* const session,
               const double field_of_view = 7.) {
    const Eigen::Vector2d offset = target - T_world_robot_.translation();
    const double turn = NormalizeAngle(std::atan2(offset.y(), offset.x()) -
                                       T_world_robot_.rotation());
    const int num_turns = static_cast<int>(std::ceil(std::abs(turn) / 0.1));
    for (int k = 0; k < num_turns; ++k) {
      Move(Rigid2(0., 0., turn / num_turns));
      session->Add(See(field_of_view));
    }
    const int num_steps = static_cast<int>(std::ceil(offset.norm() / 0.1));
    for (int k = 0; k < num_steps; ++k) {
      Move(Rigid2(offset.norm() / num_steps, 0., 0.));
      session->Add(See(field_of_view));
    }
  }
  // Nobody tells the odometry.
  void CarryTo(const Rigid2& T_world_robot) { T_world_robot_ = T_world_robot; }

 private:
  void Move(const Rigid2& motion) {
    constexpr double kScale = 0.97;
    T_world_robot_ = T_world_robot_ * motion;
    T_odometry_robot_ = T_odometry_robot_ *
                        Rigid2(Eigen::Vector2d(kScale * motion.translation()),
                               motion.rotation());
  }

  const Building building_;
  Rigid2 T_world_robot_;
  Rigid2 T_odometry_robot_{30., -7., 2.};
  double time_ = 1e9;
};

class ScanSessionTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    two_rooms_ = new PanoramaMap(MapOf(testing::TwoRoomsGrid()));
  }
  static void TearDownTestSuite() { delete two_rooms_; }
  static PanoramaMap* two_rooms_;
  ScanSession session_{{}, {}, *two_rooms_};
};
PanoramaMap* ScanSessionTest::two_rooms_;

std::string Text(const SessionAnswer& answer) {
  std::ostringstream text;
  text.precision(17);
  text << ScanSearchStateName(answer.state) << " " << ScanUseName(answer.use)
       << " " << answer.localization.reason << " " << answer.num_looks << " "
       << answer.distance_driven;
  for (const ScanCandidate& candidate : answer.localization.candidates) {
    text << "\n"
         << candidate.T_map_robot.translation().transpose() << " "
         << candidate.T_map_robot.rotation() << " " << candidate.probability
         << " " << candidate.covariance;
  }
  return text.str();
}

// Straight ahead is the end of the corridor, and either end looks the same.
const Rigid2 kInCorridor(1., 6.1, M_PI);
constexpr double kNarrow = 0.9;

TEST_F(ScanSessionTest, TheAnswerComesAsSoonAsItIsCertain) {
  Robot robot(TwoRooms(), kInCorridor);
  EXPECT_EQ(session_.Add(robot.See(kNarrow)).use, ScanUse::kCompared);
  EXPECT_EQ(session_.answer().state, ScanSearchState::kSearching);
  EXPECT_FALSE(session_.answer().T_map_robot.has_value());
  robot.DriveTo({5.5, 6.1}, &session_, kNarrow);
  robot.DriveTo({5.5, 4.}, &session_);
  const SessionAnswer& answer = session_.answer();
  ASSERT_EQ(answer.state, ScanSearchState::kLocated)
      << answer.localization.reason;
  EXPECT_TRUE(IsNear(*answer.T_map_robot, robot.T_world_robot(), 0.1, 0.05))
      << *answer.T_map_robot << " is not " << robot.T_world_robot();
}

TEST_F(ScanSessionTest, ThePoseFollowsTheRobotAlthoughOdometryDrifts) {
  Robot robot(TwoRooms(), Rigid2(2., 1.7, 0.3));
  session_.Add(robot.See());
  ASSERT_EQ(session_.answer().state, ScanSearchState::kLocated);
  for (const Eigen::Vector2d& target :
       {Eigen::Vector2d(3.2, 3.9), Eigen::Vector2d(5.5, 4.),
        Eigen::Vector2d(5.5, 6.1), Eigen::Vector2d(10.6, 6.1),
        Eigen::Vector2d(10.6, 3.), Eigen::Vector2d(13.5, 3.4)}) {
    robot.DriveTo(target, &session_);
    ASSERT_EQ(session_.answer().state, ScanSearchState::kLocated)
        << session_.answer().localization.reason;
    EXPECT_TRUE(IsNear(*session_.answer().T_map_robot, robot.T_world_robot(),
                       0.15, 0.05))
        << *session_.answer().T_map_robot << " is not "
        << robot.T_world_robot();
  }
}

TEST_F(ScanSessionTest, AStandingRobotAddsNothing) {
  Robot robot(TwoRooms(), Rigid2(2., 1.7, 0.3));
  session_.Add(robot.See(1.));
  const double before = *session_.answer().localization.elsewhere_probability;
  for (int k = 0; k < 50; ++k) {
    EXPECT_EQ(session_.Add(robot.See(1.)).use, ScanUse::kNotMoved);
  }
  EXPECT_EQ(session_.answer().num_looks, 1);
  EXPECT_EQ(*session_.answer().localization.elsewhere_probability, before);
}

TEST_F(ScanSessionTest, ACarriedRobotIsLostAndSearchedForAgain) {
  Robot robot(TwoRooms(), Rigid2(2., 1.7, 0.3));
  session_.Add(robot.See());
  ASSERT_EQ(session_.answer().state, ScanSearchState::kLocated);
  robot.CarryTo(Rigid2(12.2, 3.1, 1.));
  // For less than lost_after_seconds it may be someone who stands around.
  for (int k = 0; k < 15; ++k) session_.Add(robot.See());
  EXPECT_EQ(session_.answer().state, ScanSearchState::kLocated);
  bool was_lost = false;
  for (int k = 0; k < 15; ++k) {
    was_lost |= session_.Add(robot.See()).use == ScanUse::kCarriedAway;
  }
  EXPECT_TRUE(was_lost);
  ASSERT_EQ(session_.answer().state, ScanSearchState::kLocated)
      << session_.answer().localization.reason;
  EXPECT_TRUE(
      IsNear(*session_.answer().T_map_robot, robot.T_world_robot(), 0.1, 0.05));
}

TEST_F(ScanSessionTest, ARobotThatIsCarriedOutOfTheMapStaysLost) {
  Robot robot(TwoRooms(), Rigid2(2., 1.7, 0.3));
  session_.Add(robot.See());
  ASSERT_EQ(session_.answer().state, ScanSearchState::kLocated);
  Robot elsewhere(testing::BareRoom(4.3, 2.9), Rigid2(0.4, 0.2, 0.5));
  double time = 1e9 + 10.;
  for (int k = 0; k < 40; ++k) {
    OdometryScan scan = elsewhere.See();
    scan.time = time += 0.1;
    session_.Add(scan);
  }
  EXPECT_EQ(session_.answer().state, ScanSearchState::kLost);
  EXPECT_FALSE(session_.answer().T_map_robot.has_value());
}

TEST_F(ScanSessionTest, ARobotThatIsCarriedWhileItIsSearchedForBeginsAnew) {
  Robot robot(TwoRooms(), kInCorridor);
  session_.Add(robot.See(kNarrow));
  ASSERT_EQ(session_.answer().state, ScanSearchState::kSearching);
  Robot elsewhere(testing::BareRoom(3., 2.), Rigid2(0.2, 0.1, 0.5));
  OdometryScan scan = elsewhere.See(kNarrow);
  scan.time += 10.;
  EXPECT_EQ(session_.Add(scan).use, ScanUse::kCarriedAway);
  EXPECT_EQ(session_.answer().num_looks, 1);
}

TEST_F(ScanSessionTest, AnotherBuildingIsNeverCertain) {
  const Building building = {
      testing::Wall({0., 0.}, {3., 0.}),   testing::Wall({3., 0.}, {5.5, 2.}),
      testing::Wall({5.5, 2.}, {5., 6.}),  testing::Wall({5., 6.}, {1., 7.5}),
      testing::Wall({1., 7.5}, {-2., 5.}), testing::Wall({-2., 5.}, {-1., 2.}),
      testing::Wall({-1., 2.}, {0., 0.}),
  };
  Robot robot(building, Rigid2(1., 2., 0.2));
  session_.Add(robot.See());
  for (const Eigen::Vector2d& target :
       {Eigen::Vector2d(3.5, 2.), Eigen::Vector2d(3.5, 5.),
        Eigen::Vector2d(0., 4.5), Eigen::Vector2d(1., 2.)}) {
    robot.DriveTo(target, &session_);
    EXPECT_EQ(session_.answer().state, ScanSearchState::kSearching)
        << session_.answer().localization.reason;
  }
}

TEST(SymmetricScanSessionTest, DrivingInARoomThatLooksTheSameStaysAmbiguous) {
  const Building room = testing::BareRoom(8., 5.);
  const PanoramaMap map =
      MapOf(testing::SeeFrom(room, Rigid2(), {{0., 0.}, {2., 1.}, {-2., -1.}}));
  ScanSession session({}, {}, map);
  Robot robot(room, Rigid2(1.6, 0.7, 0.4));
  for (const Eigen::Vector2d& target :
       {Eigen::Vector2d(-2.5, 1.2), Eigen::Vector2d(-2., -1.5),
        Eigen::Vector2d(2.5, -1.2)}) {
    robot.DriveTo(target, &session);
    EXPECT_EQ(session.answer().localization.verdict,
              LocalizationVerdict::kAmbiguous)
        << session.answer().localization.reason;
  }
  const auto& candidates = session.answer().localization.candidates;
  ASSERT_GE(candidates.size(), 2u);
  EXPECT_NEAR(candidates[0].probability, 0.5, 0.3);
  EXPECT_NEAR(candidates[1].probability, 0.5, 0.3);
}

TEST_F(ScanSessionTest, WhatIsBrokenIsLeftOutWithTheReason) {
  Robot robot(TwoRooms(), Rigid2(2., 1.7, 0.3));
  const OdometryScan good = robot.See();
  session_.Add(good);
  const SessionAnswer before = session_.answer();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const Rigid2& odometry :
       {Rigid2(kNan, 0., 0.), Rigid2(0., kInfinity, 0.), Rigid2(0., 0., kNan),
        Rigid2(1e300, 0., 0.)}) {
    OdometryScan scan = robot.See();
    scan.T_odometry_robot = odometry;
    EXPECT_EQ(session_.Add(scan).use, ScanUse::kBrokenOdometry);
  }
  for (const double time :
       {good.time, good.time - 1., kNan, -kInfinity, kInfinity}) {
    OdometryScan scan = good;
    scan.time = time;
    EXPECT_EQ(session_.Add(scan).use, ScanUse::kTimeNotLater);
  }
  OdometryScan empty = robot.See();
  empty.scans.clear();
  EXPECT_EQ(session_.Add(empty).use, ScanUse::kTooFewEchoes);
  OdometryScan broken = robot.See();
  for (Eigen::Vector2f& point : broken.scans.front().scan.returns) {
    point.x() = std::numeric_limits<float>::quiet_NaN();
  }
  EXPECT_EQ(session_.Add(broken).use, ScanUse::kTooFewEchoes);
  EXPECT_EQ(session_.answer().state, before.state);
  EXPECT_EQ(session_.answer().num_looks, before.num_looks);
  ASSERT_TRUE(session_.answer().T_map_robot.has_value());
  EXPECT_TRUE(
      IsNear(*session_.answer().T_map_robot, *before.T_map_robot, 1e-9, 1e-9));
}

TEST_F(ScanSessionTest, AFirstScanMayBeBroken) {
  OdometryScan scan;
  scan.time = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(session_.Add(scan).use, ScanUse::kTimeNotLater);
  scan.time = 0.;
  EXPECT_EQ(session_.Add(scan).use, ScanUse::kTooFewEchoes);
  EXPECT_EQ(session_.answer().state, ScanSearchState::kSearching);
}

TEST_F(ScanSessionTest, AJumpOfTheOdometryBeginsTheSearchAnew) {
  Robot robot(TwoRooms(), Rigid2(2., 1.7, 0.3));
  session_.Add(robot.See());
  ASSERT_EQ(session_.answer().state, ScanSearchState::kLocated);
  OdometryScan scan = robot.See();
  scan.T_odometry_robot = Rigid2(1e5, 0., 0.);
  EXPECT_EQ(session_.Add(scan).use, ScanUse::kOdometryJumped);
  EXPECT_EQ(session_.answer().num_looks, 1);
}

TEST_F(ScanSessionTest, ASecondRunGivesTheSame) {
  std::vector<std::string> texts;
  for (int run = 0; run < 2; ++run) {
    ScanSession session({}, {}, *two_rooms_);
    Robot robot(TwoRooms(), Rigid2(10.6, 2.7, 0.3));
    robot.DriveTo({13.5, 3.4}, &session, 1.2);
    texts.push_back(Text(session.answer()));
  }
  EXPECT_EQ(texts[0], texts[1]);
}

TEST_F(ScanSessionTest, TheMemoryOfLooksIsBounded) {
  ScanSessionOptions options;
  options.max_num_looks = 2;
  ScanSession session({}, options, *two_rooms_);
  Robot robot(TwoRooms(), Rigid2(2., 1.7, 0.3));
  robot.DriveTo({3.2, 3.9}, &session, 1.);
  robot.DriveTo({5.5, 4.}, &session, 1.);
  EXPECT_GT(session.answer().num_looks, 4);
  EXPECT_FALSE(session.answer().localization.candidates.empty());
}

TEST(ScanSessionOptionsTest, AreValidated) {
  EXPECT_EQ(Validate(ScanSessionOptions()), "");
  ScanSessionOptions options;
  options.look_distance_meters = 0.;
  EXPECT_NE(Validate(options), "");
  options = {};
  options.look_rotation = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(Validate(options), "");
  options = {};
  options.max_num_looks = 1;
  EXPECT_NE(Validate(options), "");
  options = {};
  for (const int number : {0, std::numeric_limits<int>::max()}) {
    options.num_looks_per_search = number;
    EXPECT_NE(Validate(options), "");
  }
  options = {};
  options.independent_distance_meters = 0.;
  EXPECT_NE(Validate(options), "");
  options = {};
  options.presence_lead_per_log = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(Validate(options), "");
  options = {};
  options.max_contradicting_fraction = 0.;
  EXPECT_NE(Validate(options), "");
  options = {};
  options.lost_after_seconds = -1.;
  EXPECT_NE(Validate(options), "");
  options = {};
  options.lost_after_scans = 0;
  EXPECT_NE(Validate(options), "");
}

// One drive through a real office's plan, in the map of another.
TEST(RealScanSessionTest, IsLocatedAndStaysSo) {
  SKIP_WITHOUT_SHARED_DATA("labc_bare1.pbstream");
  SKIP_WITHOUT_SHARED_DATA("labc_d3a.pbstream");
  const auto grid =
      ReadMapGrid(MapSource(SharedDataPath("labc_bare1.pbstream")));
  ASSERT_TRUE(grid.ok()) << grid.status();
  const auto map = MakePanoramaMap({}, grid->grid, grid->driven_positions);
  ASSERT_TRUE(map.has_value());
  const auto query =
      ReadMapWithScans(MapSource(SharedDataPath("labc_d3a.pbstream")));
  ASSERT_TRUE(query.ok()) << query.status();
  ScanSession session({}, {}, *map);
  int num_scans = 0, num_located = 0, num_lost = 0;
  ScanSearchState state = ScanSearchState::kSearching;
  for (const OdometryScan& scan : OdometryScansOf(*query, 0)) {
    const SessionAnswer& answer = session.Add(scan);
    ++num_scans;
    num_located += answer.state == ScanSearchState::kLocated;
    num_lost += state == ScanSearchState::kLocated &&
                answer.state == ScanSearchState::kLost;
    state = answer.state;
  }
  EXPECT_GT(num_located, 0.9 * num_scans);
  EXPECT_LE(num_lost, 1);
}

}  // namespace
}  // namespace cartographer_sdf::scan_session_test
