// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/rival_matches.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/corridor_map.h"

namespace cartographer_sdf::rival_matches_test {
namespace {

using testing::AcceptedMatch;
using testing::CorridorMap;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<bool> IsAccepted(const NeighbourhoodMaps& maps,
                             std::vector<Match> matches,
                             const RivalMatchOptions& options = {}) {
  RefuseRivalMatches(options, JudgementOptions(), maps, &matches);
  std::vector<bool> accepted;
  for (const Match& match : matches) {
    accepted.push_back(match.verdict == Verdict::kAccepted);
    EXPECT_TRUE(match.verdict == Verdict::kAccepted ||
                match.verdict == Verdict::kAmbiguous);
  }
  return accepted;
}

TEST(RefuseRivalMatchesTest, OneSubmapIsNotInTwoRooms) {
  const CorridorMap corridor;
  // The query is in the room of submap 1, or in that of submap 4.
  EXPECT_THAT(
      IsAccepted(corridor.Between(), {AcceptedMatch(1, 0, Rigid2(), 6.),
                                      AcceptedMatch(4, 0, Rigid2(), 5.)}),
      ElementsAre(false, false));
  // Far likelier than the other.
  EXPECT_THAT(
      IsAccepted(corridor.Between(), {AcceptedMatch(1, 0, Rigid2(), 6.),
                                      AcceptedMatch(4, 0, Rigid2(), 3.5)}),
      ElementsAre(true, false));
}

TEST(RefuseRivalMatchesTest, MapAndQueryAreAlike) {
  const CorridorMap corridor;
  EXPECT_THAT(
      IsAccepted(corridor.Between(), {AcceptedMatch(0, 1, Rigid2(), 6.),
                                      AcceptedMatch(0, 4, Rigid2(), 5.)}),
      ElementsAre(false, false));
}

TEST(RefuseRivalMatchesTest, WhatAgreesIsNoRival) {
  const CorridorMap corridor;
  // Both put the query in the same room, but for some drift.
  EXPECT_THAT(IsAccepted(corridor.Between(),
                         {AcceptedMatch(1, 0, Rigid2(10., 0., 0.), 6.),
                          AcceptedMatch(2, 0, Rigid2(0.5, 1., 0.1), 6.)}),
              ElementsAre(true, true));
  // Of different queries.
  EXPECT_THAT(
      IsAccepted(corridor.Between(), {AcceptedMatch(1, 0, Rigid2(), 6.),
                                      AcceptedMatch(4, 3, Rigid2(), 6.)}),
      ElementsAre(true, true));
}

TEST(RefuseRivalMatchesTest, ATurnedPoseIsARival) {
  const CorridorMap corridor;
  EXPECT_THAT(IsAccepted(corridor.Between(),
                         {AcceptedMatch(1, 0, Rigid2(10., 0., 0.), 6.),
                          AcceptedMatch(2, 0, Rigid2(0., 0., 3.1), 6.)}),
              ElementsAre(false, false));
}

// Within one map a submap is the query of one pair and the reference of
// another.
TEST(RefuseRivalMatchesTest, WithinAMapEitherSideIsShared) {
  const CorridorMap corridor;
  EXPECT_THAT(
      IsAccepted(corridor.Within(), {AcceptedMatch(1, 9, Rigid2(), 6.),
                                     AcceptedMatch(9, 15, Rigid2(), 6.)}),
      ElementsAre(false, false));
}

TEST(RefuseRivalMatchesTest, ARivalTakesFromTheScore) {
  const CorridorMap corridor;
  std::vector<Match> matches = {AcceptedMatch(1, 0, Rigid2(), 9.),
                                AcceptedMatch(4, 0, Rigid2(), 2.)};
  RivalMatchOptions options;
  options.rival_weight = 0.75;
  RefuseRivalMatches(options, JudgementOptions(), corridor.Between(), &matches);
  EXPECT_NEAR(matches[0].pair.score, 9. - 0.75 * std::log1p(std::exp(2.)),
              1e-12);
  EXPECT_EQ(matches[0].verdict, Verdict::kAccepted);
  EXPECT_NEAR(matches[1].pair.score, 2. - 0.75 * std::log1p(std::exp(9.)),
              1e-12);
}

// Weights are options, and scores as large as they make them.
TEST(RefuseRivalMatchesTest, ScoresMayBeAsLargeAsTheyLike) {
  const CorridorMap corridor;
  std::vector<Match> matches = {AcceptedMatch(1, 0, Rigid2(), 2000.),
                                AcceptedMatch(4, 0, Rigid2(), 1000.)};
  RefuseRivalMatches(RivalMatchOptions(), JudgementOptions(),
                     corridor.Between(), &matches);
  EXPECT_EQ(matches[0].pair.score, 1500.);
  EXPECT_EQ(matches[1].pair.score, 0.);
}

TEST(RefuseRivalMatchesTest, WithoutARivalNothingChanges) {
  const CorridorMap corridor;
  std::vector<Match> matches = {AcceptedMatch(1, 0, Rigid2(), 6.)};
  RefuseRivalMatches(RivalMatchOptions(), JudgementOptions(),
                     corridor.Between(), &matches);
  EXPECT_EQ(matches[0].pair.score, 6.);
  EXPECT_EQ(matches[0].verdict, Verdict::kAccepted);
}

TEST(RefuseRivalMatchesTest, WhatIsLeftOfTheScoreMustSuffice) {
  const CorridorMap corridor;
  JudgementOptions judgement;
  // 6 - 0.5 ln(1 + e^4) = 3.99.
  std::vector<Match> matches = {AcceptedMatch(1, 0, Rigid2(), 6.),
                                AcceptedMatch(4, 0, Rigid2(), 4.)};
  judgement.min_score = 3.9;
  RefuseRivalMatches(RivalMatchOptions(), judgement, corridor.Between(),
                     &matches);
  EXPECT_EQ(matches[0].verdict, Verdict::kAccepted);
  matches[0] = AcceptedMatch(1, 0, Rigid2(), 6.);
  matches[1] = AcceptedMatch(4, 0, Rigid2(), 4.);
  judgement.min_score = 4.1;
  RefuseRivalMatches(RivalMatchOptions(), judgement, corridor.Between(),
                     &matches);
  EXPECT_EQ(matches[0].verdict, Verdict::kAmbiguous);
}

TEST(RefuseRivalMatchesTest, AnythingMayLieBeyondABrokenLink) {
  const TrajectoryLinks links = testing::LinksBrokenAtTen();
  const CorridorMap corridor;
  NeighbourhoodMaps maps = corridor.Between();
  maps.reference_links = &links;
  EXPECT_THAT(IsAccepted(maps, {AcceptedMatch(5, 0, Rigid2(), 6.),
                                AcceptedMatch(15, 0, Rigid2(), 6.)}),
              ElementsAre(true, true));
  EXPECT_THAT(IsAccepted(maps, {AcceptedMatch(1, 0, Rigid2(), 6.),
                                AcceptedMatch(5, 0, Rigid2(), 6.)}),
              ElementsAre(false, false));
}

TEST(RefuseRivalMatchesTest, LocalSlamMayDrift) {
  const CorridorMap corridor;
  RivalMatchOptions options;
  options.max_drift_per_meter = 1.1;
  EXPECT_THAT(IsAccepted(corridor.Between(),
                         {AcceptedMatch(1, 0, Rigid2(), 6.),
                          AcceptedMatch(4, 0, Rigid2(), 5.)},
                         options),
              ElementsAre(true, true));
}

TEST(RefuseRivalMatchesTest, TheOrderDoesNotMatter) {
  const CorridorMap corridor;
  std::vector<Match> matches = {
      AcceptedMatch(1, 0, Rigid2(), 6.), AcceptedMatch(4, 0, Rigid2(), 5.),
      AcceptedMatch(8, 0, Rigid2(), 8.), AcceptedMatch(8, 3, Rigid2(), 8.)};
  std::vector<bool> accepted = IsAccepted(corridor.Between(), matches);
  std::reverse(matches.begin(), matches.end());
  std::reverse(accepted.begin(), accepted.end());
  EXPECT_EQ(IsAccepted(corridor.Between(), matches), accepted);
}

TEST(RivalMatchOptionsTest, SaysWhatIsWrong) {
  RivalMatchOptions options;
  EXPECT_EQ(Validate(options), "");
  options.min_lead = -1.;
  EXPECT_THAT(Validate(options), HasSubstr("min_lead"));
  options = {};
  options.max_drift_per_meter = -1.;
  EXPECT_THAT(Validate(options), HasSubstr("max_drift_per_meter"));
}

}  // namespace
}  // namespace cartographer_sdf::rival_matches_test
