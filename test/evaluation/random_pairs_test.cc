// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/random_pairs.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"

namespace cartographer_sdf::random_pairs_test {
namespace {

using ::cartographer_sdf::testing::IsPoseNear;
using ::testing::DoubleNear;
using ::testing::Optional;

void InOrder(const size_t n, const std::function<void(size_t)>& task) {
  for (size_t k = 0; k < n; ++k) task(k);
}
void Backwards(const size_t n, const std::function<void(size_t)>& task) {
  for (size_t k = n; k > 0; --k) task(k - 1);
}

PairTruths ManyPairs(const int num_submaps) {
  PairTruths pairs;
  for (int i = 0; i < num_submaps; ++i) {
    for (int j = i + 3; j < num_submaps; ++j) {
      pairs[{{0, i}, {0, j}}].overlap = 0.5;
    }
  }
  return pairs;
}

bool AreEqual(const std::vector<TurnedPair>& a,
              const std::vector<TurnedPair>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const TurnedPair& p, const TurnedPair& q) {
                      return p.reference == q.reference && p.query == q.query &&
                             p.rotation == q.rotation;
                    });
}

TEST(DrawRandomPairsTest, DrawsDistinctPairsBySeed) {
  const PairTruths pairs = ManyPairs(60);
  const auto drawn = DrawRandomPairs(pairs, 1000, 42);
  ASSERT_EQ(drawn.size(), 1000u);
  std::set<std::pair<SubmapId, SubmapId>> ids;
  int num_quadrants[4] = {};
  for (const TurnedPair& pair : drawn) {
    EXPECT_EQ(pairs.count({pair.reference, pair.query}), 1u);
    ids.insert({pair.reference, pair.query});
    EXPECT_GT(pair.rotation, -M_PI);
    EXPECT_LE(pair.rotation, M_PI);
    ++num_quadrants[std::clamp(
        static_cast<int>(std::floor(pair.rotation / M_PI_2)) + 2, 0, 3)];
  }
  EXPECT_EQ(ids.size(), drawn.size());
  // Binomial, 250 +- 13.7: five standard deviations.
  for (const int count : num_quadrants) EXPECT_NEAR(count, 250, 69);
  EXPECT_TRUE(AreEqual(drawn, DrawRandomPairs(pairs, 1000, 42)));
  EXPECT_FALSE(AreEqual(drawn, DrawRandomPairs(pairs, 1000, 43)));
}

TEST(DrawRandomPairsTest, TakesAllWhereThereAreFewer) {
  const PairTruths pairs = ManyPairs(6);
  EXPECT_EQ(DrawRandomPairs(pairs, 1000, 1).size(), pairs.size());
  EXPECT_TRUE(DrawRandomPairs({}, 1000, 1).empty());
  EXPECT_TRUE(DrawRandomPairs(pairs, 0, 1).empty());
}

// Two views of one building and one of another part of it.
class MatchTurnedPairsTest : public ::testing::Test {
 protected:
  MatchTurnedPairsTest() {
    const testing::Building building = testing::TwoRooms();
    grids_[kWest] =
        testing::SeeFrom(building, poses_[0], testing::WestRoomViewpoints());
    testing::Viewpoints others = testing::WestRoomViewpoints();
    for (Eigen::Vector2d& viewpoint : others) viewpoint.array() += 0.15;
    grids_[kWestAgain] = testing::SeeFrom(building, poses_[1], others);
    grids_[kEast] =
        testing::SeeFrom(building, poses_[2], testing::EastRoomViewpoints());
    pairs_ = {{kWest, kWestAgain, 2.2}, {kWest, kEast, -0.7}};
  }

  const SubmapId kWest{0, 0}, kWestAgain{0, 5}, kEast{0, 9};
  const Rigid2 poses_[3] = {Rigid2(1., 2., 0.3), Rigid2(4., 1., -1.),
                            Rigid2(12., 1., 0.8)};
  std::map<SubmapId, OccupancyGrid> grids_;
  std::vector<TurnedPair> pairs_;
};

TEST_F(MatchTurnedPairsTest, TakesTheRotationBack) {
  for (const Method method : {Method::kPaper, Method::kSdf}) {
    const MatchOptions options =
        method == Method::kPaper ? PaperMatchOptions() : MatchOptions();
    const PlaceMaker make_place =
        MakeGridPlaces(PlaceOptions(), options, grids_);
    const auto rows =
        MatchTurnedPairs(options, make_place, pairs_, {}, &InOrder);
    ASSERT_EQ(rows.size(), 1u);
    ASSERT_FALSE(rows[0].empty());
    EXPECT_EQ(rows[0][0].reference, kWest);
    EXPECT_EQ(rows[0][0].query, kWestAgain);
    // Two cells, and what they turn over 5 m.
    EXPECT_THAT(rows[0][0].T_reference_query,
                IsPoseNear(poses_[0].Inverse() * poses_[1], 0.15, 0.03));
    if (rows[0].size() == 2) {
      EXPECT_LT(rows[0][1].score, rows[0][0].score);
    }
  }
}

TEST_F(MatchTurnedPairsTest, FewerFeaturesNearWallsAndTheSameOnAnyExecutor) {
  const MatchOptions options = PaperMatchOptions();
  const PlaceMaker make_place = MakeGridPlaces(PlaceOptions(), options, grids_);
  const auto rows =
      MatchTurnedPairs(options, make_place, pairs_, {100., 0.5}, &InOrder);
  ASSERT_EQ(rows.size(), 3u);
  ASSERT_FALSE(rows[0].empty());
  ASSERT_FALSE(rows[1].empty());
  // Nothing is as far from walls as 100 m.
  EXPECT_EQ(rows[0][0].inliers, rows[1][0].inliers);
  if (!rows[2].empty() && rows[2][0].query == kWestAgain) {
    EXPECT_LT(rows[2][0].inliers, rows[0][0].inliers);
  }
  const auto again =
      MatchTurnedPairs(options, make_place, pairs_, {100., 0.5}, &Backwards);
  for (size_t v = 0; v < rows.size(); ++v) {
    ASSERT_EQ(rows[v].size(), again[v].size());
    for (size_t k = 0; k < rows[v].size(); ++k) {
      EXPECT_EQ(rows[v][k].score, again[v][k].score);
      EXPECT_EQ(rows[v][k].T_reference_query.translation(),
                again[v][k].T_reference_query.translation());
    }
  }
}

TEST_F(MatchTurnedPairsTest, WhatCannotBeDescribedHasNoAnswer) {
  const MatchOptions options = PaperMatchOptions();
  grids_[kWestAgain].known.setConstant(false);
  grids_.erase(kEast);
  EXPECT_TRUE(MatchTurnedPairs(options,
                               MakeGridPlaces(PlaceOptions(), options, grids_),
                               pairs_, {}, &InOrder)[0]
                  .empty());
}

TEST(FeaturesNearWallsTest, KeepsDescriptorsBesideTheirFeatures) {
  FeatureSet set;
  set.descriptors.resize(2, 3);
  for (int k = 0; k < 3; ++k) {
    set.features.push_back(
        {{{0., 0.}, k - 1., KeypointKind::kMaximum, 1.}, 0.});
    set.descriptors.col(k).setConstant(static_cast<float>(k));
  }
  const FeatureSet near = FeaturesNearWalls(set, 0.9);
  ASSERT_EQ(near.features.size(), 1u);
  EXPECT_EQ(near.features[0].keypoint.clearance, 0.);
  ASSERT_EQ(near.descriptors.cols(), 1);
  EXPECT_EQ(near.descriptors(0, 0), 1.f);
  EXPECT_EQ(FeaturesNearWalls(set, 1.).features.size(), 3u);
}

// Four pairs of overlaps 0.8, 0.6, 0.2, 0, of which the third has no answer.
class JudgePairsTest : public ::testing::Test {
 protected:
  JudgePairsTest() {
    const double overlaps[] = {0.8, 0.6, 0.2, 0.};
    for (int k = 0; k < 4; ++k) {
      const SubmapId query{0, 10 + k};
      truths_[{{0, 0}, query}].overlap = overlaps[k];
      pairs_.push_back({{0, 0}, query, 0.});
      if (k == 2) continue;
      AnswerLabel label;
      label.reference = {0, 0};
      label.query = query;
      label.overlap = overlaps[k];
      label.score = 10. - k;
      label.verdict = k == 0 ? AnswerVerdict::kRight : AnswerVerdict::kWrong;
      labels_.push_back(label);
    }
  }
  PairTruths truths_;
  std::vector<TurnedPair> pairs_;
  std::vector<AnswerLabel> labels_;
};

TEST_F(JudgePairsTest, ByPairThePoseDoesNotMatter) {
  const PrecisionRecallCurve curve =
      JudgePairs(truths_, pairs_, labels_, 0.5, AnswerJudgement::kByPair);
  EXPECT_EQ(curve.num_positives, 2);
  EXPECT_EQ(curve.RecallAtPrecision1(), 1.);
  EXPECT_EQ(curve.points.back().num_wrong, 1);
}

TEST_F(JudgePairsTest, ByPoseItDoes) {
  PrecisionRecallCurve curve =
      JudgePairs(truths_, pairs_, labels_, 0.5, AnswerJudgement::kByPose);
  EXPECT_EQ(curve.RecallAtPrecision1(), 0.5);
  EXPECT_EQ(curve.points.back().num_wrong, 2);
  // Near is neither, and still was to be found.
  labels_[1].verdict = AnswerVerdict::kNear;
  curve = JudgePairs(truths_, pairs_, labels_, 0.5, AnswerJudgement::kByPose);
  EXPECT_EQ(curve.num_positives, 2);
  EXPECT_EQ(curve.points.back().num_wrong, 1);
}

TEST_F(JudgePairsTest, TheOverlapThatMakesAMatchIsAnArgument) {
  const PrecisionRecallCurve many =
      JudgePairs(truths_, pairs_, labels_, 0.1, AnswerJudgement::kByPair);
  EXPECT_EQ(many.num_positives, 3);
  EXPECT_THAT(many.RecallAtPrecision1(), Optional(DoubleNear(2. / 3., 1e-12)));
  const PrecisionRecallCurve few =
      JudgePairs(truths_, pairs_, labels_, 0.7, AnswerJudgement::kByPair);
  EXPECT_EQ(few.num_positives, 1);
  EXPECT_EQ(few.points.back().num_wrong, 2);
}

}  // namespace
}  // namespace cartographer_sdf::random_pairs_test
