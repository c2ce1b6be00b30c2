// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/sessions/pose_check.h"

#include <algorithm>

#include "cartographer_sdf/verification/agreement.h"
#include "cartographer_sdf/verification/ranking.h"
#include "cartographer_sdf/verification/registration.h"
#include "cartographer_sdf/verification/verification.h"

namespace cartographer_sdf {
namespace {

// Of the smaller observed area; less says little.
constexpr double kMinOverlap = 0.4;

Eigen::Vector2d MiddleOf(const Place& place) {
  const CellGeometry& geometry = place.surface.geometry;
  return geometry.T_submap_grid *
         Eigen::Vector2d(0.5 * geometry.resolution *
                         geometry.size.matrix().cast<double>());
}

Match MatchOf(const Place& reference, const Place& query,
              const Verification& verification) {
  Match match;
  match.verdict = verification.verdict;
  match.closure.reference = reference.id;
  match.closure.query = query.id;
  match.closure.T_reference_query = verification.T_reference_query;
  match.closure.information = verification.information;
  match.closure.score = verification.score;
  const Agreement& agreement = verification.agreement;
  ClosureEvidence& evidence = match.closure.evidence;
  evidence.overlap = agreement.overlap;
  evidence.overlap_area = agreement.overlap_area;
  evidence.hit_ratio = std::min(agreement.query_in_reference.HitRatio(),
                                agreement.reference_in_query.HitRatio());
  evidence.contradiction_ratio =
      std::max(agreement.query_in_reference.ContradictionRatio(),
               agreement.reference_in_query.ContradictionRatio());
  match.verification = verification;
  return match;
}

}  // namespace

double ObservedArea(const Place& place) {
  return static_cast<double>(place.surface.observed_points.size()) *
         place.surface.area_per_observed_point;
}

bool Overlap(const Place& reference, const Place& query,
             const Rigid2& T_reference_query) {
  return OverlapArea(reference.surface, query.surface, T_reference_query) >=
         kMinOverlap * std::min(ObservedArea(reference), ObservedArea(query));
}

std::optional<Match> VerifyPose(const MatchOptions& options,
                                const Place& reference, const Place& query,
                                const Rigid2& T_reference_query,
                                const double max_distance,
                                const double max_rotation) {
  const std::optional<Verification> verification =
      VerifyHypotheses(options.verification, reference.surface, query.surface,
                       {T_reference_query});
  if (!verification || verification->verdict != Verdict::kAccepted ||
      !AreNear(verification->T_reference_query, T_reference_query,
               MiddleOf(query), max_distance, max_rotation)) {
    return std::nullopt;
  }
  return MatchOf(reference, query, *verification);
}

std::optional<Match> FindContradiction(const MatchOptions& options,
                                       const double max_contradiction_ratio,
                                       const Place& reference,
                                       const Place& query,
                                       const Rigid2& T_reference_query) {
  const VerificationOptions& verification = options.verification;
  const std::optional<Registration> registration =
      RegisterSubmaps(verification.registration, reference.surface,
                      query.surface, T_reference_query);
  const Rigid2 pose =
      registration ? registration->T_reference_query : T_reference_query;
  const size_t num_points =
      static_cast<size_t>(verification.num_agreement_points);
  const DirectedAgreement forward =
      MeasureAgreement(verification.agreement, reference.surface, query.surface,
                       pose, num_points);
  const DirectedAgreement backward =
      MeasureAgreement(verification.agreement, query.surface, reference.surface,
                       pose.Inverse(), num_points);
  const double mean_ratio =
      0.5 * (forward.ContradictionRatio() + backward.ContradictionRatio());
  if (mean_ratio <= max_contradiction_ratio) return std::nullopt;
  Match match;
  match.verdict = Verdict::kContradicted;
  match.closure.reference = reference.id;
  match.closure.query = query.id;
  match.closure.T_reference_query = pose;
  match.closure.evidence.hit_ratio =
      std::min(forward.HitRatio(), backward.HitRatio());
  match.closure.evidence.contradiction_ratio =
      std::max(forward.ContradictionRatio(), backward.ContradictionRatio());
  return match;
}

}  // namespace cartographer_sdf
