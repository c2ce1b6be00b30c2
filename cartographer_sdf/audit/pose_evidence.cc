// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/audit/pose_evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// As verification's: poses farther apart than this are rivals [m], [rad].
constexpr double kDistinctDistance = 1.;
constexpr double kDistinctRotation = 0.35;

// Judges any pose, however bad, and asks its rivals.
VerificationOptions WithoutThresholds(const VerificationOptions& options) {
  VerificationOptions result = options;
  result.ranking.num_refined = 1;
  result.ranking.min_coarse_score = -std::numeric_limits<double>::infinity();
  result.ranking.min_fine_score = -std::numeric_limits<double>::infinity();
  result.min_score = -std::numeric_limits<double>::infinity();
  return result;
}

// What can be said of a pose that can't be registered.
Agreement AgreementAsClaimed(const VerificationOptions& options,
                             const SurfaceModel& reference,
                             const SurfaceModel& query,
                             const Rigid2& T_reference_query) {
  const size_t num_points = static_cast<size_t>(options.num_agreement_points);
  Agreement agreement;
  agreement.query_in_reference = MeasureAgreement(
      options.agreement, reference, query, T_reference_query, num_points);
  agreement.reference_in_query =
      MeasureAgreement(options.agreement, query, reference,
                       T_reference_query.Inverse(), num_points);
  agreement.tiles = MeasureTileAgreement(options.agreement, reference, query,
                                         T_reference_query, num_points);
  agreement.overlap_area = OverlapArea(reference, query, T_reference_query);
  const auto area = [](const SurfaceModel& model) {
    return static_cast<double>(model.observed_points.size()) *
           model.area_per_observed_point;
  };
  agreement.overlap = std::min(
      1., agreement.overlap_area / std::min(area(reference), area(query)));
  return agreement;
}

}  // namespace

Eigen::Vector2d MiddleOf(const SurfaceModel& model) {
  CHECK(!model.observed_points.empty());
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : model.observed_points) sum += point;
  return sum / static_cast<double>(model.observed_points.size());
}

PoseEvidence ExaminePose(const VerificationOptions& options,
                         const double max_shift, const double max_turn,
                         const SurfaceModel& reference,
                         const SurfaceModel& query,
                         const std::optional<Match>& recognized,
                         const Rigid2& claimed_T_reference_query) {
  const Eigen::Vector2d middle = MiddleOf(query);
  PoseEvidence evidence;
  evidence.T_reference_query = claimed_T_reference_query;
  const std::optional<Verification> registered =
      VerifyHypotheses(WithoutThresholds(options), reference, query,
                       {claimed_T_reference_query});
  if (registered) {
    const Rigid2& pose = registered->T_reference_query;
    evidence.shift =
        (pose * middle - claimed_T_reference_query * middle).norm();
    evidence.turn = std::abs(
        NormalizeAngle(pose.rotation() - claimed_T_reference_query.rotation()));
    evidence.is_held =
        *evidence.shift <= max_shift && *evidence.turn <= max_turn;
  }
  evidence.margin = kMaxMargin;
  if (evidence.is_held) {
    evidence.T_reference_query = registered->T_reference_query;
    evidence.agreement = registered->agreement;
    evidence.margin = registered->margin;
  } else {
    evidence.agreement = AgreementAsClaimed(options, reference, query,
                                            claimed_T_reference_query);
  }
  const ScoreWeights& weights = options.score_weights;
  const double without_margin = Score(weights, evidence.agreement, 0.);
  if (recognized && recognized->verification) {
    const Verification& other = *recognized->verification;
    evidence.recognized_T_reference_query = other.T_reference_query;
    if (!AreNear(other.T_reference_query, evidence.T_reference_query, middle,
                 kDistinctDistance, kDistinctRotation)) {
      evidence.margin =
          std::min(evidence.margin,
                   without_margin - Score(weights, other.agreement, 0.));
    }
  }
  evidence.score = Score(weights, evidence.agreement, evidence.margin);
  return evidence;
}

}  // namespace cartographer_sdf
