// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/neighbourhood_verification.h"

#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/two_visits.h"

namespace cartographer_sdf::neighbourhood_verification_test {
namespace {

using testing::IsPoseNear;
using testing::TwoVisits;

constexpr double kDegree = M_PI / 180.;
constexpr double kHalfACell = 0.025;

void Forwards(const size_t n, const std::function<void(size_t)>& task) {
  for (size_t k = 0; k != n; ++k) task(k);
}
void Backwards(const size_t n, const std::function<void(size_t)>& task) {
  for (size_t k = n; k != 0; --k) task(k - 1);
}

// The match of the west rooms alone, as if the features of the east rooms had
// failed.
std::vector<Match> WestMatch(const TwoVisits& visits) {
  const auto& places = *visits.Places().places;
  std::optional<Match> match =
      MatchPlaces(MatchOptions(), places.at(TwoVisits::kWestFirst),
                  places.at(TwoVisits::kWestAgain));
  CHECK(match.has_value());
  return {*std::move(match)};
}

std::vector<Match> Judged(const TwoVisits& visits, std::vector<Match> matches,
                          const Executor& executor = &Forwards) {
  return VerifyNeighbourhoods(NeighbourhoodOptions(), MatchOptions(),
                              {visits.Places(), visits.Places(), 3},
                              std::move(matches), executor);
}

const Match* Find(const std::vector<Match>& matches, const SubmapId& reference,
                  const SubmapId& query) {
  for (const Match& match : matches) {
    if (match.pair.reference == reference && match.pair.query == query) {
      return &match;
    }
  }
  return nullptr;
}

TEST(VerifyNeighbourhoodsTest, FindsWhatOnlyNeighboursPropose) {
  const TwoVisits visits(Rigid2(0.1, -0.1, 1.5 * kDegree));
  const std::vector<Match> judged = Judged(visits, WestMatch(visits));
  const Match* const east =
      Find(judged, TwoVisits::kEastFirst, TwoVisits::kEastAgain);
  ASSERT_NE(east, nullptr);
  EXPECT_STREQ(VerdictName(east->verdict), "accepted");
  EXPECT_THAT(
      east->pair.T_reference_query,
      IsPoseNear(visits.T_world_submap(TwoVisits::kEastFirst).Inverse() *
                     visits.T_world_submap(TwoVisits::kEastAgain),
                 0.05, 0.5 * kDegree));
  EXPECT_GT(east->inliers.size(), 0);
  const Match* const west =
      Find(judged, TwoVisits::kWestFirst, TwoVisits::kWestAgain);
  ASSERT_NE(west, nullptr);
  ASSERT_TRUE(west->neighbourhood.has_value());
  EXPECT_EQ(west->pair.score,
            NeighbourhoodScore(NeighbourhoodOptions(), west->pair_score,
                               *west->neighbourhood));
}

TEST(VerifyNeighbourhoodsTest, NeighboursMakeTheRightMatchMoreCertain) {
  const TwoVisits visits;
  const Match match = WestMatch(visits).front();
  const std::vector<Match> judged = Judged(visits, {match});
  const Match* const west =
      Find(judged, TwoVisits::kWestFirst, TwoVisits::kWestAgain);
  ASSERT_NE(west, nullptr);
  EXPECT_GT(west->pair.score,
            NeighbourhoodScore(NeighbourhoodOptions(), match.pair_score, {}));
}

TEST(VerifyNeighbourhoodsTest, RefusesAMatchThatNeighboursContradict) {
  const TwoVisits visits;
  const std::vector<Match> matches = WestMatch(visits);
  // The rooms agree just as well, but local SLAM says that the east room was
  // seen elsewhere: as between look-alikes.
  const TwoVisits elsewhere(Rigid2(-2.5, 1., 0.4));
  const std::vector<Match> judged_elsewhere = Judged(elsewhere, matches);
  const Match* const look_alike =
      Find(judged_elsewhere, TwoVisits::kWestFirst, TwoVisits::kWestAgain);
  ASSERT_NE(look_alike, nullptr);
  const std::vector<Match> judged = Judged(visits, matches);
  const Match* const west =
      Find(judged, TwoVisits::kWestFirst, TwoVisits::kWestAgain);
  ASSERT_NE(west, nullptr);
  EXPECT_LT(look_alike->pair.score, west->pair.score - 1.);
}

TEST(VerifyNeighbourhoodsTest, DoesNotDependOnTheOrderOfWork) {
  const TwoVisits visits;
  const std::vector<Match> one = Judged(visits, WestMatch(visits), &Forwards);
  const std::vector<Match> other =
      Judged(visits, WestMatch(visits), &Backwards);
  ASSERT_EQ(one.size(), other.size());
  ASSERT_GE(one.size(), 2u);
  for (size_t k = 0; k != one.size(); ++k) {
    EXPECT_EQ(one[k].pair.reference, other[k].pair.reference);
    EXPECT_EQ(one[k].pair.query, other[k].pair.query);
    EXPECT_EQ(one[k].pair.score, other[k].pair.score);
    if (k > 0) {
      EXPECT_LT(
          std::make_pair(one[k - 1].pair.reference, one[k - 1].pair.query),
          std::make_pair(one[k].pair.reference, one[k].pair.query));
    }
  }
}

TEST(VerifyNeighbourhoodsTest, NothingFromNothing) {
  const TwoVisits visits;
  EXPECT_TRUE(Judged(visits, {}).empty());
}

TEST(VerifyNeighbourhoodsTest, ChoosesTheRivalThatNeighboursAgreeWith) {
  const TwoVisits visits;
  Match match = WestMatch(visits).front();
  // One door further, and the right pose as a rival.
  match.rivals = {match.pair.T_reference_query};
  match.pair.T_reference_query =
      visits.T_world_submap(TwoVisits::kWestFirst).Inverse() *
      Rigid2(2., 0.5, 0.) * visits.T_world_submap(TwoVisits::kWestAgain);
  NeighbourhoodOptions options;
  options.min_proposing_score = -1e3;
  const std::vector<Match> judged = VerifyNeighbourhoods(
      options, MatchOptions(), {visits.Places(), visits.Places(), 3}, {match},
      &Forwards);
  const Match* const west =
      Find(judged, TwoVisits::kWestFirst, TwoVisits::kWestAgain);
  ASSERT_NE(west, nullptr);
  EXPECT_THAT(
      west->pair.T_reference_query,
      IsPoseNear(visits.T_west_first_west_again(), kHalfACell, 0.2 * kDegree));
  EXPECT_STREQ(VerdictName(west->verdict), "accepted");
}

TEST(VerifyNeighbourhoodsTest, UnlikelyMatchesProposeNothing) {
  const TwoVisits visits;
  NeighbourhoodOptions options;
  options.min_proposing_score = 1e3;
  const std::vector<Match> judged = VerifyNeighbourhoods(
      options, MatchOptions(), {visits.Places(), visits.Places(), 3},
      WestMatch(visits), &Forwards);
  ASSERT_EQ(judged.size(), 1u);
  EXPECT_EQ(judged[0].pair.query, TwoVisits::kWestAgain);
}

TEST(VerifyNeighbourhoodsTest, AcceptedMatchesProposeToAllPairsAroundThem) {
  const TwoVisits visits;
  NeighbourhoodOptions options;
  options.max_num_rounds = 0;
  const auto num_matches = [&] {
    return VerifyNeighbourhoods(options, MatchOptions(),
                                {visits.Places(), visits.Places(), 3},
                                WestMatch(visits), &Forwards)
        .size();
  };
  // The east rooms are two indices on.
  options.max_proposal_index_distance = 2;
  EXPECT_EQ(num_matches(), 2u);
  options.max_proposal_index_distance = 1;
  EXPECT_EQ(num_matches(), 1u);
}

// Of the pairs that only neighbours propose: three visits have three of the
// east room, two of which tie all of them.
TEST(VerifyNeighbourhoodsTest, ASubmapGetsNoMoreMatchesThanItNeeds) {
  const testing::ManyVisits visits(3);
  const auto east_matches = [&](const int max_num_matches,
                                const Executor& executor) {
    NeighbourhoodOptions options;
    options.max_num_matches_per_submap = max_num_matches;
    std::vector<IdPair> pairs;
    for (const Match& match : VerifyNeighbourhoods(
             options, MatchOptions(), {visits.Places(), visits.Places(), 3},
             visits.WestMatches(), executor)) {
      if (match.pair.reference.index % 10 == 0) continue;
      EXPECT_STREQ(VerdictName(match.verdict), "accepted");
      pairs.emplace_back(match.pair.reference, match.pair.query);
    }
    return pairs;
  };
  const IdPair a{visits.East(0), visits.East(1)};
  const IdPair b{visits.East(0), visits.East(2)};
  const IdPair c{visits.East(1), visits.East(2)};
  EXPECT_THAT(east_matches(0, &Forwards), ::testing::ElementsAre(a, b, c));
  EXPECT_THAT(east_matches(2, &Forwards), ::testing::ElementsAre(a, b, c));
  const std::vector<IdPair> bounded = east_matches(1, &Forwards);
  EXPECT_EQ(bounded.size(), 2u);
  EXPECT_EQ(east_matches(1, &Backwards), bounded);
}

// What was matched by itself is verified, however much there is.
TEST(VerifyNeighbourhoodsTest, TheBudgetTakesNoMatchAway) {
  const testing::ManyVisits visits(3);
  NeighbourhoodOptions options;
  options.max_num_matches_per_submap = 1;
  const std::vector<Match> judged = VerifyNeighbourhoods(
      options, MatchOptions(), {visits.Places(), visits.Places(), 3},
      visits.WestMatches(), &Forwards);
  for (const auto& [first, second] : {std::pair(0, 1), {0, 2}, {1, 2}}) {
    const Match* const match =
        Find(judged, visits.West(first), visits.West(second));
    ASSERT_NE(match, nullptr);
    EXPECT_STREQ(VerdictName(match->verdict), "accepted");
  }
}

// Where all matches vote.
TEST(VerifyNeighbourhoodsTest, BetweenMapsThereIsNoBudget) {
  const testing::ManyVisits visits(4);
  std::map<SubmapId, Place> references, queries;
  for (const auto& [id, place] : *visits.Places().places) {
    (id < visits.West(2) ? references : queries).emplace(id, place);
  }
  NeighbourhoodOptions options;
  options.max_num_matches_per_submap = 1;
  const auto& odometry = visits.Places().odometry;
  const std::vector<Match> judged = VerifyNeighbourhoods(
      options, MatchOptions(),
      {{&references, odometry}, {&queries, odometry}, std::nullopt},
      {visits.WestMatch(0, 2), visits.WestMatch(0, 3), visits.WestMatch(1, 2),
       visits.WestMatch(1, 3)},
      &Forwards);
  for (const auto& [first, second] :
       {std::pair(0, 2), {0, 3}, {1, 2}, {1, 3}}) {
    EXPECT_NE(Find(judged, visits.East(first), visits.East(second)), nullptr);
  }
}

// Between two maps, the map stays the reference whatever the ids.
TEST(VerifyNeighbourhoodsTest, ProposalsBetweenMapsKeepTheirSides) {
  const TwoVisits visits;
  std::map<SubmapId, Place> first, again;
  for (const auto& [id, place] : *visits.Places().places) {
    (id < TwoVisits::kWestAgain ? first : again).emplace(id, place);
  }
  const auto& odometry = visits.Places().odometry;
  Match turned = WestMatch(visits).front();
  std::swap(turned.pair.reference, turned.pair.query);
  turned.pair.T_reference_query = turned.pair.T_reference_query.Inverse();
  const std::vector<Match> judged = VerifyNeighbourhoods(
      NeighbourhoodOptions(), MatchOptions(),
      {{&again, odometry}, {&first, odometry}, std::nullopt}, {turned},
      &Forwards);
  const Match* const east =
      Find(judged, TwoVisits::kEastAgain, TwoVisits::kEastFirst);
  ASSERT_NE(east, nullptr);
  EXPECT_THAT(
      east->pair.T_reference_query,
      IsPoseNear(visits.T_world_submap(TwoVisits::kEastAgain).Inverse() *
                     visits.T_world_submap(TwoVisits::kEastFirst),
                 kHalfACell, 0.2 * kDegree));
}

TEST(VerifyNeighbourhoodTest, FillsInScoreVerdictAndEvidence) {
  const TwoVisits visits;
  const NeighbourhoodOptions options;
  const MatchOptions match_options;
  Match match = WestMatch(visits).front();
  const Match before = match;
  const NeighbourhoodMaps maps{visits.Places(), visits.Places(), 3};
  VerifyNeighbourhood(options, match_options, maps, &match);
  const NeighbourhoodEvidence expected =
      NeighbourhoodMeter(options, match_options.verification, maps)
          .Measure(before.pair)
          .evidence;
  ASSERT_TRUE(match.neighbourhood.has_value());
  ASSERT_GE(expected.num_pairs, 1);
  EXPECT_EQ(match.neighbourhood->num_pairs, expected.num_pairs);
  EXPECT_EQ(match.neighbourhood->wall_length, expected.wall_length);
  EXPECT_EQ(match.neighbourhood->contradicting_length,
            expected.contradicting_length);
  EXPECT_EQ(match.pair_score, before.pair_score);
  EXPECT_EQ(match.pair.score,
            NeighbourhoodScore(options, before.pair_score, expected));
  EXPECT_EQ(match.verdict,
            Judge(match_options.verification.judgement, before.evidence,
                  match.pair.score, before.margin));
  EXPECT_EQ(match.pair.T_reference_query.translation(),
            before.pair.T_reference_query.translation());
  EXPECT_EQ(match.verdict, Verdict::kAccepted);
  // The score in the neighbourhood is the one that is judged.
  MatchOptions strict = match_options;
  strict.verification.judgement.min_score = match.pair.score + 1e-6;
  VerifyNeighbourhood(options, strict, maps, &match);
  EXPECT_EQ(match.verdict, Verdict::kUnlikely);
}

TEST(VerifyNeighbourhoodTest, TheUnlikelyIsNotMeasured) {
  const TwoVisits visits;
  NeighbourhoodOptions options;
  Match match = WestMatch(visits).front();
  options.min_pair_score = match.pair_score + 1e-6;
  VerifyNeighbourhood(options, MatchOptions(),
                      {visits.Places(), visits.Places(), 3}, &match);
  ASSERT_TRUE(match.neighbourhood.has_value());
  EXPECT_EQ(match.neighbourhood->num_pairs, 0);
  EXPECT_EQ(match.pair.score,
            NeighbourhoodScore(options, match.pair_score, {}));
}

}  // namespace
}  // namespace cartographer_sdf::neighbourhood_verification_test
