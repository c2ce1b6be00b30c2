// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/place_recognition.h"

#include "gtest/gtest.h"

namespace cartographer_sdf::place_recognition_test {
namespace {

class PlaceRecognitionTest : public ::testing::Test {
 protected:
  // The overlap of a pair, and how its answer is judged.
  void Add(const SubmapId& reference, const SubmapId& query,
           const double overlap, const AnswerVerdict verdict,
           const bool accepted) {
    pairs_[{reference, query}] = {overlap, Eigen::Vector2d::Zero(),
                                  overlap >= kPositiveOverlap};
    AnswerLabel label;
    label.reference = reference;
    label.query = query;
    label.verdict = verdict;
    labels_.push_back(label);
    MatchRow match;
    match.reference = reference;
    match.query = query;
    match.accepted = accepted;
    matches_.push_back(match);
  }
  PlaceRecognitionScore Score() const {
    return ScorePlaceRecognition(pairs_, labels_, matches_);
  }

  PairTruths pairs_;
  std::vector<AnswerLabel> labels_;
  std::vector<MatchRow> matches_;
};

TEST_F(PlaceRecognitionTest, CountsMatchesAndQueries) {
  Add({0, 0}, {0, 5}, 0.9, AnswerVerdict::kRight, true);
  Add({0, 1}, {0, 5}, 0.6, AnswerVerdict::kRight, true);
  Add({0, 0}, {0, 6}, 0.7, AnswerVerdict::kRight, false);
  Add({0, 0}, {0, 7}, 0., AnswerVerdict::kWrong, true);
  Add({0, 0}, {0, 8}, 0.4, AnswerVerdict::kNear, true);
  // A pair without an answer.
  pairs_[{{0, 0}, {0, 9}}] = {0.8, Eigen::Vector2d::Zero(), true};
  const PlaceRecognitionScore score = Score();
  EXPECT_EQ(score.num_right, 2);
  EXPECT_EQ(score.num_near, 1);
  EXPECT_EQ(score.num_wrong, 1);
  EXPECT_EQ(score.num_unknown, 0);
  EXPECT_EQ(score.num_queries, 5);
  EXPECT_EQ(score.num_queries_with_positive, 3);
  EXPECT_EQ(score.num_queries_matched, 3);
  EXPECT_EQ(score.num_queries_right, 1);
}

TEST_F(PlaceRecognitionTest, FindsTurnedPairsAndThoseWithoutTruth) {
  Add({0, 0}, {0, 5}, 0.9, AnswerVerdict::kRight, true);
  std::swap(matches_[0].reference, matches_[0].query);
  MatchRow stranger;
  stranger.reference = {3, 0};
  stranger.query = {3, 1};
  stranger.accepted = true;
  matches_.push_back(stranger);
  const PlaceRecognitionScore score = Score();
  EXPECT_EQ(score.num_right, 1);
  EXPECT_EQ(score.num_unknown, 1);
}

TEST_F(PlaceRecognitionTest, OfNothingAllIsZero) {
  const PlaceRecognitionScore score = Score();
  EXPECT_EQ(score.num_queries, 0);
  EXPECT_EQ(score.num_right + score.num_wrong + score.num_unknown, 0);
}

}  // namespace
}  // namespace cartographer_sdf::place_recognition_test
