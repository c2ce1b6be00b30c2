// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Judges the evidence of a pair at a pose: a score, the log-odds of the pose
// being correct, and a verdict with its reason.

#ifndef CARTOGRAPHER_SDF_VERIFICATION_JUDGEMENT_H_
#define CARTOGRAPHER_SDF_VERIFICATION_JUDGEMENT_H_

#include <array>
#include <string>

#include "cartographer_sdf/verification/evidence.h"

namespace cartographer_sdf {

enum class Verdict {
  kAccepted,
  kTooLittleOverlap,  // both observed too little in common
  kContradicted,      // walls of one stand in free space of the other
  kUnlikely,          // too little agreement
  kUncertain,         // likely, but certain matches do not support it
  kDegenerate,        // walls face one way: the pose could slide along them
  kAmbiguous,         // another pose is as good
};
// "accepted", "too_little_overlap", ...
[[nodiscard]] const char* VerdictName(Verdict verdict);
// Whether a match is accepted, or lacks only the support of others, which may
// come from elsewhere.
[[nodiscard]] inline bool IsLikely(const Verdict verdict) {
  return verdict == Verdict::kAccepted || verdict == Verdict::kUncertain;
}

// The score is linear in these terms. The weights are learned by logistic
// regression on pairs of submaps of several buildings; see
// scripts/learn_score.py.
struct ScoreWeights {
  // ln(0.02 + the mean contradiction ratio of both directions): the first
  // walls that contradict say more than further ones, as moved furniture does.
  double log_contradiction_ratio = -2.1;
  double log_overlap = 1.69;  // ln(0.05 + PairEvidence::overlap)
  double wall_evidence = 1.43;
  double sqrt_scatter_eigenvalue = 14.7;
  double margin = 0.69;  // to the best distinct pose, capped
  double bias = -15.;
};
[[nodiscard]] std::string Validate(const ScoreWeights& weights);

struct JudgementOptions {
  ScoreWeights score_weights;
  // Least area observed by both submaps [m^2].
  double min_overlap_area = 10.;
  // Largest ratio of contradicting wall points, in the worse direction.
  double max_contradiction_ratio = 0.25;
  // Lower bound on the smaller eigenvalue of the scatter of wall normals, in
  // [0, 0.5].
  double min_scatter_eigenvalue = 0.03;
  // Least score; log-odds of being correct.
  double min_score = 4.;
  // A distinct pose (1 m or 20 degrees away) whose score is closer than this
  // makes the pair ambiguous; log-odds.
  double min_margin = 0.7;
};
[[nodiscard]] std::string Validate(const JudgementOptions& options);

// The margin is capped at this; also the margin of a pose without rivals.
constexpr double kMaxMargin = 4.;

// The terms of ScoreWeights without the bias, in order, and their names.
constexpr int kNumScoreTerms = 5;
[[nodiscard]] std::array<const char*, kNumScoreTerms> ScoreTermNames();
[[nodiscard]] std::array<double, kNumScoreTerms> ScoreTerms(
    const PairEvidence& evidence, double margin);
[[nodiscard]] double Score(const ScoreWeights& weights,
                           const PairEvidence& evidence, double margin);

// Returns the reason of the first failed test, or kAccepted. `score` may
// include evidence beyond the pair (neighbourhood.h).
[[nodiscard]] Verdict Judge(const JudgementOptions& options,
                            const PairEvidence& evidence, double score,
                            double margin);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_VERIFICATION_JUDGEMENT_H_
