// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/audit.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/apps/claim_examination.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

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

std::set<size_t> DoubtfulOf(const std::vector<AuditedConstraint>& constraints) {
  std::set<size_t> doubtful;
  for (const AuditedConstraint& audited : constraints) {
    if (IsDoubtful(audited.verdict)) doubtful.insert(audited.constraint);
  }
  return doubtful;
}

PoseGraph Without(const std::set<size_t>& dropped,
                  const PoseGraph& pose_graph) {
  PoseGraph result = pose_graph;
  result.constraints.clear();
  for (size_t k = 0; k < pose_graph.constraints.size(); ++k) {
    if (dropped.count(k) == 0) {
      result.constraints.push_back(pose_graph.constraints[k]);
    }
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
void Rehabilitate(const AuditOptions& options,
                  std::vector<AuditedConstraint>* const constraints) {
  for (AuditedConstraint& audited : *constraints) {
    if (IsDoubtful(audited.verdict) &&
        audited.error_after.translation <=
            options.max_agreeing_translation_meters &&
        audited.error_after.rotation <= options.max_agreeing_rotation) {
      audited.verdict = AuditVerdict::kAgreesWithMap;
    }
  }
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

std::map<SubmapId, Eigen::Vector2d> CentroidsOf(
    const std::map<SubmapId, Place>& places) {
  std::map<SubmapId, Eigen::Vector2d> centroids;
  for (const auto& [id, place] : places) {
    centroids.emplace(id, ObservedCentroid(place.surface));
  }
  return centroids;
}

OptimizationOptions WithoutOdometry(OptimizationOptions options) {
  options.odometry_translation_weight = 0.;
  options.odometry_rotation_weight = 0.;
  return options;
}

bool ContradictsKept(const OutlierRejectionOptions& options,
                     const std::set<size_t>& dropped,
                     const std::vector<AuditedConstraint>& constraints) {
  std::vector<std::optional<ConstraintError>> errors;
  for (const AuditedConstraint& audited : constraints) {
    errors.push_back(dropped.count(audited.constraint) > 0
                         ? std::nullopt
                         : std::make_optional(audited.error_after));
  }
  return !FindOutliers(options, errors).empty();
}

// The indices of the list, if there is one, or an error if the map does not
// have it so.
absl::StatusOr<std::optional<std::set<size_t>>> CheckDropList(
    const std::optional<std::vector<ListedConstraint>>& list,
    const PoseGraph& pose_graph) {
  if (!list) return std::optional<std::set<size_t>>();
  std::set<size_t> dropped;
  for (const ListedConstraint& listed : *list) {
    const size_t k = listed.constraint;
    if (k >= pose_graph.constraints.size() ||
        pose_graph.constraints[k].tag != Constraint::Tag::kInterSubmap ||
        pose_graph.constraints[k].submap != listed.submap ||
        pose_graph.constraints[k].node != listed.node) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "the map has no constraint %d between submap (%d,%d) and node "
          "(%d,%d): the list was made for another map",
          k, listed.submap.trajectory, listed.submap.index,
          listed.node.trajectory, listed.node.index));
    }
    if (!dropped.insert(k).second) {
      return absl::InvalidArgumentError(
          absl::StrFormat("constraint %d is listed twice", k));
    }
  }
  return std::make_optional(std::move(dropped));
}

// By looks and cycles.
std::vector<AuditedGroup> JudgeGroups(
    const LoopClosingOptions& loop_closing, const AuditOptions& options,
    const DescribedMap& map, const std::vector<ConstraintGroup>& groups,
    const Executor& executor, StageClock* const clock) {
  std::vector<AuditedGroup> judged =
      ExamineGroups(loop_closing.recognition.match, options, map.places, groups,
                    executor, clock->Begin("compare submaps"));
  for (AuditedGroup& group : judged) {
    group.verdict = JudgeLooks(options, group.claim);
  }
  clock->Begin("check cycles");
  JudgeCycles(loop_closing.closing.consistency, map.odometry, &judged);
  return judged;
}

// Tests the constraints against the map made without the doubtful ones.
class MapJudge {
 public:
  // Nothing is owned.
  MapJudge(const AuditOptions& options, const std::set<int>& frozen,
           const std::optional<std::set<size_t>>& drop_list,
           const ProgressCallback& on_progress, Audit* const audit)
      : options_(options),
        frozen_(frozen),
        drop_list_(drop_list),
        on_progress_(on_progress),
        audit_(audit) {}

  // Odometry takes no part in judging: where wheels slip, it pulls the map away
  // from constraints that are right, and each that goes for it lets it pull
  // farther.
  void Judge() {
    const OptimizationOptions judging = WithoutOdometry(audit_->optimization);
    std::vector<AuditedConstraint>* const constraints = &audit_->constraints;
    audit_->pose_graph = audit_->state.pose_graph;
    if (!DoubtfulOf(*constraints).empty()) TryWithoutDoubtful(judging);
    for (int k = 0; k < options_.outlier_rejection.max_num_rounds; ++k) {
      if (!DoubtOutliers(options_.outlier_rejection, constraints)) break;
      TryWithoutDoubtful(judging);
    }
    Rehabilitate(options_, constraints);
    const std::set<size_t> doubtful = DoubtfulOf(*constraints);
    audit_->num_doubtful = doubtful.size();
    audit_->dropped = drop_list_.value_or(doubtful);
    if (!audit_->dropped.empty()) {
      Mend(judging);
    } else if (audit_->state.num_dropped_odometry_records > 0) {
      // It has shaped the map, and Cartographer would move it without.
      OptimizeWith(audit_->optimization);
    } else {
      audit_->pose_graph = audit_->state.pose_graph;
      MeasureErrors(audit_->pose_graph, audit_->pose_graph, constraints);
    }
  }

 private:
  void TryWithoutDoubtful(const OptimizationOptions& optimization) {
    audit_->dropped = DoubtfulOf(audit_->constraints);
    OptimizeWith(optimization);
  }

  // Makes the map without what is dropped, with odometry unless it contradicts
  // what is kept.
  void Mend(const OptimizationOptions& without_odometry) {
    OptimizeWith(audit_->optimization);
    audit_->leaves_out_odometry = ContradictsKept(
        options_.outlier_rejection, audit_->dropped, audit_->constraints);
    if (!audit_->leaves_out_odometry) return;
    audit_->optimization = without_odometry;
    OptimizeWith(without_odometry);
  }

  // Starts from the given poses each time, so that dropped constraints have no
  // effect.
  void OptimizeWith(const OptimizationOptions& optimization) {
    const PoseGraph& before = audit_->state.pose_graph;
    audit_->pose_graph = Without(audit_->dropped, before);
    audit_->optimizations.push_back(
        Optimize(optimization, frozen_, &audit_->pose_graph));
    MeasureErrors(before, audit_->pose_graph, &audit_->constraints);
    if (on_progress_) {
      on_progress_(
          std::min(1., static_cast<double>(++num_rounds_) /
                           (options_.outlier_rejection.max_num_rounds + 3)));
    }
  }

  const AuditOptions& options_;
  const std::set<int>& frozen_;
  const std::optional<std::set<size_t>>& drop_list_;
  const ProgressCallback& on_progress_;
  Audit* const audit_;
  int num_rounds_ = 0;
};

// Compares the walls of the map with those of the map as read.
void CompareQuality(const RecognitionOptions& recognition,
                    const std::map<SubmapId, Place>& places,
                    const bool has_drop_list, const Executor& executor,
                    Audit* const audit) {
  // Of all wall, beyond what the choice of pairs makes, and relative to the map
  // as read.
  constexpr double kMaxIncrease = 0.002, kMaxRelativeIncrease = 0.1;
  const auto measure = [&](const PoseGraph& pose_graph) {
    return MeasureMapQuality(recognition.match.verification.agreement,
                             recognition.min_index_gap, places, pose_graph,
                             executor);
  };
  audit->quality_before = measure(audit->state.pose_graph);
  if (audit->optimizations.empty()) {
    audit->quality_after = audit->quality_before;
    return;
  }
  audit->quality_after = measure(audit->pose_graph);
  const double before = audit->quality_before.contradiction_ratio;
  const double after = audit->quality_after.contradiction_ratio;
  if (!has_drop_list &&
      after > before + std::max(kMaxIncrease, kMaxRelativeIncrease * before)) {
    audit->refusal = absl::StrFormat(
        "without %s more of the walls would stand in free space: %.1f %%, now "
        "%.1f %%",
        audit->dropped.empty() ? "odometry" : "the doubtful constraints",
        100. * after, 100. * before);
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

absl::StatusOr<Audit> AuditMap(
    const LoopClosingOptions& loop_closing, const AuditOptions& options,
    const MapSource& source, const std::set<int>& frozen_trajectories,
    const Executor& executor, const StageCallback& on_stage,
    const std::optional<std::vector<ListedConstraint>>& drop_list) {
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
  const absl::StatusOr<std::optional<std::set<size_t>>> listed =
      CheckDropList(drop_list, pose_graph);
  if (!listed.ok()) return listed.status();
  const GroupedConstraints grouped =
      GroupConstraints(options.grouping, pose_graph, CentroidsOf(map->places));
  audit.groups = JudgeGroups(loop_closing, options, *map, grouped.groups,
                             executor, &clock);
  audit.constraints = ListConstraints(pose_graph, grouped, audit.groups);
  audit.optimization = OptimizationInForce(loop_closing.closing, pose_graph);
  audit.state = std::move(map->state);
  MapJudge(options, frozen_trajectories, *listed, clock.Begin("optimise"),
           &audit)
      .Judge();
  clock.Begin("compare walls");
  CompareQuality(loop_closing.recognition, map->places, listed->has_value(),
                 executor, &audit);
  clock.End();
  return audit;
}

}  // namespace cartographer_sdf
