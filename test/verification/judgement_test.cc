// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/judgement.h"

#include <cmath>
#include <utility>

#include "gtest/gtest.h"

namespace cartographer_sdf::judgement_test {
namespace {

constexpr double kScore = 4.;
constexpr double kMargin = 2.;

// Just beyond every limit of the default options.
PairEvidence GoodEvidence() {
  PairEvidence evidence;
  evidence.query_in_reference = {100., 75., 24., 0.};
  evidence.reference_in_query = {100., 90., 1., 0.};
  evidence.overlap_area = 11.;
  evidence.overlap = 0.5;
  evidence.tiles = {10., 0.9};
  evidence.normal_scatter = Eigen::Vector2d(0.04, 0.96).asDiagonal();
  return evidence;
}

Verdict JudgeGood(const JudgementOptions& options) {
  return Judge(options, GoodEvidence(), kScore, kMargin);
}

TEST(JudgeTest, AcceptsWhatPassesEveryLimit) {
  EXPECT_EQ(JudgeGood(JudgementOptions()), Verdict::kAccepted);
}

TEST(JudgeTest, EachLimitHasItsReason) {
  JudgementOptions options;
  options.min_overlap_area = 11.5;
  EXPECT_EQ(JudgeGood(options), Verdict::kTooLittleOverlap);
  options = JudgementOptions();
  options.max_contradiction_ratio = 0.23;
  EXPECT_EQ(JudgeGood(options), Verdict::kContradicted);
  options = JudgementOptions();
  options.min_scatter_eigenvalue = 0.05;
  EXPECT_EQ(JudgeGood(options), Verdict::kDegenerate);
  options = JudgementOptions();
  options.min_margin = kMargin + 0.1;
  EXPECT_EQ(JudgeGood(options), Verdict::kAmbiguous);
  options = JudgementOptions();
  options.min_score = kScore + 0.1;
  EXPECT_EQ(JudgeGood(options), Verdict::kUnlikely);
}

TEST(JudgeTest, TheWorseDirectionContradicts) {
  PairEvidence evidence = GoodEvidence();
  std::swap(evidence.query_in_reference, evidence.reference_in_query);
  evidence.query_in_reference.contradictions = 0.;
  evidence.reference_in_query.contradictions = 26.;
  EXPECT_EQ(Judge(JudgementOptions(), evidence, kScore, kMargin),
            Verdict::kContradicted);
}

TEST(JudgeTest, NoEvidenceIsTooLittle) {
  EXPECT_EQ(Judge(JudgementOptions(), PairEvidence(), 1e3, kMaxMargin),
            Verdict::kTooLittleOverlap);
}

TEST(JudgementScoreTest, RisesWithAgreementAndFallsWithContradictions) {
  const ScoreWeights weights;
  const PairEvidence evidence = GoodEvidence();
  const double score = Score(weights, evidence, kMargin);
  PairEvidence other = evidence;
  other.query_in_reference.contradictions += 2.;
  // 2 of 100 points in one of two directions.
  const double ratio = evidence.MeanContradictionRatio();
  EXPECT_NEAR(Score(weights, other, kMargin),
              score + weights.log_contradiction_ratio *
                          std::log((0.02 + ratio + 0.01) / (0.02 + ratio)),
              1e-9);
  other = evidence;
  other.tiles.num_tiles = 20.;
  EXPECT_NEAR(
      Score(weights, other, kMargin),
      score + weights.wall_evidence * (std::sqrt(20.) - std::sqrt(10.)) * 0.3,
      1e-9);
  EXPECT_NEAR(Score(weights, evidence, kMargin + 1.), score + weights.margin,
              1e-9);
}

}  // namespace
}  // namespace cartographer_sdf::judgement_test
