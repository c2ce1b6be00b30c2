// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/rival_matches.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "cartographer_sdf/execution/parallel_for.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/two_visits.h"

namespace cartographer_sdf::rival_matches_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A corridor of equal rooms, one every 10 m, each seen by one submap.
class Corridor {
 public:
  Corridor() {
    for (int index = 0; index < 20; ++index) {
      odometry_[{0, index}] = {Rigid2(10. * index, 0., 0.), 10. * index};
    }
  }

  [[nodiscard]] NeighbourhoodMaps Within() const {
    return {{&places_, &odometry_}, {&places_, &odometry_}, 3};
  }
  [[nodiscard]] NeighbourhoodMaps Between() const {
    return {{&places_, &odometry_}, {&places_, &odometry_}, std::nullopt};
  }

 private:
  std::map<SubmapId, Place> places_;
  std::map<SubmapId, OdometryPose> odometry_;
};

Match Accepted(const int reference, const int query, const Rigid2& pose,
               const double score) {
  Match match;
  match.pair = {{0, reference}, {0, query}, pose, score};
  match.verdict = Verdict::kAccepted;
  return match;
}

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
  const Corridor corridor;
  // The query is in the room of submap 1, or in that of submap 4.
  EXPECT_THAT(IsAccepted(corridor.Between(), {Accepted(1, 0, Rigid2(), 6.),
                                              Accepted(4, 0, Rigid2(), 5.)}),
              ElementsAre(false, false));
  // Far likelier than the other.
  EXPECT_THAT(IsAccepted(corridor.Between(), {Accepted(1, 0, Rigid2(), 6.),
                                              Accepted(4, 0, Rigid2(), 3.5)}),
              ElementsAre(true, false));
}

TEST(RefuseRivalMatchesTest, MapAndQueryAreAlike) {
  const Corridor corridor;
  EXPECT_THAT(IsAccepted(corridor.Between(), {Accepted(0, 1, Rigid2(), 6.),
                                              Accepted(0, 4, Rigid2(), 5.)}),
              ElementsAre(false, false));
}

TEST(RefuseRivalMatchesTest, WhatAgreesIsNoRival) {
  const Corridor corridor;
  // Both put the query in the same room, but for some drift.
  EXPECT_THAT(IsAccepted(corridor.Between(),
                         {Accepted(1, 0, Rigid2(10., 0., 0.), 6.),
                          Accepted(2, 0, Rigid2(0.5, 1., 0.1), 6.)}),
              ElementsAre(true, true));
  // Of different queries.
  EXPECT_THAT(IsAccepted(corridor.Between(), {Accepted(1, 0, Rigid2(), 6.),
                                              Accepted(4, 3, Rigid2(), 6.)}),
              ElementsAre(true, true));
}

TEST(RefuseRivalMatchesTest, ATurnedPoseIsARival) {
  const Corridor corridor;
  EXPECT_THAT(
      IsAccepted(corridor.Between(), {Accepted(1, 0, Rigid2(10., 0., 0.), 6.),
                                      Accepted(2, 0, Rigid2(0., 0., 3.1), 6.)}),
      ElementsAre(false, false));
}

// Within one map a submap is the query of one pair and the reference of
// another.
TEST(RefuseRivalMatchesTest, WithinAMapEitherSideIsShared) {
  const Corridor corridor;
  EXPECT_THAT(IsAccepted(corridor.Within(), {Accepted(1, 9, Rigid2(), 6.),
                                             Accepted(9, 15, Rigid2(), 6.)}),
              ElementsAre(false, false));
}

TEST(RefuseRivalMatchesTest, ARivalTakesFromTheScore) {
  const Corridor corridor;
  std::vector<Match> matches = {Accepted(1, 0, Rigid2(), 9.),
                                Accepted(4, 0, Rigid2(), 2.)};
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
  const Corridor corridor;
  std::vector<Match> matches = {Accepted(1, 0, Rigid2(), 2000.),
                                Accepted(4, 0, Rigid2(), 1000.)};
  RefuseRivalMatches(RivalMatchOptions(), JudgementOptions(),
                     corridor.Between(), &matches);
  EXPECT_EQ(matches[0].pair.score, 1500.);
  EXPECT_EQ(matches[1].pair.score, 0.);
}

TEST(RefuseRivalMatchesTest, WithoutARivalNothingChanges) {
  const Corridor corridor;
  std::vector<Match> matches = {Accepted(1, 0, Rigid2(), 6.)};
  RefuseRivalMatches(RivalMatchOptions(), JudgementOptions(),
                     corridor.Between(), &matches);
  EXPECT_EQ(matches[0].pair.score, 6.);
  EXPECT_EQ(matches[0].verdict, Verdict::kAccepted);
}

TEST(RefuseRivalMatchesTest, WhatIsLeftOfTheScoreMustSuffice) {
  const Corridor corridor;
  JudgementOptions judgement;
  // 6 - 0.5 ln(1 + e^4) = 3.99.
  std::vector<Match> matches = {Accepted(1, 0, Rigid2(), 6.),
                                Accepted(4, 0, Rigid2(), 4.)};
  judgement.min_score = 3.9;
  RefuseRivalMatches(RivalMatchOptions(), judgement, corridor.Between(),
                     &matches);
  EXPECT_EQ(matches[0].verdict, Verdict::kAccepted);
  matches[0] = Accepted(1, 0, Rigid2(), 6.);
  matches[1] = Accepted(4, 0, Rigid2(), 4.);
  judgement.min_score = 4.1;
  RefuseRivalMatches(RivalMatchOptions(), judgement, corridor.Between(),
                     &matches);
  EXPECT_EQ(matches[0].verdict, Verdict::kAmbiguous);
}

TEST(RefuseRivalMatchesTest, AnythingMayLieBeyondABrokenLink) {
  const testing::TwoVisits visits;
  const testing::SlippedVisit slipped(visits);
  const TrajectoryLinks links(TrajectoryLinkOptions(), VerificationOptions(),
                              slipped.Places(), MakeExecutor(1));
  const Corridor corridor;
  NeighbourhoodMaps maps = corridor.Between();
  maps.reference_links = &links;
  // From submap 10 to 12 of the trajectory.
  EXPECT_THAT(IsAccepted(maps, {Accepted(5, 0, Rigid2(), 6.),
                                Accepted(15, 0, Rigid2(), 6.)}),
              ElementsAre(true, true));
  EXPECT_THAT(IsAccepted(maps, {Accepted(1, 0, Rigid2(), 6.),
                                Accepted(5, 0, Rigid2(), 6.)}),
              ElementsAre(false, false));
}

TEST(RefuseRivalMatchesTest, LocalSlamMayDrift) {
  const Corridor corridor;
  RivalMatchOptions options;
  options.max_drift_per_meter = 1.1;
  EXPECT_THAT(
      IsAccepted(corridor.Between(),
                 {Accepted(1, 0, Rigid2(), 6.), Accepted(4, 0, Rigid2(), 5.)},
                 options),
      ElementsAre(true, true));
}

TEST(RefuseRivalMatchesTest, TheOrderDoesNotMatter) {
  const Corridor corridor;
  std::vector<Match> matches = {
      Accepted(1, 0, Rigid2(), 6.), Accepted(4, 0, Rigid2(), 5.),
      Accepted(8, 0, Rigid2(), 8.), Accepted(8, 3, Rigid2(), 8.)};
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
