// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/confirmation.h"

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "cartographer_sdf/execution/parallel_for.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/visited_rooms.h"

namespace cartographer_sdf::confirmation_test {
namespace {

using ::testing::IsEmpty;
using testing::IsPoseNear;
using ::testing::SizeIs;
using testing::VisitedRooms;

// Half a cell, and what registration of rooms of some metres turns by it.
constexpr double kMeters = 0.025, kRadians = 0.005;

// The first visit is the map, the second one the query.
class ConfirmPlacementTest : public ::testing::Test {
 protected:
  ConfirmPlacementTest() {
    const DescribedMap& map = rooms_.map();
    for (const auto& [id, place] : map.places) {
      (id < VisitedRooms::kWestAgain ? first_ : again_).emplace(id, place);
    }
    map_layout_.emplace(
        MakeMapLayout(map.state.pose_graph, map.odometry, map.places));
    query_layout_.emplace(*map_layout_);
    // The way between the rooms counts little.
    consistency_.rotation_sigma_per_sqrt_meter = 0.001;
  }

  [[nodiscard]] Confirmation Confirm(const size_t max_num_pairs = 50) const {
    const PlacementOptions placement;
    const MatchOptions match;
    return ConfirmPlacement({placement,
                             consistency_,
                             match,
                             {&first_, &*map_layout_},
                             {&again_, &*query_layout_}},
                            votes_, max_num_pairs, MakeExecutor(1));
  }

  const VisitedRooms rooms_;
  std::map<SubmapId, Place> first_, again_;
  std::optional<MapLayout> map_layout_, query_layout_;
  ConsistencyOptions consistency_;
  std::vector<PairPose> votes_ = {
      rooms_.MakeMatch(VisitedRooms::kWestFirst, VisitedRooms::kWestAgain, 9.)
          .pair};
};

TEST_F(ConfirmPlacementTest, FindsTheOtherRoomWhereTheVoteHasIt) {
  const Confirmation confirmation = Confirm();
  // The west rooms have voted, and no other pair lies over each other.
  ASSERT_THAT(confirmation.agreeing, SizeIs(1));
  const Match& match = confirmation.agreeing[0];
  EXPECT_EQ(match.pair.reference, VisitedRooms::kEastFirst);
  EXPECT_EQ(match.pair.query, VisitedRooms::kEastAgain);
  EXPECT_EQ(match.verdict, Verdict::kAccepted);
  EXPECT_THAT(match.pair.T_reference_query,
              IsPoseNear(rooms_.TruePose(VisitedRooms::kEastFirst,
                                         VisitedRooms::kEastAgain),
                         kMeters, kRadians));
  EXPECT_THAT(confirmation.contradicting, IsEmpty());
}

TEST_F(ConfirmPlacementTest, WallsInFreeSpaceContradict) {
  Rigid2& east = query_layout_->T_map_submap.at(VisitedRooms::kEastAgain);
  east = Rigid2(1.4, 1.2, 0.05) * east;
  const Confirmation confirmation = Confirm();
  EXPECT_THAT(confirmation.agreeing, IsEmpty());
  ASSERT_THAT(confirmation.contradicting, SizeIs(1));
  const Match& match = confirmation.contradicting[0];
  EXPECT_EQ(match.pair.reference, VisitedRooms::kEastFirst);
  EXPECT_EQ(match.pair.query, VisitedRooms::kEastAgain);
  EXPECT_EQ(match.verdict, Verdict::kContradicted);
  EXPECT_GT(match.evidence.MeanContradictionRatio(),
            PlacementOptions().max_contradiction_ratio);
}

// Its walls may be anywhere after a long way.
TEST_F(ConfirmPlacementTest, WhatIsUncertainDoesNotContradict) {
  Rigid2& east = query_layout_->T_map_submap.at(VisitedRooms::kEastAgain);
  east = Rigid2(1.4, 1.2, 0.05) * east;
  consistency_.translation_sigma_per_meter = 0.02;
  EXPECT_THAT(Confirm().contradicting, IsEmpty());
}

TEST_F(ConfirmPlacementTest, WhatCouldBeAnywhereIsNotLookedFor) {
  consistency_.translation_sigma_per_meter = 0.05;
  EXPECT_THAT(Confirm().agreeing, IsEmpty());
}

TEST_F(ConfirmPlacementTest, NothingWithoutVotesOrLeave) {
  EXPECT_THAT(Confirm(0).agreeing, IsEmpty());
  EXPECT_THAT(Confirm(1).agreeing, SizeIs(1));
  votes_.clear();
  EXPECT_THAT(Confirm().agreeing, IsEmpty());
}

TEST_F(ConfirmPlacementTest, PlacesOfTheMapWithoutALayoutTakeNoPart) {
  map_layout_->T_map_submap.erase(VisitedRooms::kEastFirst);
  EXPECT_THAT(Confirm().agreeing, IsEmpty());
}

// A room of 8 m x 5 m, seen from its middle, against itself.
class BareRoomTest : public ::testing::Test {
 protected:
  BareRoomTest()
      : place_(*DescribePlace(
            PlaceOptions(), {0, 0},
            testing::SeeFrom(testing::BareRoom(8., 5.), {}, {{0., 0.}}))) {}
  Place place_;
};

TEST_F(BareRoomTest, ContradictsItselfWhereItIsShifted) {
  const VerificationOptions options;
  EXPECT_FALSE(FindContradiction(options, 0.01, place_, place_, Rigid2()));
  const std::optional<Match> match =
      FindContradiction(options, 0.05, place_, place_, Rigid2(3., 1.5, 0.));
  ASSERT_TRUE(match.has_value());
  EXPECT_EQ(match->pair.reference, place_.id);
  // It is registered to the long walls, and may slide along them.
  const Rigid2& registered = match->pair.T_reference_query;
  const double slide = registered.translation().x();
  EXPECT_THAT(registered, IsPoseNear(Rigid2(slide, 0., 0.), kMeters, kRadians));
  EXPECT_GT(slide, 1.);
  // Of the walls that the other one has observed, 8 m less the slide of each
  // long one agree, and one of the short ones, of 5 m, stands in free space, up
  // to where it comes within 0.25 m of the long ones.
  const double ratio = match->evidence.MeanContradictionRatio();
  EXPECT_NEAR(ratio, (5. - 2. * 0.25) / (2. * (8. - slide) + 5.), 0.02);
  EXPECT_EQ(match->verdict, Verdict::kContradicted);
  EXPECT_EQ(match->pair.score,
            Score(options.judgement.score_weights, match->evidence, 0.));
  EXPECT_EQ(match->pair_score, match->pair.score);
  // No more than that fraction may contradict.
  EXPECT_FALSE(
      FindContradiction(options, ratio, place_, place_, Rigid2(3., 1.5, 0.)));
}

}  // namespace
}  // namespace cartographer_sdf::confirmation_test
