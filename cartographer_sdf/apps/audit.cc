// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/audit.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "cartographer_sdf/place_store/described_map.h"
#include "glog/logging.h"

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

// Judges the pair by its appearance.
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

PairPose ToPair(const AuditedGroup& group) {
  // An unlikely group has zero weight.
  const double score = group.verdict == AuditVerdict::kConfirmed
                           ? group.claim.score
                           : std::min(group.claim.score, 0.);
  return {group.group.reference, group.group.query,
          group.claim.T_reference_query, score};
}

// Likely groups become doubtful if cycles contradict them; others are confirmed
// if cycles support them, unless free space contradicts them.
void JudgeCycles(const ConsistencyOptions& consistency,
                 const std::map<SubmapId, OdometryPose>& odometry,
                 std::vector<AuditedGroup>* const groups) {
  std::vector<PairPose> pairs;
  for (const AuditedGroup& group : *groups) pairs.push_back(ToPair(group));
  const std::vector<SelectionResult> results =
      SelectConsistent(consistency, odometry, pairs);
  for (size_t k = 0; k < groups->size(); ++k) {
    AuditedGroup& group = (*groups)[k];
    group.cycles = results[k];
    if (results[k].selection == Selection::kInconsistent) {
      group.verdict = AuditVerdict::kOutvoted;
    } else if (group.verdict == AuditVerdict::kConfirmed &&
               results[k].selection == Selection::kUnsupported) {
      group.verdict = AuditVerdict::kUnsupported;
    } else if ((group.verdict == AuditVerdict::kAmbiguous ||
                group.verdict == AuditVerdict::kUnlikely) &&
               results[k].selection == Selection::kSelected) {
      group.verdict = AuditVerdict::kConfirmed;
    }
  }
}

PoseGraph WithoutDoubtful(const PoseGraph& pose_graph,
                          const std::vector<AuditedConstraint>& constraints) {
  std::vector<bool> is_dropped(pose_graph.constraints.size(), false);
  for (const AuditedConstraint& audited : constraints) {
    is_dropped[audited.constraint] = IsDoubtful(audited.verdict);
  }
  PoseGraph result = pose_graph;
  result.constraints.clear();
  for (size_t k = 0; k < pose_graph.constraints.size(); ++k) {
    if (!is_dropped[k]) result.constraints.push_back(pose_graph.constraints[k]);
  }
  return result;
}

void MeasureErrors(const PoseGraph& constraints_of, const PoseGraph& poses,
                   std::vector<AuditedConstraint>* const constraints) {
  for (AuditedConstraint& audited : *constraints) {
    audited.error_after = ConstraintResidual(
        poses, constraints_of.constraints[audited.constraint]);
  }
}

// Marks the constraints that the map contradicts most as doubtful; false if
// there are none.
bool DoubtOutliers(const OutlierRejectionOptions& options,
                   std::vector<AuditedConstraint>* const constraints) {
  std::vector<std::optional<ConstraintError>> errors;
  for (const AuditedConstraint& audited : *constraints) {
    errors.push_back(IsDoubtful(audited.verdict)
                         ? std::nullopt
                         : std::make_optional(audited.error_after));
  }
  const std::vector<size_t> outliers = FindOutliers(options, errors);
  for (const size_t k : outliers) {
    (*constraints)[k].verdict = AuditVerdict::kContradictedByMap;
  }
  return !outliers.empty();
}

// Keeps doubtful constraints that agree with the map made without them.
bool Rehabilitate(const AuditOptions& options,
                  std::vector<AuditedConstraint>* const constraints) {
  bool any = false;
  for (AuditedConstraint& audited : *constraints) {
    if (IsDoubtful(audited.verdict) &&
        audited.error_after.translation <=
            options.max_agreeing_translation_meters &&
        audited.error_after.rotation <= options.max_agreeing_rotation) {
      audited.verdict = AuditVerdict::kAgreesWithMap;
      any = true;
    }
  }
  return any;
}

size_t CountDoubtful(const std::vector<AuditedConstraint>& constraints) {
  return static_cast<size_t>(std::count_if(
      constraints.begin(), constraints.end(),
      [](const AuditedConstraint& c) { return IsDoubtful(c.verdict); }));
}

std::vector<AuditedConstraint> ListConstraints(
    const PoseGraph& pose_graph, const GroupedConstraints& grouped,
    const std::vector<AuditedGroup>& groups) {
  std::map<size_t, AuditVerdict> verdicts;
  for (const size_t constraint : grouped.unrelated) {
    verdicts[constraint] = AuditVerdict::kUnchecked;
  }
  for (const AuditedGroup& group : groups) {
    for (const size_t constraint : group.group.constraints) {
      verdicts[constraint] = group.verdict;
    }
  }
  std::vector<AuditedConstraint> constraints;
  for (const auto& [constraint, verdict] : verdicts) {
    const ConstraintError error =
        ConstraintResidual(pose_graph, pose_graph.constraints[constraint]);
    constraints.push_back({constraint, verdict, error, error});
  }
  return constraints;
}

// Tests the constraints against the map made without the doubtful ones.
void JudgeByMap(const AuditOptions& options,
                const std::set<int>& frozen_trajectories,
                const ProgressCallback& on_progress, Audit* const audit) {
  const PoseGraph& before = audit->state.pose_graph;
  std::vector<AuditedConstraint>* const constraints = &audit->constraints;
  audit->pose_graph = before;
  const int num_rounds = options.outlier_rejection.max_num_rounds + 2;
  int round = 0;
  const auto optimize = [&] {
    // Starts from the given poses each time, so that dropped constraints have
    // no effect.
    audit->pose_graph = WithoutDoubtful(before, *constraints);
    audit->optimizations.push_back(
        Optimize(audit->optimization, frozen_trajectories, &audit->pose_graph));
    MeasureErrors(before, audit->pose_graph, constraints);
    if (on_progress) on_progress(static_cast<double>(++round) / num_rounds);
  };
  if (CountDoubtful(*constraints) > 0) optimize();
  for (int k = 0; k < options.outlier_rejection.max_num_rounds; ++k) {
    if (!DoubtOutliers(options.outlier_rejection, constraints)) break;
    optimize();
  }
  const bool rehabilitated = Rehabilitate(options, constraints);
  audit->num_doubtful = CountDoubtful(*constraints);
  if (audit->num_doubtful == 0) {
    audit->pose_graph = before;
    MeasureErrors(before, before, constraints);
  } else if (rehabilitated) {
    optimize();
  }
}

}  // namespace

std::string Validate(const AuditOptions& options) {
  for (const std::string& error :
       {Validate(options.grouping), Validate(options.outlier_rejection)}) {
    if (!error.empty()) return error;
  }
  if (!(options.max_contradiction_ratio >= 0. &&
        options.max_agreeing_translation_meters >= 0. &&
        options.max_agreeing_rotation >= 0.)) {
    return "max_contradiction_ratio, max_agreeing_translation_meters and "
           "max_agreeing_rotation must not be negative";
  }
  if (!std::isfinite(options.min_margin) || !std::isfinite(options.min_score)) {
    return "min_margin and min_score must be finite";
  }
  return "";
}

const char* AuditVerdictName(const AuditVerdict verdict) {
  // In the order of the enumerators.
  constexpr const char* kNames[] = {
      "confirmed",    "agrees_with_map", "unchecked",
      "contradicted", "ambiguous",       "unlikely",
      "outvoted",     "unsupported",     "contradicted_by_map"};
  static_assert(std::size(kNames) ==
                static_cast<size_t>(AuditVerdict::kContradictedByMap) + 1);
  return kNames[static_cast<size_t>(verdict)];
}

bool IsDoubtful(const AuditVerdict verdict) {
  return verdict != AuditVerdict::kConfirmed &&
         verdict != AuditVerdict::kAgreesWithMap &&
         verdict != AuditVerdict::kUnchecked;
}

absl::StatusOr<Audit> AuditMap(const LoopClosingOptions& loop_closing,
                               const AuditOptions& options,
                               const MapSource& source,
                               const std::set<int>& frozen_trajectories,
                               const Executor& executor,
                               const StageCallback& on_stage) {
  CHECK_EQ(Validate(loop_closing), "");
  CHECK_EQ(Validate(options), "");
  const MatchOptions& match = loop_closing.recognition.match;
  CHECK(match.method == Method::kSdf) << "the paper's method verifies nothing";
  absl::Status status = CheckHasTrajectories(source.path, frozen_trajectories);
  if (!status.ok()) return status;
  Audit audit;
  StageClock clock(on_stage, &audit.stage_seconds);
  absl::StatusOr<DescribedMap> map =
      DescribeMap(loop_closing.place, match, source, executor,
                  clock.Begin("read and describe"));
  if (!map.ok()) return map.status();
  const PoseGraph& pose_graph = map->state.pose_graph;
  std::map<SubmapId, Eigen::Vector2d> centroids;
  for (const auto& [id, place] : map->places) {
    centroids.emplace(id, ObservedCentroid(place.surface));
  }
  const GroupedConstraints grouped =
      GroupConstraints(options.grouping, pose_graph, centroids);
  audit.groups = ExamineGroups(match, options, map->places, grouped.groups,
                               executor, clock.Begin("compare submaps"));
  for (AuditedGroup& group : audit.groups) {
    group.verdict = JudgeLooks(options, group.claim);
  }
  clock.Begin("check cycles");
  JudgeCycles(loop_closing.closing.consistency, map->odometry, &audit.groups);
  audit.constraints = ListConstraints(pose_graph, grouped, audit.groups);
  audit.optimization = OptimizationInForce(loop_closing.closing, pose_graph);
  audit.state = std::move(map->state);
  JudgeByMap(options, frozen_trajectories, clock.Begin("optimise"), &audit);
  clock.End();
  return audit;
}

}  // namespace cartographer_sdf
