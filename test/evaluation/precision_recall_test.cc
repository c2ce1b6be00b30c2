// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/precision_recall.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::precision_recall_test {
namespace {

using ::testing::DoubleNear;
using ::testing::HasSubstr;
using ::testing::Optional;

constexpr double kRounding = 1e-12;

JudgedAnswer Right(const double score) { return {score, true}; }
JudgedAnswer Wrong(const double score) { return {score, false}; }

TEST(PrecisionRecallTest, FollowsAHandMadeCase) {
  // By falling score: right 9, right 8, wrong 7, right 5; five to find.
  const PrecisionRecallCurve curve =
      MakePrecisionRecallCurve({Right(5.), Wrong(7.), Right(9.), Right(8.)}, 5);
  ASSERT_EQ(curve.points.size(), 4u);
  EXPECT_EQ(curve.points[0].threshold, 9.);
  EXPECT_EQ(curve.points[3].threshold, 5.);
  EXPECT_EQ(curve.points[2].num_right, 2);
  EXPECT_EQ(curve.points[2].num_wrong, 1);
  EXPECT_NEAR(curve.points[2].precision, 2. / 3., kRounding);
  EXPECT_NEAR(curve.points[2].recall, 0.4, kRounding);
  EXPECT_NEAR(curve.points[3].precision, 0.75, kRounding);
  EXPECT_NEAR(curve.points[3].recall, 0.6, kRounding);
  EXPECT_THAT(curve.RecallAtPrecision1(), Optional(DoubleNear(0.4, kRounding)));
  EXPECT_EQ(curve.ThresholdAtPrecision1(), 8.);
  // Steps of 0.2 at precisions 1, 1 and 0.75.
  EXPECT_THAT(curve.AveragePrecision(), Optional(DoubleNear(0.55, kRounding)));
}

TEST(PrecisionRecallTest, TiesComeTogetherWhateverTheirOrder) {
  for (const auto& tied : {std::vector<JudgedAnswer>{Right(7.), Wrong(7.)},
                           std::vector<JudgedAnswer>{Wrong(7.), Right(7.)}}) {
    std::vector<JudgedAnswer> answers = {Right(9.)};
    answers.insert(answers.end(), tied.begin(), tied.end());
    answers.push_back(Right(3.));
    const PrecisionRecallCurve curve = MakePrecisionRecallCurve(answers, 4);
    ASSERT_EQ(curve.points.size(), 3u);
    EXPECT_EQ(curve.points[1].num_right, 2);
    EXPECT_EQ(curve.points[1].num_wrong, 1);
    EXPECT_THAT(curve.RecallAtPrecision1(),
                Optional(DoubleNear(0.25, kRounding)));
    EXPECT_EQ(curve.ThresholdAtPrecision1(), 9.);
  }
}

TEST(PrecisionRecallTest, OneFalseAnswerAtTheTopLeavesNoRecall) {
  for (const double score_of_wrong : {9., 8.}) {
    const PrecisionRecallCurve curve = MakePrecisionRecallCurve(
        {Wrong(score_of_wrong), Right(8.), Right(7.)}, 2);
    EXPECT_EQ(curve.RecallAtPrecision1(), 0.);
    EXPECT_EQ(curve.ThresholdAtPrecision1(), std::nullopt);
    EXPECT_NEAR(curve.points.back().recall, 1., kRounding);
    EXPECT_GT(*curve.AveragePrecision(), 0.5);
  }
}

TEST(PrecisionRecallTest, WithoutPositivesThereIsNoRecall) {
  const PrecisionRecallCurve curve = MakePrecisionRecallCurve({Wrong(3.)}, 0);
  EXPECT_EQ(curve.RecallAtPrecision1(), std::nullopt);
  EXPECT_EQ(curve.ThresholdAtPrecision1(), std::nullopt);
  EXPECT_EQ(curve.AveragePrecision(), std::nullopt);
  ASSERT_EQ(curve.points.size(), 1u);
  EXPECT_EQ(curve.points[0].num_wrong, 1);
}

TEST(PrecisionRecallTest, WithoutAnswersNothingIsRecalled) {
  const PrecisionRecallCurve curve = MakePrecisionRecallCurve({}, 3);
  EXPECT_TRUE(curve.points.empty());
  EXPECT_EQ(curve.RecallAtPrecision1(), 0.);
  EXPECT_EQ(curve.ThresholdAtPrecision1(), std::nullopt);
  EXPECT_EQ(curve.AveragePrecision(), 0.);
}

TEST(PrecisionRecallTest, AllRightIsAllRecalled) {
  const PrecisionRecallCurve curve =
      MakePrecisionRecallCurve({Right(1.), Right(2.)}, 2);
  EXPECT_EQ(curve.RecallAtPrecision1(), 1.);
  EXPECT_EQ(curve.ThresholdAtPrecision1(), 1.);
  EXPECT_EQ(curve.AveragePrecision(), 1.);
}

TEST(PrecisionRecallTest, WritesCurves) {
  const testing::TemporaryDirectory directory;
  const std::string path = directory.File("curves.csv");
  ASSERT_TRUE(WriteCurves(path, {{"a", MakePrecisionRecallCurve(
                                           {Right(12.), Wrong(4.)}, 2)}})
                  .ok());
  EXPECT_EQ(directory.Read("curves.csv"),
            "series,threshold,right,wrong,precision,recall\n"
            "a,12,1,0,1.000000,0.500000\n"
            "a,4,1,1,0.500000,0.500000\n");
  EXPECT_THAT(std::string(WriteCurves("/nowhere/c.csv", {}).message()),
              HasSubstr("/nowhere/c.csv"));
}

}  // namespace
}  // namespace cartographer_sdf::precision_recall_test
