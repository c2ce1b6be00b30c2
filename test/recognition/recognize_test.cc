// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/recognize.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/execution/parallel_for.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/two_visits.h"

namespace cartographer_sdf::recognize_test {
namespace {

using ::testing::ElementsAre;
using Pair = std::pair<SubmapId, SubmapId>;

std::vector<Pair> PairsOf(const std::vector<Match>& matches) {
  std::vector<Pair> pairs;
  for (const Match& match : matches) {
    pairs.emplace_back(match.pair.reference, match.pair.query);
  }
  return pairs;
}

// A clock that nobody looks at.
struct UnheardClock {
  StageCallback on_stage;
  std::vector<std::pair<std::string, double>> seconds;
  StageClock clock{on_stage, &seconds};
};

std::vector<Match> RecognizeWithinMap(const RecognitionOptions& options,
                                      const TrajectoryPlaces& map,
                                      const int num_threads) {
  UnheardClock clock;
  return RecognizeWithin(options, map, MakeExecutor(num_threads), &clock.clock);
}

std::vector<Pair> Within(const RecognitionOptions& options,
                         const TrajectoryPlaces& map,
                         const int num_threads = 2) {
  return PairsOf(RecognizeWithinMap(options, map, num_threads));
}

std::vector<Pair> Between(const RecognitionOptions& options,
                          const TrajectoryPlaces& references,
                          const TrajectoryPlaces& queries) {
  UnheardClock clock;
  return PairsOf(RecognizeBetween(options, references, queries, MakeExecutor(2),
                                  &clock.clock));
}

TEST(RecognizeTest, SkipsPairsThatShareScans) {
  std::map<SubmapId, Place> places;
  std::map<SubmapId, OdometryPose> odometry;
  const Place room = *DescribePlace(
      PlaceOptions(), {},
      testing::SeeFrom(testing::TwoRooms(), Rigid2(), {{1., 2.2}, {5., 4.}}));
  for (const SubmapId& id :
       {SubmapId{0, 0}, SubmapId{0, 2}, SubmapId{0, 3}, SubmapId{1, 1}}) {
    places.emplace(id, room).first->second.id = id;
    odometry[id] = {};
  }
  const std::map<SubmapId, Place> queries = {*places.find({1, 1})};
  const TrajectoryPlaces map{&places, &odometry}, query{&queries, &odometry};
  RecognitionOptions options;
  options.verify_neighbourhoods = false;
  // With few places, retrieval proposes all of them.
  for (const bool use_retrieval : {false, true}) {
    options.use_retrieval = use_retrieval;
    EXPECT_THAT(Within(options, map),
                ElementsAre(Pair({0, 0}, {0, 3}), Pair({0, 0}, {1, 1}),
                            Pair({0, 2}, {1, 1}), Pair({0, 3}, {1, 1})));
    options.min_index_gap = 1;
    EXPECT_EQ(Within(options, map).size(), 6u);
    options.min_index_gap = 3;
    EXPECT_THAT(Between(options, map, query),
                ElementsAre(Pair({0, 0}, {1, 1}), Pair({0, 2}, {1, 1}),
                            Pair({0, 3}, {1, 1}), Pair({1, 1}, {1, 1})));
  }
  // One candidate each; either may propose.
  const std::vector<Pair> all = Within(options, map);
  options.retrieval.min_num_candidates = 1;
  options.retrieval.max_num_candidates = 1;
  for (const int num_threads : {1, 3}) {
    const std::vector<Pair> some = Within(options, map, num_threads);
    EXPECT_GE(some.size(), 2u);
    EXPECT_LT(some.size(), all.size());
    for (const Pair& pair : some) EXPECT_THAT(all, ::testing::Contains(pair));
    for (const auto& [id, place] : places) {
      // In C++17 a lambda captures no structured binding.
      const SubmapId of_place = id;
      EXPECT_TRUE(std::any_of(some.begin(), some.end(), [&](const Pair& pair) {
        return pair.first == of_place || pair.second == of_place;
      })) << id;
    }
  }
}

// Matches one query after the other.
std::vector<Match> OneByOne(const RecognitionOptions& options,
                            const TrajectoryPlaces& references,
                            const TrajectoryPlaces& queries) {
  const Executor executor = MakeExecutor(1);
  IncrementalRecognition recognition(options, references, queries, executor);
  std::vector<Match> matches;
  for (const auto& [id, place] : *queries.places) {
    matches = recognition.Add({{id, place}}, {});
  }
  return matches;
}

TEST(RecognizeTest, QueriesOneByOneEndAsAllAtOnce) {
  const testing::TwoVisits visits;
  const testing::SlippedVisit again(visits);
  UnheardClock clock;
  RecognitionOptions options;
  // An index of other queries may propose other poses.
  options.use_retrieval = false;
  for (const bool verify : {false, true}) {
    options.verify_neighbourhoods = verify;
    const std::vector<Match> at_once =
        RecognizeBetween(options, visits.Places(), again.Places(),
                         MakeExecutor(1), &clock.clock);
    ASSERT_FALSE(at_once.empty());
    const std::vector<Match> one_by_one =
        OneByOne(options, visits.Places(), again.Places());
    ASSERT_EQ(PairsOf(one_by_one), PairsOf(at_once));
    for (size_t k = 0; k < at_once.size(); ++k) {
      EXPECT_EQ(one_by_one[k].pair.score, at_once[k].pair.score);
      EXPECT_EQ(one_by_one[k].verdict, at_once[k].verdict);
    }
  }
}

TEST(RecognizeTest, VerifiesNeighbourhoodsWhereAsked) {
  const testing::TwoVisits visits;
  RecognitionOptions options;
  for (const bool verify : {false, true}) {
    options.verify_neighbourhoods = verify;
    const std::vector<Match> matches =
        RecognizeWithinMap(options, visits.Places(), 2);
    ASSERT_FALSE(matches.empty());
    for (const Match& match : matches) {
      EXPECT_EQ(match.neighbourhood.has_value(), verify);
      EXPECT_EQ(match.pair.score == match.pair_score, !verify);
    }
  }
}

TEST(RecognitionOptionsTest, AreValidated) {
  EXPECT_EQ(Validate(RecognitionOptions()), "");
  RecognitionOptions options;
  options.min_index_gap = 0;
  EXPECT_THAT(Validate(options), ::testing::HasSubstr("min_index_gap"));
  options = {};
  options.retrieval.num_stored_partners = 0;
  EXPECT_NE(Validate(options), "");
}

TEST(RecognizeTest, AWallAcrossTheNextRoomRefutesAMatchBetweenMaps) {
  const testing::TwoVisits visits;
  const TrajectoryPlaces map = visits.Places();
  // In the second map, a wall divides the east room. Furniture breaks it into
  // pieces.
  testing::Building divided = testing::TwoRooms();
  divided.push_back(testing::Wall({10.4, -0.2}, {15.6, 2.2}));
  std::map<SubmapId, Place> places = *map.places;
  const SubmapId east = testing::TwoVisits::kEastAgain;
  places.at(east) =
      *DescribePlace(PlaceOptions(), east,
                     testing::SeeFrom(divided, visits.T_world_submap(east),
                                      testing::EastRoomViewpoints()));
  RecognitionOptions options;
  // Whatever else the divided room says.
  options.neighbourhood.weights.bias = 10.;
  const auto num_accepted = [&](const double max_wall_meters) {
    options.match.verification.crossing.max_wall_meters = max_wall_meters;
    UnheardClock clock;
    const std::vector<Match> matches = RecognizeBetween(
        options, map, {&places, map.odometry}, MakeExecutor(2), &clock.clock);
    return std::count_if(matches.begin(), matches.end(), [](const Match& m) {
      return m.verdict == Verdict::kAccepted;
    });
  };
  EXPECT_GT(num_accepted(100.), 0);
  EXPECT_EQ(num_accepted(1.), 0);
}

}  // namespace
}  // namespace cartographer_sdf::recognize_test
