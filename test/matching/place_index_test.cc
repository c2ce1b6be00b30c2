// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/matching/place_index.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/feature_sets.h"

namespace cartographer_sdf::place_index_test {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;
using testing::Uniform;

constexpr int kLength = 6;

// Each with 60 features of its own.
std::map<SubmapId, FeatureSet> Places(const int count) {
  std::mt19937 engine(42);
  std::map<SubmapId, FeatureSet> places;
  for (int k = 0; k < count; ++k) {
    places[{k % 2, k}] = testing::RandomFeatures(60, 20., kLength, &engine);
  }
  return places;
}

PlaceIndex IndexOf(const RetrievalOptions& options,
                   const std::map<SubmapId, FeatureSet>& places) {
  PlaceIndex index(options);
  for (const auto& [id, features] : places) index.Add(id, features);
  return index;
}

// The features seen again, from elsewhere, a little different.
FeatureSet SeenAgain(const Rigid2& T_query_reference, const FeatureSet& set) {
  std::mt19937 engine(7);
  FeatureSet again = testing::Moved(T_query_reference, set);
  for (Eigen::Index k = 0; k < again.descriptors.size(); ++k) {
    again.descriptors.data()[k] +=
        static_cast<float>(Uniform(-0.02, 0.02, &engine));
  }
  return again;
}

// All digits, so that equal text means equal bits.
std::string Text(const std::vector<RetrievalCandidate>& candidates) {
  std::ostringstream text;
  text << std::hexfloat;
  for (const RetrievalCandidate& candidate : candidates) {
    text << candidate.id << " " << candidate.score;
    for (const Rigid2& pose : candidate.T_reference_query) {
      text << " " << pose.translation().transpose() << " " << pose.rotation();
    }
    text << "\n";
  }
  return text.str();
}

TEST(PlaceIndexTest, FindsThePlaceHoweverItIsTurned) {
  const auto places = Places(20);
  const PlaceIndex index = IndexOf({}, places);
  EXPECT_EQ(index.size(), 20u);
  for (const auto& [id, features] : places) {
    const Rigid2 T_query_reference(4. - id.index, 7., 0.7 * id.index);
    const auto candidates = index.Query(SeenAgain(T_query_reference, features));
    ASSERT_FALSE(candidates.empty());
    EXPECT_EQ(candidates[0].id, id);
    // Nothing in common with the others but chance.
    EXPECT_GT(candidates[0].score, 3. * candidates[1].score);
    ASSERT_FALSE(candidates[0].T_reference_query.empty());
    EXPECT_THAT(candidates[0].T_reference_query[0],
                testing::IsPoseNear(T_query_reference.Inverse(), 0.1, 0.02));
  }
}

TEST(PlaceIndexTest, OrderOfAddingAndWhatWasRemovedDoNotMatter) {
  const auto places = Places(13);
  const FeatureSet query = SeenAgain({1., 2., 3.}, places.at({0, 4}));
  std::vector<SubmapId> ids;
  for (const auto& place : places) {
    if (place.first.index != 5) ids.push_back(place.first);
  }
  std::mt19937 engine(1);
  std::string expected;
  for (int round = 0; round < 5; ++round) {
    PlaceIndex index{RetrievalOptions()};
    if (round > 1) index.Add({1, 5}, places.at({1, 5}));
    for (size_t k = 0; k < ids.size(); ++k) {
      if (round == 3 && k == 6) {
        EXPECT_TRUE(index.Remove({1, 5}));
      }
      index.Add(ids[k], places.at(ids[k]));
    }
    EXPECT_EQ(index.Remove({1, 5}), round == 2 || round == 4);
    const std::string text = Text(index.Query(query));
    if (round == 0) expected = text;
    EXPECT_EQ(text, expected) << round;
    testing::Shuffle(&ids, &engine);
  }
  EXPECT_FALSE(expected.empty());
}

TEST(PlaceIndexTest, RemovedAndExcludedAreNoAnswer) {
  const auto places = Places(6);
  PlaceIndex index = IndexOf({}, places);
  const FeatureSet query = SeenAgain({}, places.at({0, 2}));
  const auto without = [&index, &query](const SubmapId& id) {
    return Text(index.Query(
        query, [&id](const SubmapId& other) { return other == id; }));
  };
  ASSERT_EQ(index.Query(query)[0].id, (SubmapId{0, 2}));
  const std::string excluded = without({0, 2});
  EXPECT_TRUE(index.Contains({0, 2}));
  EXPECT_TRUE(index.Remove({0, 2}));
  EXPECT_FALSE(index.Contains({0, 2}));
  EXPECT_FALSE(index.Remove({0, 2}));
  EXPECT_THAT(excluded, ::testing::Not(HasSubstr("0,2 ")));
  // The number of submaps, which weighs votes, differs.
  EXPECT_EQ(
      index.Query(query).size(),
      static_cast<size_t>(std::count(excluded.begin(), excluded.end(), '\n')));
  index.Add({0, 2}, places.at({0, 2}));
  EXPECT_EQ(index.Query(query)[0].id, (SubmapId{0, 2}));
}

TEST(PlaceIndexTest, ScoresDecideHowManyComeOut) {
  const auto places = Places(20);
  const FeatureSet query = SeenAgain({}, places.at({0, 4}));
  RetrievalOptions options;
  // Coarse, so that every submap has something in common with the query.
  options.pairs.clearance_bin_meters = 3.;
  options.min_score = 1e6;
  options.min_num_candidates = 3;
  EXPECT_THAT(IndexOf(options, places).Query(query), SizeIs(3));
  options.min_score = 0.;
  options.max_num_candidates = 7;
  EXPECT_THAT(IndexOf(options, places).Query(query), SizeIs(7));
  options.max_num_candidates = 100;
  const auto all = IndexOf(options, places).Query(query);
  EXPECT_THAT(all, SizeIs(::testing::Gt(7u)));
  for (size_t k = 1; k < all.size(); ++k) {
    EXPECT_GE(all[k - 1].score, all[k].score);
  }
  // Below a score that no other candidate has.
  size_t count = 3;
  while (count < all.size() && all[count].score == all[count - 1].score) {
    ++count;
  }
  ASSERT_LT(count, all.size());
  options.min_score = 0.5 * (all[count - 1].score + all[count].score);
  EXPECT_THAT(IndexOf(options, places).Query(query), SizeIs(count));
}

TEST(PlaceIndexTest, FeaturesThatDifferInKindOrClearanceAreNotTheSame) {
  std::mt19937 engine(42);
  FeatureSet place = testing::RandomFeatures(40, 20., kLength, &engine);
  for (Feature& feature : place.features) {
    feature.keypoint.kind = KeypointKind::kSaddle;
    feature.keypoint.clearance = 1.1;
  }
  const PlaceIndex index = IndexOf({}, {{{0, 0}, place}});
  EXPECT_THAT(index.Query(place), SizeIs(1));
  FeatureSet other = place;
  for (Feature& feature : other.features) feature.keypoint.clearance = 1.21;
  EXPECT_THAT(index.Query(other), SizeIs(1));
  for (Feature& feature : other.features) feature.keypoint.clearance = 1.31;
  EXPECT_THAT(index.Query(other), SizeIs(0));
  for (Feature& feature : place.features) {
    feature.keypoint.kind = KeypointKind::kMaximum;
  }
  EXPECT_THAT(index.Query(place), SizeIs(0));
}

// Far more removals than the index holds submaps.
TEST(PlaceIndexTest, ForgetsWhatIsRemoved) {
  const auto places = Places(8);
  const FeatureSet query = SeenAgain({1., 2., 3.}, places.at({0, 4}));
  PlaceIndex index = IndexOf({}, places);
  const std::string expected = Text(index.Query(query));
  const size_t memory = index.MemoryUse();
  for (int round = 0; round < 50; ++round) {
    for (const auto& [id, features] : places) {
      EXPECT_TRUE(index.Remove(id));
      index.Add(id, features);
    }
  }
  EXPECT_EQ(index.size(), places.size());
  EXPECT_EQ(Text(index.Query(query)), expected);
  EXPECT_LT(index.MemoryUse(), 4 * memory);
}

TEST(PlaceIndexTest, VisitsRareKeysFirstAndNoMorePairsThanAllowed) {
  const auto places = Places(200);
  const FeatureSet query = SeenAgain({}, places.at({0, 4}));
  RetrievalOptions options;
  options.max_num_candidates = 1000;
  options.min_score = 0.;
  const auto all = IndexOf(options, places).Query(query);
  options.max_num_visited_pairs = 2000;
  const auto some = IndexOf(options, places).Query(query);
  EXPECT_LT(some.size(), all.size());
  ASSERT_FALSE(some.empty());
  EXPECT_EQ(some[0].id, (SubmapId{0, 4}));
}

TEST(PlaceIndexTest, TakesEightKilobytesPerSubmap) {
  std::mt19937 engine(42);
  PlaceIndex index{RetrievalOptions()};
  for (int k = 0; k < 1000; ++k) {
    index.Add({0, k}, testing::RandomFeatures(300, 30., kLength, &engine));
  }
  EXPECT_LE(index.MemoryUse(), 8000u * 1000u);
  EXPECT_GE(index.MemoryUse(), 1000u * 1000u);
}

TEST(PlaceIndexTest, NothingFromNothing) {
  const auto places = Places(3);
  EXPECT_THAT(PlaceIndex(RetrievalOptions()).Query(places.at({0, 0})),
              SizeIs(0));
  EXPECT_THAT(IndexOf({}, places).Query(FeatureSet()), SizeIs(0));
  PlaceIndex index{RetrievalOptions()};
  index.Add({0, 0}, FeatureSet());
  EXPECT_EQ(index.size(), 1u);
  EXPECT_THAT(index.Query(places.at({0, 0})), SizeIs(0));
  EXPECT_TRUE(index.Remove({0, 0}));
  // One feature, or all the same: no pair.
  std::mt19937 engine(42);
  const FeatureSet one = testing::RandomFeatures(1, 20., kLength, &engine);
  EXPECT_THAT(IndexOf({}, {{{0, 0}, one}}).Query(one), SizeIs(0));
}

TEST(RetrievalOptionsTest, ValidateNamesTheOption) {
  EXPECT_EQ(Validate(RetrievalOptions()), "");
  const auto error = [](const auto member, const auto value) {
    RetrievalOptions options;
    options.*member = value;
    return Validate(options);
  };
  EXPECT_THAT(error(&RetrievalOptions::num_stored_partners, 0),
              HasSubstr("num_stored_partners"));
  EXPECT_THAT(error(&RetrievalOptions::max_num_visited_pairs, -1),
              HasSubstr("max_num_visited_pairs"));
  EXPECT_THAT(error(&RetrievalOptions::min_score, std::nan("")),
              HasSubstr("min_score"));
  EXPECT_THAT(error(&RetrievalOptions::min_num_candidates, 0),
              HasSubstr("min_num_candidates"));
  EXPECT_THAT(error(&RetrievalOptions::max_num_candidates, 9),
              HasSubstr("max_num_candidates"));
  RetrievalOptions options;
  options.pose_bins.rotation = 0.;
  EXPECT_THAT(Validate(options), HasSubstr("rotation"));
  options = {};
  options.pairs.border_fraction = 0.6;
  EXPECT_THAT(Validate(options), HasSubstr("border_fraction"));
}

}  // namespace
}  // namespace cartographer_sdf::place_index_test
