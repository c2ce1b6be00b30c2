// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/matching/correspondence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/feature_sets.h"

namespace cartographer_sdf::correspondence_test {
namespace {

using testing::RandomFeatures;

// Differences of squared norms of some 10 in single precision.
constexpr double kRounding = 1e-5;

// Every reference feature that may correspond to a query feature, with its
// distance.
std::vector<std::pair<double, int>> Comparable(
    const CorrespondenceOptions& options, const FeatureSet& reference,
    const FeatureSet& query, const int q) {
  std::vector<std::pair<double, int>> comparable;
  const Keypoint& keypoint = query.features[q].keypoint;
  for (int r = 0; r < static_cast<int>(reference.features.size()); ++r) {
    const Keypoint& other = reference.features[r].keypoint;
    if (other.kind != keypoint.kind ||
        std::abs(other.clearance - keypoint.clearance) >
            options.max_clearance_difference_meters) {
      continue;
    }
    comparable.emplace_back((reference.descriptors.col(r).cast<double>() -
                             query.descriptors.col(q).cast<double>())
                                .norm(),
                            r);
  }
  std::sort(comparable.begin(), comparable.end());
  return comparable;
}

std::vector<Correspondence> BruteForce(const CorrespondenceOptions& options,
                                       const FeatureSet& reference,
                                       const FeatureSet& query) {
  std::vector<Correspondence> correspondences;
  for (int kind = 0; kind < kNumKeypointKinds; ++kind) {
    for (int q = 0; q < static_cast<int>(query.features.size()); ++q) {
      if (static_cast<int>(query.features[q].keypoint.kind) != kind) continue;
      const auto comparable = Comparable(options, reference, query, q);
      if (options.use_ratio_test) {
        double rival = 0.;
        for (auto other = comparable.rbegin(); other != comparable.rend();
             ++other) {
          if (reference.features[other->second].keypoint.position !=
              reference.features[comparable[0].second].keypoint.position) {
            rival = other->first;
          }
        }
        if (comparable.empty() || rival == 0. ||
            comparable[0].first > options.max_ratio * rival) {
          continue;
        }
      }
      for (int n = 0; n < std::min(options.num_neighbours,
                                   static_cast<int>(comparable.size()));
           ++n) {
        correspondences.push_back(
            {comparable[n].second, q, static_cast<float>(comparable[n].first)});
      }
    }
  }
  return correspondences;
}

void ExpectEqual(const std::vector<Correspondence>& actual,
                 const std::vector<Correspondence>& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (size_t k = 0; k < expected.size(); ++k) {
    EXPECT_EQ(actual[k].reference, expected[k].reference);
    EXPECT_EQ(actual[k].query, expected[k].query);
    EXPECT_NEAR(actual[k].descriptor_distance, expected[k].descriptor_distance,
                kRounding);
  }
}

TEST(FindCorrespondencesTest, EqualsBruteForce) {
  std::mt19937 engine(42);
  const FeatureSet reference = RandomFeatures(150, 10., 18, &engine);
  const FeatureSet query = RandomFeatures(120, 10., 18, &engine);
  CorrespondenceOptions options;
  for (const int num_neighbours : {1, 5, 100}) {
    for (const double clearance : {0.05, 0.2, 10.}) {
      options.num_neighbours = num_neighbours;
      options.max_clearance_difference_meters = clearance;
      const std::vector<Correspondence> expected =
          BruteForce(options, reference, query);
      EXPECT_GT(expected.size(), 50u);
      ExpectEqual(FindCorrespondences(options, reference, query), expected);
    }
  }
}

TEST(FindCorrespondencesTest, OnlyOfTheKindsInUse) {
  std::mt19937 engine(42);
  const FeatureSet reference = RandomFeatures(150, 10., 18, &engine);
  const FeatureSet query = RandomFeatures(120, 10., 18, &engine);
  CorrespondenceOptions options;
  const auto all = FindCorrespondences(options, reference, query);
  options.kinds.maxima = false;
  options.kinds.saddles = false;
  std::vector<Correspondence> minima;
  for (const Correspondence& c : all) {
    if (query.features[c.query].keypoint.kind == KeypointKind::kMinimum) {
      minima.push_back(c);
    }
  }
  EXPECT_GT(minima.size(), 50u);
  EXPECT_LT(minima.size(), all.size());
  ExpectEqual(FindCorrespondences(options, reference, query), minima);
}

TEST(FindCorrespondencesTest, KindsMayMixOnRequest) {
  std::mt19937 engine(42);
  FeatureSet reference = RandomFeatures(150, 10., 18, &engine);
  FeatureSet query = RandomFeatures(120, 10., 18, &engine);
  CorrespondenceOptions options;
  const auto apart = FindCorrespondences(options, reference, query);
  options.same_kind_only = false;
  const auto mixed = FindCorrespondences(options, reference, query);
  EXPECT_GT(mixed.size(), apart.size());
  // As if all were of one kind.
  for (FeatureSet* const set : {&reference, &query}) {
    for (Feature& feature : set->features) {
      feature.keypoint.kind = KeypointKind::kSaddle;
    }
  }
  ExpectEqual(mixed, BruteForce(options, reference, query));
}

// Every third feature is the same keypoint seen from another direction.
FeatureSet WithSecondOrientations(FeatureSet set) {
  for (size_t k = 1; k < set.features.size(); k += 3) {
    set.features[k].keypoint = set.features[k - 1].keypoint;
  }
  return set;
}

TEST(FindCorrespondencesTest, RatioTestEqualsBruteForce) {
  std::mt19937 engine(42);
  const FeatureSet reference =
      WithSecondOrientations(RandomFeatures(60, 10., 2, &engine));
  const FeatureSet query = RandomFeatures(300, 10., 2, &engine);
  CorrespondenceOptions options;
  options.use_ratio_test = true;
  options.max_clearance_difference_meters = 10.;
  for (const int num_neighbours : {1, 3}) {
    options.num_neighbours = num_neighbours;
    const std::vector<Correspondence> expected =
        BruteForce(options, reference, query);
    EXPECT_GT(expected.size(), 50u * num_neighbours);
    EXPECT_LT(expected.size(), 300u * num_neighbours);
    ExpectEqual(FindCorrespondences(options, reference, query), expected);
  }
}

Feature FeatureAt(const double x) {
  return {{{x, 0.}, 1., KeypointKind::kSaddle, 1.}, 0.};
}

FeatureSet Line(const std::vector<Feature>& features,
                const std::vector<float>& descriptors) {
  FeatureSet set;
  set.features = features;
  set.descriptors = Eigen::Map<const Eigen::RowVectorXf>(
      descriptors.data(), static_cast<Eigen::Index>(descriptors.size()));
  return set;
}

TEST(FindCorrespondencesTest, TheRivalOfTheRatioTestIsAnotherKeypoint) {
  // Two directions of one keypoint look almost the same from here; the next
  // keypoint is far.
  const FeatureSet reference =
      Line({FeatureAt(1.), FeatureAt(1.), FeatureAt(2.)}, {1.f, 1.1f, 4.f});
  const FeatureSet query = Line({FeatureAt(0.)}, {0.f});
  CorrespondenceOptions options;
  options.use_ratio_test = true;
  options.num_neighbours = 1;
  EXPECT_EQ(FindCorrespondences(options, reference, query).size(), 1u);
  const FeatureSet close =
      Line({FeatureAt(1.), FeatureAt(1.), FeatureAt(2.)}, {1.f, 1.1f, 1.2f});
  EXPECT_TRUE(FindCorrespondences(options, close, query).empty());
  // Nothing to be distinctive from.
  const FeatureSet lonely = Line({FeatureAt(1.), FeatureAt(1.)}, {1.f, 9.f});
  EXPECT_TRUE(FindCorrespondences(options, lonely, query).empty());
  options.use_ratio_test = false;
  EXPECT_EQ(FindCorrespondences(options, lonely, query).size(), 1u);
}

TEST(FindCorrespondencesTest, OfEqualOnesTheFirstIsNearest) {
  const FeatureSet reference =
      Line({FeatureAt(1.), FeatureAt(2.), FeatureAt(3.)}, {5.f, 5.f, 5.f});
  CorrespondenceOptions options;
  options.num_neighbours = 2;
  const std::vector<Correspondence> found =
      FindCorrespondences(options, reference, Line({FeatureAt(0.)}, {4.f}));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].reference, 0);
  EXPECT_EQ(found[1].reference, 1);
}

TEST(FindCorrespondencesTest, NoneBetweenDifferentKindsOrEmptySets) {
  std::mt19937 engine(42);
  FeatureSet reference = RandomFeatures(10, 10., 18, &engine);
  FeatureSet query = reference;
  for (Feature& feature : reference.features) {
    feature.keypoint.kind = KeypointKind::kMaximum;
  }
  for (Feature& feature : query.features) {
    feature.keypoint.kind = KeypointKind::kMinimum;
  }
  EXPECT_TRUE(FindCorrespondences({}, reference, query).empty());
  EXPECT_TRUE(FindCorrespondences({}, FeatureSet(), query).empty());
  EXPECT_TRUE(FindCorrespondences({}, reference, FeatureSet()).empty());
  EXPECT_TRUE(FindCorrespondences({}, FeatureSet(), FeatureSet()).empty());
}

TEST(CorrespondenceOptionsTest, ValidateNamesTheOption) {
  EXPECT_EQ(Validate(CorrespondenceOptions()), "");
  const auto error = [](const auto member, const auto value) {
    CorrespondenceOptions options;
    options.*member = value;
    return Validate(options);
  };
  using ::testing::HasSubstr;
  EXPECT_THAT(error(&CorrespondenceOptions::num_neighbours, 0),
              HasSubstr("num_neighbours"));
  EXPECT_THAT(error(&CorrespondenceOptions::max_ratio, 1.1),
              HasSubstr("max_ratio"));
  EXPECT_THAT(error(&CorrespondenceOptions::max_clearance_difference_meters,
                    std::nan("")),
              HasSubstr("max_clearance_difference_meters"));
  EXPECT_THAT(
      error(&CorrespondenceOptions::kinds, KeypointKinds{false, false, false}),
      HasSubstr("maxima"));
}

}  // namespace
}  // namespace cartographer_sdf::correspondence_test
