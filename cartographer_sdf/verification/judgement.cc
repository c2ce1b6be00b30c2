// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/judgement.h"

#include <algorithm>
#include <cmath>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// A term of the score: its name and the field of its weight.
struct ScoreTerm {
  const char* name;
  double ScoreWeights::*weight;
};
constexpr std::array<ScoreTerm, kNumScoreTerms> kScoreTerms = {
    {{"log_contradiction_ratio", &ScoreWeights::log_contradiction_ratio},
     {"log_overlap", &ScoreWeights::log_overlap},
     {"wall_evidence", &ScoreWeights::wall_evidence},
     {"sqrt_scatter_eigenvalue", &ScoreWeights::sqrt_scatter_eigenvalue},
     {"margin", &ScoreWeights::margin}}};

}  // namespace

const char* VerdictName(const Verdict verdict) {
  switch (verdict) {
    case Verdict::kAccepted:
      return "accepted";
    case Verdict::kTooLittleOverlap:
      return "too_little_overlap";
    case Verdict::kContradicted:
      return "contradicted";
    case Verdict::kUnlikely:
      return "unlikely";
    case Verdict::kUncertain:
      return "uncertain";
    case Verdict::kDegenerate:
      return "degenerate";
    case Verdict::kAmbiguous:
      return "ambiguous";
  }
  LOG(FATAL) << "not a verdict: " << static_cast<int>(verdict);
}

std::string Validate(const ScoreWeights& weights) {
  for (const ScoreTerm& term : kScoreTerms) {
    if (!std::isfinite(weights.*term.weight)) {
      return std::string(term.name) + " must be finite";
    }
  }
  if (!std::isfinite(weights.bias)) return "bias must be finite";
  return "";
}

std::string Validate(const JudgementOptions& options) {
  if (!(options.min_overlap_area >= 0. &&
        options.max_contradiction_ratio >= 0. &&
        options.min_scatter_eigenvalue >= 0. && options.min_margin >= 0.)) {
    return "min_overlap_area, max_contradiction_ratio, min_scatter_eigenvalue "
           "and min_margin must not be negative";
  }
  if (!std::isfinite(options.min_score)) return "min_score must be finite";
  return Validate(options.score_weights);
}

std::array<const char*, kNumScoreTerms> ScoreTermNames() {
  std::array<const char*, kNumScoreTerms> names = {};
  for (int k = 0; k < kNumScoreTerms; ++k) names[k] = kScoreTerms[k].name;
  return names;
}

std::array<double, kNumScoreTerms> ScoreTerms(const PairEvidence& evidence,
                                              const double margin) {
  return {std::log(0.02 + evidence.MeanContradictionRatio()),
          std::log(0.05 + evidence.overlap), evidence.WallEvidence(),
          std::sqrt(std::max(evidence.MinScatterEigenvalue(), 0.)), margin};
}

double Score(const ScoreWeights& weights, const PairEvidence& evidence,
             const double margin) {
  const std::array<double, kNumScoreTerms> terms = ScoreTerms(evidence, margin);
  double score = weights.bias;
  for (int k = 0; k < kNumScoreTerms; ++k) {
    score += weights.*kScoreTerms[k].weight * terms[k];
  }
  return score;
}

Verdict Judge(const JudgementOptions& options, const PairEvidence& evidence,
              const double score, const double margin) {
  if (evidence.overlap_area < options.min_overlap_area) {
    return Verdict::kTooLittleOverlap;
  }
  if (evidence.ContradictionRatio() > options.max_contradiction_ratio) {
    return Verdict::kContradicted;
  }
  if (evidence.MinScatterEigenvalue() < options.min_scatter_eigenvalue) {
    return Verdict::kDegenerate;
  }
  if (margin < options.min_margin) return Verdict::kAmbiguous;
  if (score < options.min_score) return Verdict::kUnlikely;
  return Verdict::kAccepted;
}

}  // namespace cartographer_sdf
