// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/localizer.h"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/execution/parallel_for.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/divided_hall.h"
#include "test/testing/row_of_rooms.h"
#include "test/testing/visited_rooms.h"

namespace cartographer_sdf::localizer_test {
namespace {

using ::testing::HasSubstr;
using testing::IsPoseNear;
using ::testing::SizeIs;
using testing::VisitedRooms;

// The first visit is the map; the query is the west room alone, one place.
class LocalizeTest : public ::testing::Test {
 protected:
  LocalizeTest() {
    const DescribedMap& map = rooms_.map();
    for (const auto& [id, place] : map.places) {
      if (id < VisitedRooms::kWestAgain) map_.emplace(id, place);
      if (id == VisitedRooms::kWestAgain) query_.emplace(id, place);
    }
    // Nothing beyond the votes is asked for.
    options_.max_num_confirmed_pairs = 0;
    // Whatever is shipped.
    options_.placement.min_score = 6.5;
  }

  // The place of the query in the west room; `error` as the query sees it.
  [[nodiscard]] Match InWestRoom(const double score, const Verdict verdict,
                                 const Rigid2& error = Rigid2()) const {
    Match match = rooms_.MakeMatch(VisitedRooms::kWestFirst,
                                   VisitedRooms::kWestAgain, score, error);
    match.verdict = verdict;
    return match;
  }
  // The same place, as it is seen from the submap of the east room.
  [[nodiscard]] Match FromEastRoom(const double score,
                                   const Verdict verdict) const {
    Match match = rooms_.MakeMatch(VisitedRooms::kEastFirst,
                                   VisitedRooms::kWestAgain, score);
    match.verdict = verdict;
    return match;
  }
  [[nodiscard]] Localization Find(const std::vector<Match>& matches) const {
    const DescribedMap& map = rooms_.map();
    const MapLayout layout =
        MakeMapLayout(map.state.pose_graph, map.odometry, map.places);
    return Localize(
        options_, ConsistencyOptions(), MatchOptions(), {&map_, &layout},
        {&query_, &layout},
        [&matches](const std::map<SubmapId, Place>&, const ProgressCallback&) {
          return matches;
        },
        MakeExecutor(1));
  }

  const VisitedRooms rooms_;
  std::map<SubmapId, Place> map_, query_;
  LocalizationOptions options_;
};

TEST_F(LocalizeTest, OneCertainMatchIsEnough) {
  const Localization found = Find({InWestRoom(7., Verdict::kAccepted)});
  ASSERT_EQ(found.verdict, LocalizationVerdict::kLocalized) << found.reason;
  // The layout of both is that of local SLAM, which drifts by centimetres.
  EXPECT_THAT(*found.T_map_query,
              IsPoseNear(rooms_.T_world_submap(VisitedRooms::kWestAgain) *
                             rooms_.map()
                                 .state.pose_graph.submap_poses
                                 .at(VisitedRooms::kWestAgain)
                                 .Inverse(),
                         0.01, 0.001));
  EXPECT_NEAR(*found.score, 7., 1e-9);
}

TEST_F(LocalizeTest, SeveralThatAreLessCertainAddUpWhereAsked) {
  const std::vector<Match> matches = {InWestRoom(4., Verdict::kAccepted),
                                      FromEastRoom(3., Verdict::kAccepted)};
  EXPECT_EQ(Find(matches).verdict, LocalizationVerdict::kUncertain);
  options_.placement.further_match_weight = 1.;
  const Localization found = Find(matches);
  EXPECT_EQ(found.verdict, LocalizationVerdict::kLocalized) << found.reason;
  EXPECT_NEAR(*found.score, 7., 1e-9);
  EXPECT_THAT(found.matches, SizeIs(2));
}

TEST_F(LocalizeTest, LikelyMatchesCountWhereAskedBesideAnAcceptedOne) {
  options_.placement.further_match_weight = 1.;
  const std::vector<Match> matches = {InWestRoom(4., Verdict::kAccepted),
                                      FromEastRoom(2.6, Verdict::kUnlikely)};
  EXPECT_EQ(Find(matches).verdict, LocalizationVerdict::kUncertain);
  options_.count_likely_matches = true;
  EXPECT_EQ(Find(matches).verdict, LocalizationVerdict::kLocalized);
  // Not what is contradicted, nor what is less likely right than wrong.
  for (const auto& [score, verdict] : {std::pair(2.6, Verdict::kContradicted),
                                       std::pair(2.6, Verdict::kAmbiguous),
                                       std::pair(-0.1, Verdict::kUnlikely)}) {
    EXPECT_THAT(
        Find({InWestRoom(4., Verdict::kAccepted), FromEastRoom(score, verdict)})
            .matches,
        SizeIs(1));
  }
}

TEST_F(LocalizeTest, LikelyMatchesAloneAreNeverEnough) {
  options_.placement.further_match_weight = 1.;
  options_.count_likely_matches = true;
  const Localization found = Find({InWestRoom(2.9, Verdict::kUnlikely),
                                   InWestRoom(2.9, Verdict::kUnlikely),
                                   FromEastRoom(2.9, Verdict::kUnlikely)});
  EXPECT_GT(*found.score, options_.placement.min_score);
  EXPECT_EQ(found.verdict, LocalizationVerdict::kUncertain);
  EXPECT_THAT(found.reason, HasSubstr("certain by itself"));
  EXPECT_EQ(found.T_map_query, std::nullopt);
}

TEST_F(LocalizeTest, ARivalThatWouldBeCertainByItselfMakesItAmbiguous) {
  options_.placement.max_place_score = 20.;
  const Match elsewhere =
      InWestRoom(6.4, Verdict::kAccepted, Rigid2(3., 1., 2.));
  EXPECT_EQ(Find({InWestRoom(12., Verdict::kAccepted), elsewhere}).verdict,
            LocalizationVerdict::kLocalized);
  // The lead is as large as before.
  const Match certain = InWestRoom(6.6, Verdict::kAccepted, Rigid2(3., 1., 2.));
  EXPECT_EQ(Find({InWestRoom(12.2, Verdict::kAccepted), certain}).verdict,
            LocalizationVerdict::kAmbiguous);
  // Less than half the evidence of the other, as where a map has drifted.
  EXPECT_EQ(Find({InWestRoom(13.4, Verdict::kAccepted), certain}).verdict,
            LocalizationVerdict::kLocalized);
}

// A rival that only likely matches speak for is a rival all the same.
TEST_F(LocalizeTest, LikelyMatchesElsewhereMakeItAmbiguous) {
  options_.placement.further_match_weight = 1.;
  options_.count_likely_matches = true;
  const Match elsewhere =
      InWestRoom(2.9, Verdict::kUnlikely, Rigid2(3., 1., 2.));
  EXPECT_EQ(Find({InWestRoom(7., Verdict::kAccepted), elsewhere}).verdict,
            LocalizationVerdict::kLocalized);
  const Localization found =
      Find({InWestRoom(7., Verdict::kAccepted), elsewhere, elsewhere});
  EXPECT_EQ(found.verdict, LocalizationVerdict::kAmbiguous);
  EXPECT_NEAR(*found.runner_up_score, 5.8, 1e-9);
}

TEST_F(LocalizeTest, SaysWhenTooLittleWasSeen) {
  options_.placement.min_observed_area = 1e4;
  const Localization found = Find({InWestRoom(9., Verdict::kAccepted)});
  EXPECT_EQ(found.verdict, LocalizationVerdict::kTooLittleSeen);
  EXPECT_THAT(found.reason, HasSubstr("10000 are needed"));
}

MapLayout LayoutOf(const testing::DividedHall::Map& map) {
  PoseGraph graph;
  for (const auto& entry : map.places) graph.submap_poses[entry.first] = {};
  return MakeMapLayout(graph, map.odometry, map.places);
}

// Matches the two halls, whatever they look like.
Localization Locate(const testing::DividedHall& halls) {
  const MapLayout hall = LayoutOf(halls.hall);
  const MapLayout divided = LayoutOf(halls.divided);
  return Localize(
      LocalizationOptions(), ConsistencyOptions(), MatchOptions(),
      {&halls.hall.places, &hall}, {&halls.divided.places, &divided},
      [](const std::map<SubmapId, Place>&, const ProgressCallback&) {
        return std::vector<Match>{testing::DividedHall::MakeMatch(9.)};
      },
      MakeExecutor(1));
}

TEST(CrossingWallsTest, ALongOneRefutesWhatIsAlike) {
  const Localization found = Locate(testing::DividedHall(6.));
  EXPECT_EQ(found.verdict, LocalizationVerdict::kContradicted);
  EXPECT_THAT(found.reason,
              HasSubstr("stand across the free space of the other in 1 of 2 "
                        "pairs of submaps, up to 6"));
  EXPECT_EQ(found.num_compared, 2);
  ASSERT_THAT(found.crossing_walls, SizeIs(1));
  EXPECT_EQ(found.crossing_walls[0].reference, testing::DividedHall::kHall);
  EXPECT_EQ(found.crossing_walls[0].query, testing::DividedHall::kDivided);
  EXPECT_NEAR(found.crossing_walls[0].length, 6., 0.2);
}

TEST(CrossingWallsTest, AShortOneMayBeFurniture) {
  const Localization found = Locate(testing::DividedHall(2.));
  EXPECT_EQ(found.verdict, LocalizationVerdict::kLocalized) << found.reason;
  EXPECT_EQ(found.num_compared, 2);
  EXPECT_THAT(found.crossing_walls, SizeIs(0));
}

// Whatever matching says of one pose: the room next door was not tried.
Localization FindInRow(const testing::Building& row) {
  const testing::MapOfRow map = testing::SeeRooms(row, -7., 7.);
  const testing::MapOfRow query = testing::SeeRooms(row, -3., 3.);
  return Localize(
      LocalizationOptions(), ConsistencyOptions(), MatchOptions(),
      {&map.places, &map.layout}, {&query.places, &query.layout},
      [](const std::map<SubmapId, Place>&, const ProgressCallback&) {
        Match match;
        match.pair = {{0, 0}, {0, 0}, Rigid2(), 9.};
        match.pair_score = match.pair.score;
        match.verdict = Verdict::kAccepted;
        return std::vector<Match>{match};
      },
      MakeExecutor(1));
}

TEST(EqualRoomsTest, AreAmbiguousThoughMatchingIsCertain) {
  const Localization found = FindInRow(testing::RowOfRooms());
  EXPECT_EQ(found.verdict, LocalizationVerdict::kAmbiguous);
  EXPECT_THAT(found.reason, HasSubstr("the place repeats itself"));
  EXPECT_EQ(found.T_map_query, std::nullopt);
  // All of them are candidates, with votes of their own.
  ASSERT_GE(found.placements.size(), 2u);
  EXPECT_FALSE(found.placements[0].is_rival);
  EXPECT_NEAR(*found.score, found.placements[0].score, 1e-9);
  EXPECT_NEAR(*found.runner_up_score, found.placements[1].score, 1e-9);
  for (size_t k = 1; k < found.placements.size(); ++k) {
    EXPECT_TRUE(found.placements[k].is_rival);
    EXPECT_LE(found.placements[k].score, found.placements[k - 1].score);
    for (const size_t vote : found.placements[k].votes) {
      EXPECT_THAT(
          found.placements[k].T_map_query,
          IsPoseNear(found.matches[vote].pair.T_reference_query, 1e-6, 1e-6));
    }
  }
  EXPECT_EQ(FindInRow(testing::RowOfRooms(1.2)).verdict,
            LocalizationVerdict::kLocalized);
}

}  // namespace
}  // namespace cartographer_sdf::localizer_test
