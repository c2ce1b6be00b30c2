// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/neighbourhood.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "cartographer_sdf/execution/parallel_for.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/two_visits.h"

namespace cartographer_sdf::neighbourhood_test {
namespace {

using testing::IsPoseNear;
using testing::TwoVisits;

constexpr double kDegree = M_PI / 180.;
// Of a match that is likely by itself.
constexpr double kPairScore = 5.;

Neighbourhood Ask(const TwoVisits& visits, const Rigid2& T_reference_query,
                  const NeighbourhoodOptions& options = {}) {
  return NeighbourhoodMeter(options, VerificationOptions(),
                            {visits.Places(), visits.Places(), 3})
      .Measure({TwoVisits::kWestFirst, TwoVisits::kWestAgain, T_reference_query,
                kPairScore});
}

// With the match of the east rooms by themselves, `error` away from the truth.
Neighbourhood AskWithEastMatch(const TwoVisits& visits, const Rigid2& error,
                               const double score) {
  const std::pair<SubmapId, SubmapId> east{TwoVisits::kEastFirst,
                                           TwoVisits::kEastAgain};
  const OwnMatches own_matches = {
      {east,
       {east.first, east.second,
        visits.T_world_submap(east.first).Inverse() *
            visits.T_world_submap(east.second) * error,
        score}}};
  NeighbourhoodMaps maps{visits.Places(), visits.Places(), 3};
  maps.own_matches = &own_matches;
  return NeighbourhoodMeter(NeighbourhoodOptions(), VerificationOptions(), maps)
      .Measure({TwoVisits::kWestFirst, TwoVisits::kWestAgain,
                visits.T_west_first_west_again(), kPairScore});
}

bool Proposes(const Neighbourhood& neighbourhood, const SubmapId& reference,
              const SubmapId& query) {
  return std::any_of(
      neighbourhood.proposals.begin(), neighbourhood.proposals.end(),
      [&](const PairPose& proposal) {
        return proposal.reference == reference && proposal.query == query;
      });
}

TEST(NeighbourhoodTest, NeighboursOfTheRightPoseAgree) {
  const TwoVisits visits;
  const Neighbourhood right = Ask(visits, visits.T_west_first_west_again());
  // Each with its own room, at the least.
  EXPECT_GE(right.evidence.num_pairs, 1);
  // Most of the walls of both rooms, from both sides.
  EXPECT_NEAR(right.evidence.wall_length, 90., 5.);
  EXPECT_LT(right.evidence.contradicting_length,
            0.03 * right.evidence.wall_length);
  EXPECT_LT(LogContradiction(NeighbourhoodOptions(), right.evidence), 0.);
}

TEST(NeighbourhoodTest, NeighboursOfAWrongPoseContradict) {
  const TwoVisits visits;
  const Rigid2& T_world_first = visits.T_world_submap(TwoVisits::kWestFirst);
  const Rigid2& T_world_again = visits.T_world_submap(TwoVisits::kWestAgain);
  // One door further.
  const Rigid2 wrong =
      T_world_first.Inverse() * Rigid2(2., 0.5, 0.) * T_world_again;
  const NeighbourhoodEvidence evidence = Ask(visits, wrong).evidence;
  EXPECT_GE(evidence.num_pairs, 1);
  EXPECT_GT(
      LogContradiction(NeighbourhoodOptions(), evidence),
      LogContradiction(NeighbourhoodOptions(),
                       Ask(visits, visits.T_west_first_west_again()).evidence) +
          0.5);
}

TEST(NeighbourhoodTest, MatchesThatAreNotPromisingAreNotComparedFurther) {
  const TwoVisits visits;
  const auto count = [&visits](const double pair_score) {
    NeighbourhoodOptions options;
    options.min_promising_score = -2.;
    return NeighbourhoodMeter(options, VerificationOptions(),
                              {visits.Places(), visits.Places(), 3})
        .Measure({TwoVisits::kWestFirst, TwoVisits::kWestAgain,
                  visits.T_west_first_west_again(), pair_score})
        .evidence.num_pairs;
  };
  EXPECT_EQ(count(-3.), 0);
  EXPECT_GE(count(-1.), 1);
}

TEST(NeighbourhoodTest, NothingDependsOnWhatWasMeasuredBefore) {
  const TwoVisits visits;
  // With exact odometry, all submaps are neighbours: each pair is predicted in
  // either order, by each match.
  std::map<SubmapId, OdometryPose> odometry;
  const auto& places = *visits.Places().places;
  for (const auto& [id, place] : places) {
    odometry[id] = {visits.T_world_submap(id), 10. * id.index};
  }
  const TrajectoryPlaces map{&places, &odometry};
  const auto true_pair = [&visits](const SubmapId& reference,
                                   const SubmapId& query) {
    return PairPose{reference, query,
                    visits.T_world_submap(reference).Inverse() *
                        visits.T_world_submap(query)};
  };
  NeighbourhoodMaps maps{map, map, 3};
  const std::vector<PairPose> matches = {
      true_pair(TwoVisits::kWestFirst, TwoVisits::kWestAgain),
      true_pair(TwoVisits::kEastFirst, TwoVisits::kEastAgain),
      true_pair(TwoVisits::kWestFirst, TwoVisits::kEastAgain)};
  const OwnMatches own_matches = {
      {{matches[0].reference, matches[0].query}, matches[0]}};
  maps.own_matches = &own_matches;
  NeighbourhoodOptions options;
  options.num_steps = 10;
  NeighbourhoodMeter meter(options, VerificationOptions(), maps);
  for (const PairPose& match : matches) {
    const NeighbourhoodEvidence evidence = meter.Measure(match).evidence;
    const NeighbourhoodEvidence alone =
        NeighbourhoodMeter(options, VerificationOptions(), maps)
            .Measure(match)
            .evidence;
    EXPECT_EQ(evidence.num_pairs, alone.num_pairs);
    EXPECT_EQ(evidence.wall_length, alone.wall_length);
    EXPECT_EQ(evidence.contradicting_length, alone.contradicting_length);
    EXPECT_GE(evidence.num_pairs, 3);
    EXPECT_LT(evidence.contradicting_length, 0.03 * evidence.wall_length);
  }
}

TEST(NeighbourhoodTest, ProposesPosesThatCorrectTheDriftInBetween) {
  // Off by this once the other room is reached.
  const Rigid2 drift(0.1, -0.1, 1.5 * kDegree);
  const TwoVisits visits(drift);
  const Neighbourhood neighbourhood =
      Ask(visits, visits.T_west_first_west_again());
  const Rigid2 expected =
      visits.T_world_submap(TwoVisits::kEastFirst).Inverse() *
      visits.T_world_submap(TwoVisits::kEastAgain);
  bool is_proposed = false;
  for (const PairPose& proposal : neighbourhood.proposals) {
    if (proposal.reference != TwoVisits::kEastFirst ||
        proposal.query != TwoVisits::kEastAgain) {
      continue;
    }
    is_proposed = true;
    // A cell, in the middle of the room.
    EXPECT_THAT(proposal.T_reference_query,
                IsPoseNear(expected, 0.05, 0.5 * kDegree));
  }
  EXPECT_TRUE(is_proposed);
}

TEST(NeighbourhoodTest, LeavesOutPairsThatShareScans) {
  const TwoVisits visits;
  const auto count = [&](const std::optional<int> min_index_gap) {
    return NeighbourhoodMeter(NeighbourhoodOptions(), VerificationOptions(),
                              {visits.Places(), visits.Places(), min_index_gap})
        .Measure({TwoVisits::kWestFirst, TwoVisits::kWestAgain,
                  visits.T_west_first_west_again()})
        .evidence.num_pairs;
  };
  EXPECT_GT(count(3), 0);
  // All of them are of one trajectory.
  EXPECT_EQ(count(1000), 0);
  EXPECT_GE(count(std::nullopt), count(3));
}

TEST(NeighbourhoodTest, NothingWithoutNeighbours) {
  const TwoVisits visits;
  NeighbourhoodOptions options;
  options.num_steps = 0;
  const Neighbourhood neighbourhood =
      Ask(visits, visits.T_west_first_west_again(), options);
  EXPECT_EQ(neighbourhood.evidence.num_pairs, 0);
  EXPECT_TRUE(neighbourhood.proposals.empty());
  EXPECT_EQ(LogContradiction(options, neighbourhood.evidence), 0.);
}

TEST(NeighbourhoodTest, IndicesMayBeAsLargeAsTheyLike) {
  constexpr int kLast = std::numeric_limits<int>::max();
  const TwoVisits visits;
  std::map<SubmapId, Place> places;
  std::map<SubmapId, OdometryPose> odometry;
  for (const SubmapId& id : {SubmapId{0, 0}, SubmapId{0, kLast}}) {
    Place place = visits.Places().places->at(TwoVisits::kWestFirst);
    place.id = id;
    places.emplace(id, place);
    odometry[id] = {};
  }
  const TrajectoryPlaces map{&places, &odometry};
  EXPECT_EQ(NeighbourhoodMeter(NeighbourhoodOptions(), VerificationOptions(),
                               {map, map, 3})
                .Measure({{0, 0}, {0, kLast}, Rigid2()})
                .evidence.num_pairs,
            0);
}

TEST(NeighbourhoodTest, AMatchWherePredictedConfirms) {
  const TwoVisits visits;
  // Nearer than max_prediction_error_meters; a match that is unlikely by
  // itself, in a room whose furniture was moved, confirms all the same.
  const Neighbourhood confirmed =
      AskWithEastMatch(visits, Rigid2(0.1, 0., 0.), -5.);
  // The east room is all new; next to the door, both see the same.
  EXPECT_GT(confirmed.evidence.num_confirming, 0.8);
  EXPECT_LE(confirmed.evidence.num_confirming, 1.);
  EXPECT_EQ(confirmed.evidence.num_refuting, 0.);
  EXPECT_NEAR(LogConfirmation(confirmed.evidence),
              std::log(confirmed.evidence.num_confirming + 1.), 1e-12);
  // The pair has found it already.
  EXPECT_FALSE(
      Proposes(confirmed, TwoVisits::kEastFirst, TwoVisits::kEastAgain));
}

TEST(NeighbourhoodTest, GroundThatTheMatchShowsConfirmsNothing) {
  const TwoVisits visits;
  // Without a slip: two submaps of the west room, one after the other.
  const testing::SlippedVisit again(visits, Rigid2());
  NeighbourhoodMaps maps{visits.Places(), again.Places(), std::nullopt};
  const OwnMatches own_matches = {
      {{TwoVisits::kWestFirst, TwoVisits::kEastAgain},
       {TwoVisits::kWestFirst, TwoVisits::kEastAgain, Rigid2(), 5.}}};
  maps.own_matches = &own_matches;
  const auto confirming = [&maps](const SubmapId& query, const Rigid2& pose) {
    return NeighbourhoodMeter(NeighbourhoodOptions(), VerificationOptions(),
                              maps)
        .Measure({TwoVisits::kWestFirst, query, pose})
        .evidence.num_confirming;
  };
  // The room is seen in full from either; what is new lies behind the door.
  EXPECT_LT(confirming(TwoVisits::kWestAgain, visits.T_west_first_west_again()),
            0.5);
}

TEST(NeighbourhoodTest, AMatchElsewhereRefutesByItsProbability) {
  const TwoVisits visits;
  const Neighbourhood refuted =
      AskWithEastMatch(visits, Rigid2(3., 0., 0.), std::log(0.8 / 0.2));
  EXPECT_EQ(refuted.evidence.num_confirming, 0);
  EXPECT_NEAR(refuted.evidence.num_refuting, 0.8, 1e-12);
  EXPECT_NEAR(LogConfirmation(refuted.evidence), std::log(1. / 1.8), 1e-12);
  // The walls are compared where they were predicted.
  EXPECT_EQ(refuted.evidence.contradicting_length,
            Ask(visits, visits.T_west_first_west_again())
                .evidence.contradicting_length);
  EXPECT_TRUE(Proposes(refuted, TwoVisits::kEastFirst, TwoVisits::kEastAgain));
}

TEST(NeighbourhoodTest, LeavesOutWhatLiesBeyondABrokenLink) {
  const TwoVisits visits;
  const TrajectoryLinks broken(TrajectoryLinkOptions(), VerificationOptions(),
                               testing::SlippedVisit(visits).Places(),
                               MakeExecutor(1));
  ASSERT_TRUE(
      broken.IsBrokenBetween(TwoVisits::kWestAgain, TwoVisits::kEastAgain));
  NeighbourhoodMaps maps{visits.Places(), visits.Places(), 3};
  const auto asks_east = [&] {
    return Proposes(
        NeighbourhoodMeter(NeighbourhoodOptions(), VerificationOptions(), maps)
            .Measure({TwoVisits::kWestFirst, TwoVisits::kWestAgain,
                      visits.T_west_first_west_again()}),
        TwoVisits::kEastFirst, TwoVisits::kEastAgain);
  };
  EXPECT_TRUE(asks_east());
  maps.query_links = &broken;
  EXPECT_FALSE(asks_east());
  maps.query_links = nullptr;
  // Of the other side, where nothing is broken.
  maps.reference_links = &broken;
  EXPECT_TRUE(asks_east());
}

TEST(LogContradictionTest, IsMeasuredAgainstThePrior) {
  NeighbourhoodOptions options;
  options.prior_wall_length_meters = 50.;
  options.prior_contradiction_ratio = 0.05;
  // (0.01 + 2.5 / 100) / 0.06 and (0.01 + 12.5 / 100) / 0.06.
  EXPECT_NEAR(LogContradiction(options, {4, 50., 0.}), std::log(0.035 / 0.06),
              1e-12);
  EXPECT_NEAR(LogContradiction(options, {4, 50., 10.}), std::log(0.135 / 0.06),
              1e-12);
  EXPECT_EQ(LogContradiction(options, {}), 0.);
}

TEST(NeighbourhoodScoreTest, IsLinearInItsTerms) {
  NeighbourhoodOptions options;
  options.weights = {0.5, -4., 2., -1.};
  const NeighbourhoodEvidence evidence{4, 50., 10., 2, 0.25};
  EXPECT_NEAR(NeighbourhoodScore(options, 6., evidence),
              0.5 * 6. - 4. * LogContradiction(options, evidence) +
                  2. * std::log(3. / 1.25) - 1.,
              1e-12);
}

TEST(NeighbourhoodScoreTest, NeighboursAloneMakeNothingCertain) {
  NeighbourhoodOptions options;
  options.weights = {0.5, -4., 2., -1.};
  options.max_gain = 2.5;
  // Hundreds of metres of wall, of which nothing contradicts.
  const NeighbourhoodEvidence evidence{20, 1000., 0.};
  EXPECT_GT(-4. * LogContradiction(options, evidence), 5.);
  EXPECT_EQ(NeighbourhoodScore(options, -2., evidence), 0.5);
  EXPECT_NEAR(NeighbourhoodScore(options, 10., evidence),
              0.5 * 10. - 4. * LogContradiction(options, evidence) - 1., 1e-12);
}

TEST(NeighbourhoodOptionsTest, SaysWhatIsWrong) {
  NeighbourhoodOptions options;
  EXPECT_EQ(Validate(options), "");
  options.index_step = 0;
  EXPECT_THAT(Validate(options), ::testing::HasSubstr("index_step"));
  options = {};
  options.prior_contradiction_ratio = 0.;
  EXPECT_THAT(Validate(options), ::testing::HasSubstr("prior"));
  options = {};
  options.max_gain = -1.;
  EXPECT_THAT(Validate(options), ::testing::HasSubstr("max_gain"));
  options = {};
  options.weights.bias = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(Validate(options), ::testing::HasSubstr("bias"));
}

}  // namespace
}  // namespace cartographer_sdf::neighbourhood_test
