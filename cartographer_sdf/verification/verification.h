// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Decides whether a query submap lies in a reference submap as a hypothesis
// says: the few best of many hypotheses by their agreement of walls and free
// space, refined on the distance fields, and judged. A refusal has its reason.

#ifndef CARTOGRAPHER_SDF_VERIFICATION_VERIFICATION_H_
#define CARTOGRAPHER_SDF_VERIFICATION_VERIFICATION_H_

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/verification/agreement.h"
#include "cartographer_sdf/verification/ranking.h"
#include "cartographer_sdf/verification/registration.h"
#include "cartographer_sdf/verification/surface_model.h"

namespace cartographer_sdf {

enum class Verdict {
  kAccepted,
  kTooLittleOverlap,  // next to nothing was seen by both
  kContradicted,      // walls of one stand in free space of the other
  kUnlikely,          // too little agrees
  kDegenerate,        // walls face one way: one could slide along a corridor
  kAmbiguous,         // another pose is as good
};
// "accepted", "too_little_overlap", ...
[[nodiscard]] const char* VerdictName(Verdict verdict);

// The score, log-odds of being right, is linear in these terms. The weights are
// learned by logistic regression on pairs of submaps of several buildings, see
// scripts/learn_score.py and docs/design.md.
struct ScoreWeights {
  double contradiction_ratio = -99.5;  // mean of the two directions
  double log_overlap = 2.32;   // ln(0.05 + fraction of the smaller area)
  double wall_evidence = 0.8;  // Agreement::WallEvidence
  double sqrt_scatter_eigenvalue = 10.;
  double margin = 1.04;  // to the best distinct pose, capped
  double bias = -4.67;
};
[[nodiscard]] std::string Validate(const ScoreWeights& weights);

struct VerificationOptions {
  RankingOptions ranking;
  RegistrationOptions registration;
  AgreementOptions agreement;
  // Wall points of each submap on which the final agreement is measured.
  int num_agreement_points = 2000;
  ScoreWeights score_weights;
  // Least area seen by both [m^2].
  double min_overlap_area = 10.;
  // Largest ratio of contradicting wall points, the worse of both directions.
  double max_contradiction_ratio = 0.10;
  // Least smaller eigenvalue of the scatter of wall normals, in [0, 0.5].
  double min_scatter_eigenvalue = 0.03;
  // Least score; log-odds of being right.
  double min_score = 3.;
  // A distinct pose (1 m or 20 degrees away) whose score comes nearer than this
  // makes the pair ambiguous; log-odds.
  double min_margin = 0.7;
};
[[nodiscard]] std::string Validate(const VerificationOptions& options);

struct Agreement {
  DirectedAgreement query_in_reference;
  DirectedAgreement reference_in_query;
  TileAgreement tiles;
  double overlap_area = 0.;  // [m^2]
  double overlap = 0.;       // of the smaller observed area
  double min_scatter_eigenvalue = 0.;
  // How much the walls speak for the pose: grows with the number of places
  // that agree, and is negative where fewer do than by chance under the best
  // of wrong poses. Places near each other tell much the same, so that their
  // number counts by a power below one.
  [[nodiscard]] double WallEvidence() const;
};

// The cap of a pose's margin, of the score without the margin, to the best
// distinct pose of the same pair; also where there is none.
constexpr double kMaxMargin = 4.;

// The terms of ScoreWeights without the bias, in their order.
constexpr int kNumScoreTerms = 5;
// The names of their weights.
[[nodiscard]] std::array<const char*, kNumScoreTerms> ScoreTermNames();
[[nodiscard]] std::array<double, kNumScoreTerms> ScoreTerms(
    const Agreement& agreement, double margin);
[[nodiscard]] double Score(const ScoreWeights& weights,
                           const Agreement& agreement, double margin);

struct Verification {
  Verdict verdict;
  Rigid2 T_reference_query;  // refined
  // Inverse covariance of T_reference_query, perturbed as Registration's.
  Eigen::Matrix3d information;
  double score;  // log-odds of being right
  Agreement agreement;
  // To the best distinct pose, at most kMaxMargin; negative where that is the
  // better one.
  double margin;
  // Distinct poses that score nearly as well, best first; at most
  // kMaxNumRivals.
  std::vector<Rigid2> rivals;
};

constexpr size_t kMaxNumRivals = 3;

// The first test that fails, or accepted.
[[nodiscard]] Verdict Judge(const VerificationOptions& options,
                            const Agreement& agreement, double score,
                            double margin);

// None where no hypothesis is worth refining. Independent of the order of the
// hypotheses. Rivals of the best pose are the other hypotheses and, where it is
// more likely right than wrong, its half turn, its shifts along the walls, and
// what it becomes by self-similar poses of either submap.
[[nodiscard]] std::optional<Verification> VerifyHypotheses(
    const VerificationOptions& options, const SurfaceModel& reference,
    const SurfaceModel& query,
    const std::vector<Rigid2>& hypotheses_T_reference_query);

// Each of the poses, refined, whatever it scores; of those that become nearly
// the same the best. Best first. Margins are those to each other and to the
// rivals as above.
[[nodiscard]] std::vector<Verification> VerifyPoses(
    const VerificationOptions& options, const SurfaceModel& reference,
    const SurfaceModel& query, const std::vector<Rigid2>& T_reference_query);

// The poses among the hypotheses, refined, in which the submap resembles itself
// and which are distinct from the identity and from each other; best first.
[[nodiscard]] std::vector<Rigid2> FindSelfSimilarPoses(
    const VerificationOptions& options, const SurfaceModel& model,
    const std::vector<Rigid2>& hypotheses);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_VERIFICATION_VERIFICATION_H_
