// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/tear.h"

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "gtest/gtest.h"
#include "test/testing/building.h"

namespace cartographer_sdf::tear_test {
namespace {

using testing::IsPoseNear;

constexpr double kDegree = M_PI / 180.;
// Half of what the host inserts into a submap by default: 16 for each part.
constexpr int kNumScans = 96;

// Round the west room once and back, turning all the while.
Rigid2 TrueNode(const int k) {
  const double phase = 2. * M_PI * k / kNumScans;
  return Rigid2(3.2 + 1.2 * std::cos(phase), 2. + 0.8 * std::sin(phase),
                2. * phase);
}

std::vector<Eigen::Vector2f> Points(const testing::Building& building,
                                    const Rigid2& T_world_node) {
  std::vector<Eigen::Vector2f> points;
  for (const SurfacePoint& point : testing::TakeScan(building, T_world_node)) {
    points.push_back(point.position.cast<float>());
  }
  return points;
}

// A submap of the west room, whose local SLAM slipped at a scan: the later ones
// stand elsewhere by `slip`, as seen from where the robot was.
std::vector<PlacedScan> Submap(const Rigid2& T_submap_world, const int at,
                               const Rigid2& slip) {
  std::vector<PlacedScan> scans;
  const Rigid2 T_before_after = TrueNode(at) * slip * TrueNode(at).Inverse();
  for (int k = 0; k < kNumScans; ++k) {
    const Rigid2 T_world_node =
        k < at ? TrueNode(k) : T_before_after * TrueNode(k);
    scans.push_back({T_submap_world * T_world_node,
                     {Points(testing::TwoRooms(), TrueNode(k)), {}}});
  }
  return scans;
}

TEST(FindTearTest, AWholeSubmapIsWhole) {
  for (const Rigid2& T_submap_world :
       {Rigid2(), Rigid2(3., -40., 0.7), Rigid2(0.02, 0.03, -2.)}) {
    EXPECT_FALSE(FindTear(TearOptions(), Submap(T_submap_world, 0, Rigid2()))
                     .has_value());
  }
}

// The later scans have to go back to where they belong.
TEST(FindTearTest, TellsByHowMuchTheScansSlipped) {
  const Rigid2 T_submap_world(1., 2., 0.3);
  for (const Rigid2& slip : {Rigid2(0.5, 0., 0.), Rigid2(-0.3, 0.6, 0.),
                             Rigid2(0.1, -0.4, -0.1), Rigid2(0., 0., -0.17)}) {
    const std::vector<PlacedScan> scans =
        Submap(T_submap_world, kNumScans / 2, slip);
    const std::optional<Tear> tear = FindTear(TearOptions(), scans);
    ASSERT_TRUE(tear.has_value()) << slip;
    EXPECT_LT(tear->first_part, 3) << slip;
    EXPECT_GE(tear->second_part, 3) << slip;
    const Rigid2 T_before_after = T_submap_world * TrueNode(kNumScans / 2) *
                                  slip * TrueNode(kNumScans / 2).Inverse() *
                                  T_submap_world.Inverse();
    // Where the robot was, half a cell and what that is over the room's width.
    const Rigid2 error = tear->T_first_second * T_before_after;
    const Eigen::Vector2d middle = T_submap_world * Eigen::Vector2d(3.5, 2.5);
    EXPECT_LE((error * middle - middle).norm(), 0.03) << slip;
    EXPECT_LE(std::abs(error.rotation()), 0.3 * kDegree) << slip;
    const Rigid2 after_before = T_before_after.Inverse();
    EXPECT_NEAR(tear->translation, (after_before * middle - middle).norm(),
                0.15)
        << slip;
    EXPECT_GE(tear->agreement_as_registered, TearOptions().min_agreement);
    EXPECT_LE(tear->agreement_as_placed + TearOptions().min_gain,
              tear->agreement_as_registered);
    EXPECT_GE(tear->num_points, TearOptions().min_num_points);
  }
}

TEST(FindTearTest, SmallErrorsAreNoTears) {
  for (const Rigid2& slip : {Rigid2(0.1, 0., 0.), Rigid2(0., 0., 0.015)}) {
    EXPECT_FALSE(FindTear(TearOptions(), Submap(Rigid2(), kNumScans / 2, slip))
                     .has_value())
        << slip;
  }
}

// Somebody moves all furniture when half of the scans are taken.
void MoveFurniture(std::vector<PlacedScan>* const scans) {
  testing::Building moved = testing::TwoRooms();
  for (testing::Box& box : moved) {
    const bool is_furniture = box.size.minCoeff() > 0.16;
    if (is_furniture) box.T_world_box = Rigid2(0.4, 0.2, 0.) * box.T_world_box;
  }
  for (int k = kNumScans / 2; k < kNumScans; ++k) {
    (*scans)[k].scan.returns = Points(moved, TrueNode(k));
  }
}

// Most walls stand.
TEST(FindTearTest, MovedFurnitureIsNoTear) {
  std::vector<PlacedScan> scans = Submap(Rigid2(), 0, Rigid2());
  MoveFurniture(&scans);
  EXPECT_FALSE(FindTear(TearOptions(), scans).has_value());
}

// Rooms that share no wall can't contradict each other.
TEST(FindTearTest, WithoutACommonWallNothingIsTold) {
  std::vector<PlacedScan> scans = Submap(Rigid2(), 0, Rigid2());
  for (int k = kNumScans / 2; k < kNumScans; ++k) {
    scans[k].T_submap_sensor = Rigid2(60., 0., 0.5) * scans[k].T_submap_sensor;
  }
  EXPECT_FALSE(FindTear(TearOptions(), scans).has_value());
}

TEST(FindTearTest, ReadsEachOption) {
  std::vector<PlacedScan> scans =
      Submap(Rigid2(), kNumScans / 2, Rigid2(0.5, 0., 0.));
  MoveFurniture(&scans);  // so that no pose makes all agree
  const auto is_torn = [&scans](const std::function<void(TearOptions*)>& set) {
    TearOptions options;
    set(&options);
    return FindTear(options, scans).has_value();
  };
  ASSERT_TRUE(is_torn([](TearOptions*) {}));
  EXPECT_FALSE(is_torn([](auto* o) { o->min_num_points = 1000000; }));
  EXPECT_FALSE(is_torn([](auto* o) { o->min_gain = 2.9; }));
  EXPECT_FALSE(is_torn([](auto* o) { o->min_agreement = 0.995; }));
  EXPECT_FALSE(is_torn([](auto* o) {
    o->min_translation_meters = 0.8;
    o->min_rotation = 0.3;
  }));
  // The room's walls are farther away than 1 m from most places.
  EXPECT_FALSE(is_torn([](auto* o) { o->max_range_meters = 1.; }));
  // A slip in the middle of one of three parts blurs that part alone; the other
  // two show it.
  TearOptions options;
  options.num_parts = 3;
  const std::optional<Tear> of_three = FindTear(options, scans);
  ASSERT_TRUE(of_three.has_value());
  EXPECT_LT(of_three->second_part, 3);
  // Cells of half the size: about twice as many along a wall.
  const std::vector<PlacedScan> unchanged =
      Submap(Rigid2(), kNumScans / 2, Rigid2(0.5, 0., 0.));
  options = TearOptions();
  options.resolution_meters = 0.05;
  const std::optional<Tear> fine = FindTear(options, unchanged);
  ASSERT_TRUE(fine.has_value());
  EXPECT_GT(fine->num_points,
            1.4 * FindTear(TearOptions(), unchanged)->num_points);
}

TEST(FindTearTest, TakesAnything) {
  const TearOptions options;
  EXPECT_FALSE(FindTear(options, {}).has_value());
  const auto is_torn = [&options](const Rigid2& T_even, const Rigid2& T_odd,
                                  const std::vector<Eigen::Vector2f>& points) {
    std::vector<PlacedScan> scans;
    for (int k = 0; k < 12; ++k) {
      scans.push_back({k % 2 == 0 ? T_even : T_odd, {points, points}});
    }
    return FindTear(options, scans).has_value();
  };
  EXPECT_FALSE(FindTear(options, {PlacedScan()}).has_value());
  EXPECT_FALSE(is_torn(Rigid2(), Rigid2(), {}));
  EXPECT_FALSE(is_torn(Rigid2(), Rigid2(), {{1.f, 0.f}}));
  // The robot on the wall; points beyond all bounds; poses too.
  EXPECT_FALSE(is_torn(Rigid2(), Rigid2(), {{0.f, 0.f}}));
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(is_torn(Rigid2(), Rigid2(),
                       {{1e30f, 1.f}, {kInfinity, 0.f}, {std::nanf(""), 1.f}}));
  EXPECT_FALSE(
      is_torn(Rigid2(1e300, 0., 0.), Rigid2(-1e300, 0., 0.), {{1.f, 1.f}}));
}

TEST(TearOptionsTest, AreValidated) {
  EXPECT_EQ(Validate(TearOptions()), "");
  const auto error = [](const std::function<void(TearOptions*)>& set) {
    TearOptions options;
    set(&options);
    return Validate(options);
  };
  const double nan = std::nan("");
  EXPECT_NE(error([](auto* o) { o->num_parts = 1; }), "");
  EXPECT_NE(error([](auto* o) { o->resolution_meters = 0.; }), "");
  EXPECT_NE(error([nan](auto* o) { o->max_range_meters = nan; }), "");
  EXPECT_NE(error([](auto* o) { o->min_num_points = 0; }), "");
  EXPECT_NE(error([](auto* o) { o->min_gain = 0.; }), "");
  EXPECT_NE(error([nan](auto* o) { o->min_agreement = nan; }), "");
  EXPECT_NE(error([](auto* o) { o->min_translation_meters = 0.; }), "");
  EXPECT_NE(error([](auto* o) { o->min_rotation = -1.; }), "");
}

}  // namespace
}  // namespace cartographer_sdf::tear_test
