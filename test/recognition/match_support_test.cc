// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/match_support.h"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/corridor_map.h"

namespace cartographer_sdf::match_support_test {
namespace {

using testing::AcceptedMatch;
using ::testing::Contains;
using testing::CorridorMap;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

// Found, and too unlikely to be accepted by itself.
Match Unlikely(const int reference, const int query, const Rigid2& pose,
               const double score) {
  Match match = AcceptedMatch(reference, query, pose, score);
  match.verdict = Verdict::kUnlikely;
  return match;
}

std::vector<std::string> Verdicts(const NeighbourhoodMaps& maps,
                                  std::vector<Match> matches,
                                  const MatchSupportOptions& options = {}) {
  JudgeBySupport(options, maps, &matches);
  std::vector<std::string> verdicts;
  for (const Match& match : matches) {
    verdicts.emplace_back(VerdictName(match.verdict));
  }
  return verdicts;
}

// The corridor was driven twice: submap 10 sees the room of submap 0 again.
const Rigid2 kSame;

TEST(JudgeBySupportTest, ACertainMatchStandsAlone) {
  const CorridorMap corridor;
  EXPECT_THAT(Verdicts(corridor.Within(), {AcceptedMatch(0, 10, kSame, 7.)}),
              ElementsAre("accepted"));
  EXPECT_THAT(Verdicts(corridor.Within(), {AcceptedMatch(0, 10, kSame, 6.9)}),
              ElementsAre("uncertain"));
}

TEST(JudgeBySupportTest, ACertainMatchSupportsLikelyOnesAroundIt) {
  const CorridorMap corridor;
  for (const NeighbourhoodMaps& maps :
       {corridor.Within(), corridor.Between()}) {
    EXPECT_THAT(Verdicts(maps, {AcceptedMatch(0, 10, kSame, 7.),
                                AcceptedMatch(1, 11, kSame, 5.),
                                Unlikely(2, 12, kSame, 1.),
                                Unlikely(3, 13, kSame, 0.9)}),
                ElementsAre("accepted", "accepted", "accepted", "unlikely"));
  }
}

TEST(JudgeBySupportTest, CountsWhatSupports) {
  const CorridorMap corridor;
  std::vector<Match> matches = {AcceptedMatch(0, 10, kSame, 8.),
                                AcceptedMatch(1, 11, kSame, 8.),
                                Unlikely(2, 12, kSame, 2.)};
  JudgeBySupport(MatchSupportOptions(), corridor.Within(), &matches);
  EXPECT_EQ(matches[0].num_supporting, 1);
  EXPECT_EQ(matches[1].num_supporting, 1);
  EXPECT_EQ(matches[2].num_supporting, 2);
}

// The order of the two submaps of a pair within one map means nothing.
TEST(JudgeBySupportTest, WithinAMapEitherSubmapIsTheReference) {
  const CorridorMap corridor;
  // Driven back: submap 9 sees the room of 6 again, submap 8 that of 7.
  const Rigid2 turned(0., 0., M_PI);
  EXPECT_THAT(Verdicts(corridor.Within(), {AcceptedMatch(6, 9, turned, 8.),
                                           Unlikely(7, 8, turned, 2.)}),
              ElementsAre("accepted", "accepted"));
  EXPECT_THAT(Verdicts(corridor.Within(), {AcceptedMatch(6, 9, turned, 8.),
                                           Unlikely(8, 7, turned, 2.)}),
              ElementsAre("accepted", "accepted"));
  // Between two maps it means which map.
  EXPECT_THAT(Verdicts(corridor.Between(), {AcceptedMatch(0, 9, kSame, 8.),
                                            Unlikely(9, 0, kSame, 2.)}),
              ElementsAre("accepted", "unlikely"));
}

TEST(JudgeBySupportTest, OnlyWhatLiesWhereItIsPredictedIsSupported) {
  const CorridorMap corridor;
  const auto verdict_at = [&corridor](const Rigid2& pose) {
    return Verdicts(corridor.Within(), {AcceptedMatch(0, 10, kSame, 8.),
                                        Unlikely(1, 11, pose, 3.)})[1];
  };
  EXPECT_EQ(verdict_at(Rigid2(0.45, 0., 0.05)), "accepted");
  EXPECT_EQ(verdict_at(Rigid2(0.55, 0., 0.)), "unlikely");
  EXPECT_EQ(verdict_at(Rigid2(0., 0., 0.12)), "unlikely");
  // One room further.
  EXPECT_EQ(verdict_at(Rigid2(10., 0., 0.)), "unlikely");
}

TEST(JudgeBySupportTest, ManyThatPutItElsewhereRefuseACertainMatch) {
  const CorridorMap corridor;
  // 20 m were driven between, ten on either side: 0.2 m and 0.045 rad of drift.
  for (const NeighbourhoodMaps& maps :
       {corridor.Within(), corridor.Between()}) {
    const auto verdict_at = [&maps](const Rigid2& pose) {
      return Verdicts(maps, {AcceptedMatch(1, 11, kSame, 8.),
                             AcceptedMatch(2, 12, pose, 9.),
                             AcceptedMatch(3, 13, kSame, 8.)})[1];
    };
    EXPECT_EQ(verdict_at(Rigid2(0.94, 0., 0.)), "accepted");
    EXPECT_EQ(verdict_at(Rigid2(0.96, 0., 0.)), "uncertain");
    EXPECT_EQ(verdict_at(Rigid2(0., 0., 0.19)), "accepted");
    EXPECT_EQ(verdict_at(Rigid2(0., 0., 0.2)), "uncertain");
    EXPECT_EQ(verdict_at(Rigid2(0., 0., M_PI)), "uncertain");
  }
}

TEST(JudgeBySupportTest, UpToTwiceAsManyAgainstAsForItDoNotRefuseAMatch) {
  const CorridorMap corridor;
  const Rigid2 shifted(10., 0., 0.);
  EXPECT_THAT(Verdicts(corridor.Within(), {AcceptedMatch(1, 11, kSame, 8.),
                                           AcceptedMatch(2, 12, kSame, 8.),
                                           AcceptedMatch(3, 13, shifted, 8.)}),
              ElementsAre("accepted", "accepted", "uncertain"));
  EXPECT_THAT(Verdicts(corridor.Within(), {AcceptedMatch(1, 11, kSame, 8.),
                                           AcceptedMatch(2, 12, kSame, 8.),
                                           AcceptedMatch(3, 13, shifted, 8.),
                                           AcceptedMatch(4, 14, shifted, 8.)}),
              ElementsAre("accepted", "accepted", "accepted", "accepted"));
  // Nothing tells which of two is right.
  EXPECT_THAT(Verdicts(corridor.Within(), {AcceptedMatch(1, 11, kSame, 8.),
                                           AcceptedMatch(2, 12, shifted, 12.)}),
              ElementsAre("uncertain", "uncertain"));
}

TEST(JudgeBySupportTest, WhatIsOutvotedIsNotAcceptedForItsSupport) {
  const CorridorMap corridor;
  const Rigid2 shifted(10., 0., 0.);
  std::vector<Match> matches = {
      AcceptedMatch(0, 10, kSame, 8.), AcceptedMatch(1, 11, shifted, 8.),
      AcceptedMatch(3, 13, shifted, 8.), AcceptedMatch(4, 14, shifted, 8.),
      Unlikely(2, 12, kSame, 3.)};
  JudgeBySupport(MatchSupportOptions(), corridor.Within(), &matches);
  EXPECT_EQ(matches[4].num_supporting, 1);
  EXPECT_EQ(matches[4].num_opposing, 3);
  EXPECT_EQ(matches[4].verdict, Verdict::kUnlikely);
}

TEST(JudgeBySupportTest, FarOnesDoNotSupport) {
  const CorridorMap corridor;
  EXPECT_THAT(Verdicts(corridor.Within(), {AcceptedMatch(0, 10, kSame, 8.),
                                           Unlikely(5, 15, kSame, 3.)}),
              ElementsAre("accepted", "unlikely"));
}

TEST(JudgeBySupportTest, WhatIsSupportedAndLikelySupportsInItsTurn) {
  const CorridorMap corridor;
  // Submaps 0, 4 and 8: each supports the next.
  EXPECT_THAT(Verdicts(corridor.Between(), {Unlikely(8, 8, kSame, 2.),
                                            AcceptedMatch(4, 4, kSame, 5.),
                                            AcceptedMatch(0, 0, kSame, 8.)}),
              ElementsAre("accepted", "accepted", "accepted"));
  // What is accepted for its support alone does not.
  EXPECT_THAT(Verdicts(corridor.Between(),
                       {Unlikely(8, 8, kSame, 2.), Unlikely(4, 4, kSame, 3.),
                        AcceptedMatch(0, 0, kSame, 8.)}),
              ElementsAre("unlikely", "accepted", "accepted"));
  // Likely ones that no certain match supports do not support each other.
  EXPECT_THAT(Verdicts(corridor.Between(), {AcceptedMatch(0, 0, kSame, 6.),
                                            AcceptedMatch(1, 1, kSame, 6.)}),
              ElementsAre("uncertain", "uncertain"));
}

// Likely, and no other pose of the pair does nearly as well.
Match WithoutRival(Match match) {
  match.margin = kMaxMargin;
  return match;
}

// What is likely, in two places that share no scans; the first is accepted.
std::vector<Match> Together(const double first, const double second) {
  return {WithoutRival(AcceptedMatch(0, 10, kSame, first)),
          WithoutRival(Unlikely(2, 12, kSame, second))};
}

TEST(JudgeBySupportTest, LikelyOnesWithoutRivalsAreCertainTogether) {
  const CorridorMap corridor;
  for (const NeighbourhoodMaps& maps :
       {corridor.Within(), corridor.Between()}) {
    EXPECT_THAT(Verdicts(maps, Together(4.5, 4.5)),
                ElementsAre("accepted", "accepted"));
    EXPECT_THAT(Verdicts(maps, Together(4.5, 4.4)),
                ElementsAre("uncertain", "unlikely"));
    // They support others, as a certain one does.
    std::vector<Match> matches = Together(4.6, 4.6);
    matches.push_back(Unlikely(4, 14, kSame, 1.));
    EXPECT_THAT(Verdicts(maps, matches),
                ElementsAre("accepted", "accepted", "accepted"));
    matches[1].margin = 0.99 * kMaxMargin;
    EXPECT_THAT(Verdicts(maps, matches),
                ElementsAre("uncertain", "unlikely", "unlikely"));
    // One of them must be accepted by itself.
    matches = Together(4.6, 4.6);
    matches[0].verdict = Verdict::kUnlikely;
    EXPECT_THAT(Verdicts(maps, matches), ElementsAre("unlikely", "unlikely"));
  }
}

TEST(JudgeBySupportTest, WhatACertainMatchReachesItSupportsByItself) {
  const CorridorMap corridor;
  // Submap 4 supports 8, which is only likely and supports no other.
  std::vector<Match> matches = {WithoutRival(AcceptedMatch(4, 4, kSame, 7.)),
                                WithoutRival(Unlikely(8, 8, kSame, 3.9)),
                                WithoutRival(Unlikely(12, 12, kSame, 3.9))};
  EXPECT_THAT(Verdicts(corridor.Between(), matches),
              ElementsAre("accepted", "accepted", "unlikely"));
}

TEST(JudgeBySupportTest, WhatIsCertainTogetherHasNoRivalElsewhere) {
  const CorridorMap corridor;
  std::vector<Match> matches = Together(4.6, 4.6);
  matches[0].has_rival = true;
  EXPECT_THAT(Verdicts(corridor.Within(), matches),
              ElementsAre("uncertain", "unlikely"));
  matches = Together(4.6, 4.6);
  matches[0].verdict = Verdict::kContradicted;
  EXPECT_THAT(Verdicts(corridor.Within(), matches),
              ElementsAre("contradicted", "unlikely"));
}

TEST(JudgeBySupportTest, SubmapsThatShareScansCountOnce) {
  const CorridorMap corridor;
  for (const NeighbourhoodMaps& maps :
       {corridor.Within(), corridor.Between()}) {
    // Many that overlap say no more than the best of them, ...
    EXPECT_THAT(
        Verdicts(maps,
                 {WithoutRival(AcceptedMatch(0, 10, kSame, 4.9)),
                  WithoutRival(Unlikely(1, 11, kSame, 4.9)),
                  WithoutRival(Unlikely(1, 10, Rigid2(-10., 0., 0.), 4.9)),
                  WithoutRival(Unlikely(0, 11, Rigid2(10., 0., 0.), 4.9))}),
        Not(Contains("accepted")));
    // ... also where they do on one side only, or through others between.
    EXPECT_THAT(
        Verdicts(maps,
                 {WithoutRival(AcceptedMatch(0, 10, kSame, 4.9)),
                  WithoutRival(Unlikely(3, 11, Rigid2(-20., 0., 0.), 4.9))}),
        Not(Contains("accepted")));
    EXPECT_THAT(Verdicts(maps, {WithoutRival(AcceptedMatch(0, 10, kSame, 4.)),
                                WithoutRival(Unlikely(1, 11, kSame, 2.)),
                                WithoutRival(Unlikely(2, 12, kSame, 4.)),
                                WithoutRival(Unlikely(4, 14, kSame, 1.))}),
                Each("accepted"));
  }
  // Within one map, either submap of a pair may be the reference.
  const std::vector<Match> crossed = {
      WithoutRival(AcceptedMatch(0, 10, kSame, 4.9)),
      WithoutRival(Unlikely(11, 1, kSame, 4.9))};
  EXPECT_THAT(Verdicts(corridor.Within(), crossed), Not(Contains("accepted")));
}

TEST(JudgeBySupportTest, OnlyMatchesThatAgreeAreCertainTogether) {
  const CorridorMap corridor;
  EXPECT_THAT(
      Verdicts(corridor.Within(),
               {WithoutRival(AcceptedMatch(0, 10, kSame, 4.9)),
                WithoutRival(Unlikely(2, 12, Rigid2(0.6, 0., 0.), 4.9))}),
      Not(Contains("accepted")));
  // Nor far ones.
  EXPECT_THAT(Verdicts(corridor.Within(),
                       {WithoutRival(AcceptedMatch(0, 10, kSame, 4.9)),
                        WithoutRival(Unlikely(5, 15, kSame, 4.9))}),
              Not(Contains("accepted")));
}

TEST(JudgeBySupportTest, OtherReasonsForRefusalStay) {
  const CorridorMap corridor;
  for (const Verdict verdict :
       {Verdict::kTooLittleOverlap, Verdict::kContradicted,
        Verdict::kDegenerate, Verdict::kAmbiguous}) {
    Match refused = AcceptedMatch(1, 11, kSame, 9.);
    refused.verdict = verdict;
    // Nor does it support.
    EXPECT_THAT(
        Verdicts(corridor.Within(), {refused, Unlikely(2, 12, kSame, 3.)}),
        ElementsAre(VerdictName(verdict), "unlikely"));
    EXPECT_THAT(
        Verdicts(corridor.Within(), {refused, AcceptedMatch(0, 10, kSame, 8.)}),
        ElementsAre(VerdictName(verdict), "accepted"));
  }
  Match with_rival = Unlikely(1, 11, kSame, 3.);
  with_rival.has_rival = true;
  EXPECT_THAT(Verdicts(corridor.Within(),
                       {with_rival, AcceptedMatch(0, 10, kSame, 8.)}),
              ElementsAre("unlikely", "accepted"));
}

TEST(JudgeBySupportTest, NothingSupportsAcrossABrokenLink) {
  const TrajectoryLinks links = testing::LinksBrokenAtTen();
  const CorridorMap corridor;
  NeighbourhoodMaps maps = corridor.Between();
  maps.reference_links = &links;
  EXPECT_THAT(
      Verdicts(maps, {AcceptedMatch(10, 2, kSame, 8.),
                      Unlikely(12, 4, kSame, 3.), Unlikely(8, 0, kSame, 3.)}),
      ElementsAre("accepted", "unlikely", "accepted"));
  // Nor does it oppose.
  EXPECT_THAT(Verdicts(maps, {AcceptedMatch(10, 2, kSame, 8.),
                              AcceptedMatch(12, 4, Rigid2(5., 0., 0.), 8.)}),
              ElementsAre("accepted", "accepted"));
}

TEST(JudgeBySupportTest, IsIndependentOfTheOrder) {
  const CorridorMap corridor;
  std::vector<Match> matches = {
      AcceptedMatch(0, 0, kSame, 8.), AcceptedMatch(3, 3, kSame, 5.),
      AcceptedMatch(6, 6, kSame, 4.5), Unlikely(9, 9, kSame, 2.)};
  const std::vector<std::string> verdicts =
      Verdicts(corridor.Between(), matches);
  std::reverse(matches.begin(), matches.end());
  std::vector<std::string> reversed = Verdicts(corridor.Between(), matches);
  std::reverse(reversed.begin(), reversed.end());
  EXPECT_EQ(verdicts, reversed);
}

TEST(JudgeBySupportTest, ExtremeIndices) {
  const CorridorMap corridor;
  std::vector<Match> matches = {AcceptedMatch(0, 19, kSame, 8.),
                                AcceptedMatch(19, 0, kSame, 8.)};
  JudgeBySupport(MatchSupportOptions(), corridor.Between(), &matches);
  EXPECT_EQ(matches[0].num_supporting, 0);
  EXPECT_EQ(matches[1].num_supporting, 0);
}

TEST(MatchSupportOptionsTest, ValidatesOptions) {
  EXPECT_EQ(Validate(MatchSupportOptions()), "");
  const auto error = [](auto change) {
    MatchSupportOptions options;
    change(&options);
    return Validate(options);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(error([&](auto* o) { o->min_unsupported_score = nan; }),
              HasSubstr("finite"));
  EXPECT_THAT(error([&](auto* o) { o->min_supported_score = 8.; }),
              HasSubstr("must not exceed"));
  EXPECT_THAT(error([&](auto* o) { o->max_index_distance = -1; }),
              HasSubstr("max_index_distance"));
  EXPECT_THAT(error([&](auto* o) { o->max_distance_meters = nan; }),
              HasSubstr("max_distance_meters"));
  EXPECT_THAT(error([&](auto* o) { o->max_rotation = -1.; }),
              HasSubstr("max_rotation"));
}

TEST(FindSupportingGroupsTest, WhatSupportsEachOtherIsOne) {
  const CorridorMap corridor;
  const std::vector<Match> matches = {
      AcceptedMatch(0, 10, kSame, 5.), AcceptedMatch(1, 11, kSame, 5.),
      Unlikely(2, 12, kSame, 3.), AcceptedMatch(3, 13, kSame, 5.),
      // One room further, and far away.
      AcceptedMatch(2, 12, Rigid2(10., 0., 0.), 5.),
      AcceptedMatch(8, 18, kSame, 5.)};
  const auto is_accepted = [](const Match& match) {
    return match.verdict == Verdict::kAccepted;
  };
  EXPECT_THAT(FindSupportingGroups(MatchSupportOptions(), corridor.Between(),
                                   matches, is_accepted),
              ElementsAre(UnorderedElementsAre(0, 1, 3), ElementsAre(4),
                          ElementsAre(5)));
}

}  // namespace
}  // namespace cartographer_sdf::match_support_test
