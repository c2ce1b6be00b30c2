// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/matching/keypoint_pairs.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/feature_sets.h"

namespace cartographer_sdf::keypoint_pairs_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr size_t kNoLimit = 100000;

Feature MakeFeature(const double x, const double y, const double clearance,
                    const double orientation) {
  Feature feature;
  feature.keypoint = {{x, y}, clearance, KeypointKind::kMaximum, 1.};
  feature.orientation = orientation;
  return feature;
}

// Of one pair, in the middle of all bins.
FeatureSet OnePair() {
  FeatureSet set;
  const double bin = 2. * M_PI / 14.;  // nearest to orientation_bin
  set.features = {MakeFeature(0., 0., 0.5, 0.5 * bin),
                  MakeFeature(3.45, 0., 1.1, 2.5 * bin)};
  return set;
}

// How many pairs of `seen` find one of `stored`.
size_t NumFound(const std::vector<KeypointPair>& stored,
                const std::vector<KeypointPair>& seen) {
  std::set<uint32_t> keys;
  for (const KeypointPair& pair : stored) {
    keys.insert(pair.keys.begin(), pair.keys.end());
  }
  return static_cast<size_t>(
      std::count_if(seen.begin(), seen.end(), [&keys](const auto& pair) {
        return std::any_of(
            pair.keys.begin(), pair.keys.end(),
            [&keys](const uint32_t key) { return keys.count(key) > 0; });
      }));
}

TEST(KeypointPairsTest, AreDescribedWhereverTheSubmapLies) {
  std::mt19937 engine(42);
  const FeatureSet set = testing::RandomFeatures(60, 20., 1, &engine);
  const auto stored = PairsToStore({}, 3, kNoLimit, set);
  EXPECT_GE(stored.size(), 90u);
  const Rigid2 motion(3., -2., 1.1);
  const auto moved = PairsToSeek({}, 3, kNoLimit, testing::Moved(motion, set));
  EXPECT_GE(NumFound(stored, moved), stored.size());
  // Another submap's are found by chance alone.
  const auto other = PairsToSeek({}, 3, kNoLimit,
                                 testing::RandomFeatures(60, 20., 1, &engine));
  EXPECT_LE(NumFound(stored, other), stored.size() / 10);
}

TEST(KeypointPairsTest, MiddleAndDirectionDetermineThePose) {
  const FeatureSet set = OnePair();
  const Rigid2 motion(3., -2., 1.1);
  const auto pairs = PairsToStore({}, 3, kNoLimit, testing::Moved(motion, set));
  ASSERT_THAT(pairs, SizeIs(1));
  const Eigen::Vector2d middle = motion * Eigen::Vector2d(1.725, 0.);
  EXPECT_NEAR(pairs[0].middle.x(), middle.x(), 1e-5);
  EXPECT_NEAR(pairs[0].middle.y(), middle.y(), 1e-5);
  EXPECT_NEAR(pairs[0].direction, 1.1, 1e-5);
}

TEST(KeypointPairsTest, LookIntoTheNextBinNearItsBorder) {
  const auto num_keys = [](const FeatureSet& set, const double border) {
    KeypointPairOptions options;
    options.border_fraction = border;
    const auto pairs = PairsToSeek(options, 3, kNoLimit, set);
    return pairs.at(0).keys.size();
  };
  FeatureSet set = OnePair();
  EXPECT_EQ(num_keys(set, 0.3), 1u);
  // The length, and with it both clearances, near the end of a bin.
  set.features[1].keypoint.position.x() = 3.59;
  EXPECT_EQ(num_keys(set, 0.3), 2u);
  set.features[0].keypoint.clearance = 0.59;
  EXPECT_EQ(num_keys(set, 0.3), 4u);
  EXPECT_EQ(num_keys(set, 0.), 1u);
  // A stored pair has one key.
  EXPECT_THAT(PairsToStore({}, 3, kNoLimit, set)[0].keys, SizeIs(1));
}

TEST(KeypointPairsTest, NoOrderIsTakenForGrantedAmongEquals) {
  FeatureSet set = OnePair();
  EXPECT_THAT(PairsToSeek({}, 3, kNoLimit, set), SizeIs(1));
  set.features[1].keypoint.clearance = 0.55;
  EXPECT_THAT(PairsToSeek({}, 3, kNoLimit, set), SizeIs(2));
  // Seen again, the order is the other one.
  FeatureSet again = set;
  again.features[0].keypoint.clearance = 0.57;
  EXPECT_EQ(NumFound(PairsToStore({}, 3, kNoLimit, set),
                     PairsToSeek({}, 3, kNoLimit, again)),
            1u);
}

TEST(KeypointPairsTest, OfTheNearestAndStrongest) {
  FeatureSet set;
  for (const double x : {0., 2., 3.9, 7.8}) {
    set.features.push_back(MakeFeature(x, 0., 0.5, 0.));
    set.features.back().keypoint.strength = x;
  }
  const auto middles = [&set](const int num_partners, const size_t limit) {
    std::vector<float> middles;
    for (const auto& pair : PairsToStore({}, num_partners, limit, set)) {
      middles.push_back(pair.middle.x());
    }
    return middles;
  };
  EXPECT_THAT(middles(1, kNoLimit),
              ElementsAre(::testing::FloatEq(1.f), ::testing::FloatEq(2.95f),
                          ::testing::FloatEq(5.85f)));
  EXPECT_THAT(middles(3, kNoLimit), SizeIs(6));
  EXPECT_THAT(middles(1, 1), ElementsAre(::testing::FloatEq(5.85f)));
  EXPECT_THAT(PairsToStore({}, 3, kNoLimit, FeatureSet()), IsEmpty());
  KeypointPairOptions near;
  near.max_length_meters = 1.8;
  EXPECT_THAT(PairsToStore(near, 3, kNoLimit, set), IsEmpty());
}

TEST(KeypointPairsTest, OnlyOfTheKindsInUse) {
  FeatureSet set;
  for (const double x : {0., 2., 4.}) {
    set.features.push_back(MakeFeature(x, 0., 0.5, 0.));
  }
  set.features[0].keypoint.kind = KeypointKind::kMinimum;
  set.features[1].keypoint.kind = KeypointKind::kMaximum;
  set.features[2].keypoint.kind = KeypointKind::kMinimum;
  KeypointPairOptions options;
  options.kinds.maxima = false;
  const auto pairs = PairsToStore(options, 3, kNoLimit, set);
  ASSERT_THAT(pairs, SizeIs(1));
  EXPECT_NEAR(pairs[0].middle.x(), 2., 1e-6);
  options.kinds.minima = false;
  EXPECT_THAT(PairsToSeek(options, 3, kNoLimit, set), IsEmpty());
}

TEST(KeypointPairOptionsTest, ValidateNamesTheOption) {
  EXPECT_EQ(Validate(KeypointPairOptions()), "");
  const auto error = [](double KeypointPairOptions::*member,
                        const double value) {
    KeypointPairOptions options;
    options.*member = value;
    return Validate(options);
  };
  EXPECT_THAT(error(&KeypointPairOptions::min_length_meters, 0.),
              HasSubstr("min_length_meters"));
  EXPECT_THAT(error(&KeypointPairOptions::max_length_meters, 1.),
              HasSubstr("max_length_meters"));
  EXPECT_THAT(error(&KeypointPairOptions::orientation_bin, std::nan("")),
              HasSubstr("orientation_bin"));
  EXPECT_THAT(error(&KeypointPairOptions::border_fraction, -0.1),
              HasSubstr("border_fraction"));
  KeypointPairOptions none;
  none.kinds = {false, false, false};
  EXPECT_THAT(Validate(none), HasSubstr("maxima"));
}

}  // namespace
}  // namespace cartographer_sdf::keypoint_pairs_test
