// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/neighbourhood_verification.h"

#include <cmath>
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
                              visits.Places(), visits.Places(), 3,
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
  const std::vector<Match> right = WestMatch(visits);
  std::vector<Match> wrong = right;
  // The rooms agree just as well, but local SLAM says that the east room was
  // seen elsewhere: as between look-alikes.
  const TwoVisits elsewhere(Rigid2(-2.5, 1., 0.4));
  const std::vector<Match> judged_elsewhere = Judged(elsewhere, wrong);
  const Match* const look_alike =
      Find(judged_elsewhere, TwoVisits::kWestFirst, TwoVisits::kWestAgain);
  ASSERT_NE(look_alike, nullptr);
  const std::vector<Match> judged = Judged(visits, right);
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

}  // namespace
}  // namespace cartographer_sdf::neighbourhood_verification_test
