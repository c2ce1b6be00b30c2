// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/claim_examination.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace cartographer_sdf {
namespace {

// Measures whether registration keeps the claimed pose within the tolerance of
// the grouping of constraints.
void MeasureShift(const GroupingOptions& options, const SurfaceModel& query,
                  const Rigid2& claimed, const Rigid2& registered,
                  ClaimEvidence* const claim) {
  const Eigen::Vector2d centroid = ObservedCentroid(query);
  claim->shift = (registered * centroid - claimed * centroid).norm();
  claim->turn =
      std::abs(NormalizeAngle(registered.rotation() - claimed.rotation()));
  claim->is_held = *claim->shift <= options.max_distance_meters &&
                   *claim->turn <= options.max_rotation;
}

ClaimEvidence ExamineClaim(const VerificationOptions& options,
                           const GroupingOptions& grouping,
                           const Place& reference, const Place& query,
                           const std::optional<Match>& recognized,
                           const Rigid2& claimed) {
  ClaimEvidence claim;
  std::vector<Rigid2> competitors;
  if (recognized) competitors.push_back(recognized->pair.T_reference_query);
  const std::optional<VerifiedPose> verified = VerifyClaim(
      options, reference.surface, query.surface, claimed, competitors);
  if (verified) {
    MeasureShift(grouping, query.surface, claimed, verified->T_reference_query,
                 &claim);
  }
  if (claim.is_held) {
    claim.T_reference_query = verified->T_reference_query;
    claim.evidence = verified->evidence;
    claim.margin = verified->margin;
    claim.score = verified->score;
    return claim;
  }
  claim.T_reference_query = claimed;
  claim.evidence = MeasurePair(options.agreement, options.registration,
                               reference.surface, query.surface, claimed);
  const ScoreWeights& weights = options.judgement.score_weights;
  claim.margin = kMaxMargin;
  if (recognized &&
      !AreNear(recognized->pair.T_reference_query, claimed,
               ObservedCentroid(query.surface), kRivalTolerance)) {
    claim.margin = std::clamp(Score(weights, claim.evidence, 0.) -
                                  Score(weights, recognized->evidence, 0.),
                              -kMaxMargin, kMaxMargin);
  }
  claim.score = Score(weights, claim.evidence, claim.margin);
  return claim;
}

}  // namespace

std::vector<AuditedGroup> ExamineGroups(
    const MatchOptions& match_options, const AuditOptions& options,
    const std::map<SubmapId, Place>& places,
    const std::vector<ConstraintGroup>& groups, const Executor& executor,
    const ProgressCallback& on_progress) {
  using PairOfSubmaps = std::pair<SubmapId, SubmapId>;
  std::map<PairOfSubmaps, std::vector<size_t>> groups_of_pair;
  for (size_t k = 0; k < groups.size(); ++k) {
    groups_of_pair[{groups[k].reference, groups[k].query}].push_back(k);
  }
  const std::vector<std::pair<PairOfSubmaps, std::vector<size_t>>> pairs(
      groups_of_pair.begin(), groups_of_pair.end());
  std::vector<AuditedGroup> audited(groups.size());
  TaskProgress progress(on_progress, pairs.size());
  executor(pairs.size(), [&](const size_t pair) {
    const Place& reference = places.at(pairs[pair].first.first);
    const Place& query = places.at(pairs[pair].first.second);
    // Once for all groups of the pair.
    const std::optional<Match> recognized =
        MatchPlaces(match_options, reference, query);
    for (const size_t k : pairs[pair].second) {
      audited[k].group = groups[k];
      audited[k].claim =
          ExamineClaim(match_options.verification, options.grouping, reference,
                       query, recognized, groups[k].T_reference_query);
    }
    progress.TaskIsDone();
  });
  return audited;
}

AuditVerdict JudgeLooks(const AuditOptions& options,
                        const ClaimEvidence& claim) {
  if (claim.evidence.ContradictionRatio() > options.max_contradiction_ratio) {
    return AuditVerdict::kContradicted;
  }
  if (claim.margin < options.min_margin) return AuditVerdict::kAmbiguous;
  if (!claim.is_held || claim.score < options.min_score) {
    return AuditVerdict::kUnlikely;
  }
  return AuditVerdict::kConfirmed;
}

}  // namespace cartographer_sdf
