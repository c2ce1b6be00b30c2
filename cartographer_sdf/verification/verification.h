// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Verifies hypotheses of the pose of a query submap in a reference submap:
// ranks them, registers the best on the distance fields, measures each and
// judges the best against its rivals. Poses are T_reference_query between
// submap frames [m, rad].

#ifndef CARTOGRAPHER_SDF_VERIFICATION_VERIFICATION_H_
#define CARTOGRAPHER_SDF_VERIFICATION_VERIFICATION_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/geometry/distinct_poses.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/place/surface_model.h"
#include "cartographer_sdf/verification/crossing_wall.h"
#include "cartographer_sdf/verification/evidence.h"
#include "cartographer_sdf/verification/hypothesis_ranking.h"
#include "cartographer_sdf/verification/judgement.h"
#include "cartographer_sdf/verification/registration.h"

namespace cartographer_sdf {

// Most poses of most pairs are wrong, and few points show it: after the coarse
// half of registration, poses are measured on few points, and only those that
// may be the best or its rivals are registered and measured fully.
struct ScreeningOptions {
  // Wall points of each submap that are measured.
  int num_points = 300;
  // Of several poses, only the best is completed if it and the others score
  // lower than this; log-odds, without the margin.
  double min_score = -12.;
  // Poses that score lower than the best by more are dropped: they can be no
  // rivals (kMaxMargin), by more than the error of a score on few points.
  double max_score_gap = 8.;
};
[[nodiscard]] std::string Validate(const ScreeningOptions& options);

struct VerificationOptions {
  RankingOptions ranking;
  ScreeningOptions screening;
  RegistrationOptions registration;
  AgreementOptions agreement;
  JudgementOptions judgement;
  // Of the pairs of two trajectories or maps that matches put together.
  CrossingOptions crossing;
};
[[nodiscard]] std::string Validate(const VerificationOptions& options);

// Poses of a pair that differ by more than this, at the centroid of the query,
// are rivals: at most one of them is correct.
constexpr PoseTolerance kRivalTolerance{1., 0.35};
constexpr size_t kMaxNumRivals = 3;

// A registered pose, measured but not yet judged.
struct MeasuredPose {
  Rigid2 T_reference_query;
  PairEvidence evidence;
};

struct VerifiedPose {
  Verdict verdict;
  Rigid2 T_reference_query;  // registered
  PairEvidence evidence;
  double score;  // log-odds of being correct
  // Lead over the best distinct pose, in scores without the margin term; within
  // [-kMaxMargin, kMaxMargin], negative if the other is better.
  double margin;
  // Distinct poses that score nearly as well, best first; at most
  // kMaxNumRivals.
  std::vector<Rigid2> rivals;
};

// Registers the pair from the guess and measures it there; none if the walls do
// not determine a pose.
[[nodiscard]] std::optional<MeasuredPose> RegisterAndMeasure(
    const VerificationOptions& options, const SurfaceModel& reference,
    const SurfaceModel& query, const Rigid2& guess_T_reference_query);

// Verifies many hypotheses and returns the best, judged. Its rivals are the
// other hypotheses and, if it is more likely correct than not, its half turn,
// its shifts along the walls, and its compositions with self-similar poses of
// either submap. None if no hypothesis is worth registering. Independent of the
// order of the hypotheses.
[[nodiscard]] std::optional<VerifiedPose> VerifyHypotheses(
    const VerificationOptions& options, const SurfaceModel& reference,
    const SurfaceModel& query,
    const std::vector<Rigid2>& hypotheses_T_reference_query);

// Registers and judges each of the poses, whatever its score, and the best of
// further hypotheses, as VerifyHypotheses chooses them; best first. Of poses
// that registration makes nearly equal, keeps the best. Rivals are the other
// poses and those listed above.
[[nodiscard]] std::vector<VerifiedPose> VerifyPoses(
    const VerificationOptions& options, const SurfaceModel& reference,
    const SurfaceModel& query, const std::vector<Rigid2>& T_reference_query,
    const std::vector<Rigid2>& hypotheses_T_reference_query);

// Registers and judges one claimed pose against `competitors` and all rivals
// above, even if it is unlikely. None if the walls do not determine a pose.
[[nodiscard]] std::optional<VerifiedPose> VerifyClaim(
    const VerificationOptions& options, const SurfaceModel& reference,
    const SurfaceModel& query, const Rigid2& claimed_T_reference_query,
    const std::vector<Rigid2>& competitors_T_reference_query);

// Returns the registered hypotheses under which the submap resembles itself,
// distinct from the identity and from each other; best first.
[[nodiscard]] std::vector<Rigid2> FindSelfSimilarPoses(
    const VerificationOptions& options, const SurfaceModel& model,
    const std::vector<Rigid2>& hypotheses);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_VERIFICATION_VERIFICATION_H_
