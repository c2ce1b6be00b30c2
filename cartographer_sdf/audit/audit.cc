// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/audit/audit.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

std::vector<AuditedGroup> ExamineGroups(
    const MatchOptions& match_options, const AuditOptions& options,
    const std::map<SubmapId, Place>& places,
    const std::vector<ConstraintGroup>& groups, const Executor& executor,
    const ProgressCallback& on_progress) {
  // Groups of one pair stand together; recognition is asked once for all.
  std::vector<size_t> first_of_pair;
  for (size_t k = 0; k < groups.size(); ++k) {
    if (k == 0 || groups[k].reference != groups[k - 1].reference ||
        groups[k].query != groups[k - 1].query) {
      first_of_pair.push_back(k);
    }
  }
  const size_t num_pairs = first_of_pair.size();
  first_of_pair.push_back(groups.size());
  std::vector<AuditedGroup> audited(groups.size());
  std::mutex progress_mutex;
  size_t num_done = 0;
  executor(num_pairs, [&](const size_t pair) {
    const size_t first = first_of_pair[pair];
    const Place& reference = places.at(groups[first].reference);
    const Place& query = places.at(groups[first].query);
    const std::optional<Match> recognized =
        MatchPlaces(match_options, reference, query);
    for (size_t k = first; k < first_of_pair[pair + 1]; ++k) {
      audited[k].group = groups[k];
      audited[k].evidence = ExaminePose(
          match_options.verification, options.grouping.max_distance_meters,
          options.grouping.max_rotation, reference.surface, query.surface,
          recognized, groups[k].T_reference_query);
    }
    if (!on_progress) return;
    const std::lock_guard<std::mutex> lock(progress_mutex);
    on_progress(static_cast<double>(++num_done) /
                static_cast<double>(num_pairs));
  });
  return audited;
}

// By what the pair looks like.
AuditVerdict JudgeLooks(const AuditOptions& options,
                        const PoseEvidence& evidence) {
  const Agreement& agreement = evidence.agreement;
  if (std::max(agreement.query_in_reference.ContradictionRatio(),
               agreement.reference_in_query.ContradictionRatio()) >
      options.max_contradiction_ratio) {
    return AuditVerdict::kContradicted;
  }
  if (evidence.margin < options.min_margin) return AuditVerdict::kAmbiguous;
  if (!evidence.is_held || evidence.score < options.min_score) {
    return AuditVerdict::kUnlikely;
  }
  return AuditVerdict::kConfirmed;
}

LoopClosure ToClosure(const AuditedGroup& group) {
  LoopClosure closure;
  closure.reference = group.group.reference;
  closure.query = group.group.query;
  closure.T_reference_query = group.evidence.T_reference_query;
  // What does not look right has no voice.
  closure.score = group.verdict == AuditVerdict::kConfirmed
                      ? group.evidence.score
                      : std::min(group.evidence.score, 0.);
  return closure;
}

// Groups that look right fall where cycles speak against them, and others rise
// where cycles speak for them, except against free space.
void JudgeCycles(const ConsistencyOptions& consistency, const MapState& state,
                 std::vector<AuditedGroup>* const groups) {
  std::vector<LoopClosure> closures;
  for (const AuditedGroup& group : *groups) {
    closures.push_back(ToClosure(group));
  }
  const std::vector<SelectionResult> results =
      SelectConsistent(consistency, OdometryPoses(state), closures);
  for (size_t k = 0; k < groups->size(); ++k) {
    AuditedGroup& group = (*groups)[k];
    group.cycles = results[k];
    if (results[k].selection == Selection::kContradicted) {
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

// In units of what is allowed.
double Excess(const WithdrawalOptions& options, const ConstraintError& error) {
  return std::max(error.translation / options.max_translation_error_meters,
                  error.rotation / options.max_rotation_error);
}

// Doubts what the map contradicts most, and what at least half as much: a wrong
// constraint strains right ones beside it. False where there is nothing.
bool DoubtStrained(const WithdrawalOptions& options,
                   std::vector<AuditedConstraint>* const constraints) {
  double worst = 0.;
  for (const AuditedConstraint& audited : *constraints) {
    if (IsDoubtful(audited.verdict)) continue;
    worst = std::max(worst, Excess(options, audited.error_after));
  }
  if (worst <= 1.) return false;
  for (AuditedConstraint& audited : *constraints) {
    if (!IsDoubtful(audited.verdict) &&
        Excess(options, audited.error_after) > std::max(1., 0.5 * worst)) {
      audited.verdict = AuditVerdict::kContradictedByMap;
    }
  }
  return true;
}

// Doubtful ones that the map agrees with, which is made without them.
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

// Holds the constraints against the map that the undoubted ones make.
void JudgeByMap(const AuditOptions& options,
                const std::set<int>& frozen_trajectories,
                const ProgressCallback& on_progress, Audit* const audit) {
  const PoseGraph& before = audit->state.pose_graph;
  std::vector<AuditedConstraint>* const constraints = &audit->constraints;
  audit->pose_graph = before;
  const int num_rounds = options.withdrawal.max_num_rounds + 2;
  int round = 0;
  const auto optimize = [&] {
    // From the given poses each time: what was dropped leaves no trace.
    audit->pose_graph = WithoutDoubtful(before, *constraints);
    audit->optimizations.push_back(
        Optimize(audit->optimization, frozen_trajectories, &audit->pose_graph));
    MeasureErrors(before, audit->pose_graph, constraints);
    if (on_progress) on_progress(static_cast<double>(++round) / num_rounds);
  };
  if (CountDoubtful(*constraints) > 0) optimize();
  for (int k = 0; k < options.withdrawal.max_num_rounds; ++k) {
    if (!DoubtStrained(options.withdrawal, constraints)) break;
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
       {Validate(options.grouping), Validate(options.withdrawal)}) {
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
  switch (verdict) {
    case AuditVerdict::kConfirmed:
      return "confirmed";
    case AuditVerdict::kAgreesWithMap:
      return "agrees_with_map";
    case AuditVerdict::kUnchecked:
      return "unchecked";
    case AuditVerdict::kContradicted:
      return "contradicted";
    case AuditVerdict::kAmbiguous:
      return "ambiguous";
    case AuditVerdict::kUnlikely:
      return "unlikely";
    case AuditVerdict::kOutvoted:
      return "outvoted";
    case AuditVerdict::kUnsupported:
      return "unsupported";
    case AuditVerdict::kContradictedByMap:
      return "contradicted_by_map";
  }
  LOG(FATAL) << "not a verdict: " << static_cast<int>(verdict);
}

bool IsDoubtful(const AuditVerdict verdict) {
  return verdict != AuditVerdict::kConfirmed &&
         verdict != AuditVerdict::kAgreesWithMap &&
         verdict != AuditVerdict::kUnchecked;
}

absl::StatusOr<Audit> AuditMap(const LoopClosingOptions& loop_closing,
                               const AuditOptions& options,
                               const std::string& path,
                               const std::set<int>& frozen_trajectories,
                               const Executor& executor,
                               const StageCallback& on_stage) {
  CHECK_EQ(Validate(loop_closing), "");
  CHECK_EQ(Validate(options), "");
  CHECK(loop_closing.match.method == Method::kSdf)
      << "the paper's method verifies nothing";
  Audit audit;
  StageClock clock(on_stage, &audit.stage_seconds);
  absl::StatusOr<DescribedMap> map =
      DescribeMap(loop_closing.place, loop_closing.match, path, executor,
                  clock.Begin("read and describe"));
  if (!map.ok()) return map.status();
  audit.state = std::move(map->state);
  const PoseGraph& pose_graph = audit.state.pose_graph;

  std::map<SubmapId, Eigen::Vector2d> middles;
  for (const auto& [id, place] : map->places) {
    middles.emplace(id, MiddleOf(place.surface));
  }
  const GroupedConstraints grouped =
      GroupConstraints(options.grouping, pose_graph, middles);
  audit.groups =
      ExamineGroups(loop_closing.match, options, map->places, grouped.groups,
                    executor, clock.Begin("compare submaps"));
  for (AuditedGroup& group : audit.groups) {
    group.verdict = JudgeLooks(options, group.evidence);
  }
  clock.Begin("check cycles");
  JudgeCycles(loop_closing.consistency, audit.state, &audit.groups);

  audit.constraints = ListConstraints(pose_graph, grouped, audit.groups);
  audit.optimization = OptimizationInForce(loop_closing, pose_graph);
  JudgeByMap(options, frozen_trajectories, clock.Begin("optimise"), &audit);
  clock.End();
  return audit;
}

}  // namespace cartographer_sdf
