// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/placement.h"

#include <algorithm>
#include <vector>

#include "cartographer_sdf/place_store/described_map.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/drive_state.h"

namespace cartographer_sdf::placement_test {
namespace {

using ::testing::ElementsAre;
using testing::IsPoseNear;
using testing::PairOnWay;
using ::testing::SizeIs;

constexpr double kSpacing = 12.;  // [m], beyond what counts as one place

// Two drives along the same way, seen from map frames that differ. The
// trajectories have the same number.
class PlacementTest : public ::testing::Test {
 protected:
  PlacementTest() {
    testing::AddStraightDrive(0, T_map_way_, 10, kSpacing, &map_);
    testing::AddStraightDrive(0, T_query_way_, 10, kSpacing, &query_);
  }
  [[nodiscard]] std::vector<Placement> Find(
      const std::vector<PairPose>& closures) const {
    return FindPlacements(map_, query_, closures);
  }
  static std::vector<Placement> FindPlacements(
      const MapState& map, const MapState& query,
      const std::vector<PairPose>& votes,
      const PlacementOptions& options = PlacementOptions()) {
    const MapLayout map_layout = Layout(map), query_layout = Layout(query);
    return cartographer_sdf::FindPlacements(
        options, ConsistencyOptions(), {&map_layout, &query_layout}, votes);
  }
  // Every submap has observed its surroundings evenly.
  static MapLayout Layout(const MapState& map) {
    MapLayout layout = MakeMapLayout(map.pose_graph, OdometryPoses(map), {});
    for (const auto& [id, submap] : map.submaps) {
      layout.centroids[id] = Eigen::Vector2d::Zero();
      layout.diameters[id] = 5.;
    }
    return layout;
  }
  static PairPose Closure(const int reference, const int query,
                          const double offset, const double score = 5.) {
    return PairOnWay({0, reference}, {0, query}, kSpacing, offset, score);
  }

  const Rigid2 T_map_way_{3., 4., 1.};
  const Rigid2 T_query_way_{-30., 7., -2.};
  const Rigid2 T_map_query_ = T_map_way_ * T_query_way_.Inverse();
  MapState map_;
  MapState query_;
};

TEST_F(PlacementTest, NoVotesNoPlacement) { EXPECT_THAT(Find({}), SizeIs(0)); }

TEST_F(PlacementTest, VotesThatAgreeAreOne) {
  const std::vector<Placement> placements =
      Find({Closure(0, 0, 0.05), Closure(1, 1, -0.05), Closure(2, 1, 0.),
            Closure(3, 3, 0.)});
  ASSERT_THAT(placements, SizeIs(1));
  EXPECT_THAT(placements[0].T_map_query, IsPoseNear(T_map_query_, 0.06, 0.01));
  EXPECT_THAT(placements[0].votes, ElementsAre(0, 1, 2, 3));
  // Three places of the query; the second has two votes.
  EXPECT_NEAR(placements[0].score, 15., 1e-9);
}

TEST_F(PlacementTest, PlacesNearEachOtherTellPartlyTheSame) {
  MapState query;
  testing::AddStraightDrive(0, T_query_way_, 10, 2.5, &query);
  const std::vector<PairPose> closures = {
      PairOnWay({0, 0}, {0, 0}, kSpacing, 0., 6.),
      // 2.5 m farther on its way.
      PairOnWay({0, 0}, {0, 1}, 2.5, 0., 4.)};
  const std::vector<Placement> placements =
      FindPlacements(map_, query, closures);
  ASSERT_THAT(placements, SizeIs(1));
  // What two discs share, a quarter of their diameter apart, to a few tiles.
  EXPECT_NEAR(placements[0].score, 6. + 0.315 * 4., 0.15);
}

TEST_F(PlacementTest, OnePlaceCountsSoMuchAtMost) {
  const std::vector<Placement> placements = Find({Closure(0, 0, 0., 50.)});
  ASSERT_THAT(placements, SizeIs(1));
  EXPECT_NEAR(placements[0].score, PlacementOptions().max_place_score, 1e-9);
}

TEST_F(PlacementTest, FurtherMatchesOfOnePlaceCountAsAsked) {
  const std::vector<PairPose> votes = {
      Closure(0, 1, 0., 2.), Closure(1, 1, 0., 50.), Closure(2, 1, 0., 4.)};
  for (const double weight : {0., 0.5, 1.}) {
    PlacementOptions options;
    options.further_match_weight = weight;
    const std::vector<Placement> placements =
        FindPlacements(map_, query_, votes, options);
    ASSERT_THAT(placements, SizeIs(1));
    EXPECT_NEAR(placements[0].score, 10. + weight * (2. + 4.), 1e-9);
  }
}

TEST_F(PlacementTest, PlacesThatShowTheSameHallAreOne) {
  // 12 m apart in a hall four times as wide.
  MapLayout map_layout = Layout(map_), query_layout = Layout(query_);
  const auto score = [&] {
    return cartographer_sdf::FindPlacements(
               PlacementOptions(), ConsistencyOptions(),
               {&map_layout, &query_layout},
               {Closure(1, 1, 0., 6.), Closure(2, 2, 0., 5.)})
        .at(0)
        .score;
  };
  EXPECT_NEAR(score(), 11., 1e-9);
  for (auto& [id, diameter] : query_layout.diameters) {
    diameter = 4. * kSpacing;
  }
  EXPECT_NEAR(score(), 6. + 0.315 * 5., 0.05);
}

TEST_F(PlacementTest, ManyPlacesOfOneHallAreNotMore) {
  // Ten within 9 m, each next to others.
  MapState query;
  testing::AddStraightDrive(0, T_query_way_, 10, 1., &query);
  std::vector<PairPose> closures;
  for (int k = 0; k < 10; ++k) {
    closures.push_back(PairOnWay({0, 0}, {0, k}, 1., 0., 5.));
  }
  const MapLayout map_layout = Layout(map_);
  MapLayout query_layout = Layout(query);
  for (auto& [id, diameter] : query_layout.diameters) diameter = 40.;
  const std::vector<Placement> placements =
      cartographer_sdf::FindPlacements(PlacementOptions(), ConsistencyOptions(),
                                       {&map_layout, &query_layout}, closures);
  ASSERT_THAT(placements, SizeIs(1));
  // The union of all discs: one, and a strip of 9 m by its diameter.
  EXPECT_NEAR(placements[0].score, 5. * (1. + 9. * 40. / (M_PI * 400.)), 0.1);
}

TEST_F(PlacementTest, LookAlikesAreRivals) {
  // Submap 1 looks as submap 2 does, 12 m farther; both votes are as certain.
  const std::vector<Placement> placements =
      Find({Closure(1, 1, 0.), Closure(2, 1, kSpacing, 4.5)});
  ASSERT_THAT(placements, SizeIs(2));
  EXPECT_THAT(placements[0].T_map_query, IsPoseNear(T_map_query_, 1e-6, 1e-6));
  EXPECT_FALSE(placements[0].is_rival);
  EXPECT_TRUE(placements[1].is_rival);
  EXPECT_NEAR(placements[1].score, 4.5, 1e-9);
}

TEST_F(PlacementTest, WhatMayHaveDriftedIsNoRival) {
  // 108 m apart in both maps: 2 m off says nothing, ...
  std::vector<Placement> placements =
      Find({Closure(0, 0, 0.), Closure(9, 9, 2.)});
  ASSERT_THAT(placements, SizeIs(2));
  EXPECT_FALSE(placements[1].is_rival);
  // ... next to each other it does.
  placements = Find({Closure(0, 0, 0.), Closure(1, 1, 2.)});
  ASSERT_THAT(placements, SizeIs(2));
  EXPECT_TRUE(placements[1].is_rival);
}

TEST_F(PlacementTest, OnePlaceCannotBeAtTwo) {
  // Far apart on the way through the map, where cycles say nothing.
  const std::vector<Placement> placements =
      Find({Closure(0, 0, 0., 5.), Closure(9, 0, 9. * kSpacing, 4.)});
  ASSERT_THAT(placements, SizeIs(2));
  EXPECT_TRUE(placements[1].is_rival);
}

TEST_F(PlacementTest, FollowsTheDriftOfEitherMap) {
  // The query stretches the way by 2 %: at the end it is 2 m off, but each vote
  // agrees with its neighbours.
  std::vector<PairPose> closures;
  for (int i = 0; i < 10; ++i) closures.push_back(Closure(i, i, 0.24 * i));
  const std::vector<Placement> placements = Find(closures);
  ASSERT_THAT(placements, SizeIs(1));
  EXPECT_THAT(placements[0].votes, SizeIs(10));
}

TEST_F(PlacementTest, DoesNotDependOnTheOrderOfVotes) {
  std::vector<PairPose> closures = {
      Closure(0, 0, 0.),          Closure(1, 1, 0.1), Closure(2, 1, 12., 7.),
      Closure(5, 5, -0.1),        Closure(7, 5, 24.), Closure(8, 8, 1.5),
      Closure(9, 8, kSpacing, 2.)};
  const std::vector<Placement> expected = Find(closures);
  for (int k = 0; k < 7; ++k) {
    std::rotate(closures.begin(), closures.begin() + 3, closures.end());
    const std::vector<Placement> placements = Find(closures);
    ASSERT_EQ(placements.size(), expected.size());
    for (size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(placements[i].score, expected[i].score);
      EXPECT_EQ(placements[i].T_map_query.translation(),
                expected[i].T_map_query.translation());
      EXPECT_EQ(placements[i].votes.size(), expected[i].votes.size());
      EXPECT_EQ(placements[i].is_rival, expected[i].is_rival);
    }
  }
}

TEST(PlacementOptionsTest, AreValidated) {
  EXPECT_EQ(Validate(PlacementOptions()), "");
  PlacementOptions options;
  options.min_lead = -1.;
  EXPECT_NE(Validate(options), "");
  options = PlacementOptions();
  options.max_contradicting_fraction = 1.5;
  EXPECT_NE(Validate(options), "");
  options = PlacementOptions();
  options.further_match_weight = 1.5;
  EXPECT_NE(Validate(options), "");
}

}  // namespace
}  // namespace cartographer_sdf::placement_test
