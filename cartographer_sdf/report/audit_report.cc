// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/localization/probability.h"
#include "cartographer_sdf/report/closure_table.h"
#include "cartographer_sdf/report/reports.h"

namespace cartographer_sdf {
namespace {

// "agrees with map", ...
std::string WordsOf(const AuditVerdict verdict) {
  return absl::StrReplaceAll(AuditVerdictName(verdict), {{"_", " "}});
}

constexpr double kAuditDegrees = 180. / M_PI;  // of a radian

// A group and the outcomes of its constraints.
struct GroupOutcome {
  const AuditedGroup* group = nullptr;
  std::vector<const AuditedConstraint*> constraints;
  // The first doubtful verdict, or else the first verdict.
  AuditVerdict verdict = AuditVerdict::kConfirmed;
  int num_doubtful = 0;
};

std::vector<GroupOutcome> Outcomes(const Audit& audit) {
  std::map<size_t, const AuditedConstraint*> by_constraint;
  for (const AuditedConstraint& constraint : audit.constraints) {
    by_constraint[constraint.constraint] = &constraint;
  }
  std::vector<GroupOutcome> outcomes;
  for (const AuditedGroup& group : audit.groups) {
    GroupOutcome outcome;
    outcome.group = &group;
    for (const size_t k : group.group.constraints) {
      const AuditedConstraint& constraint = *by_constraint.at(k);
      const bool is_doubtful = IsDoubtful(constraint.verdict);
      if (outcome.constraints.empty() ||
          (is_doubtful && outcome.num_doubtful == 0)) {
        outcome.verdict = constraint.verdict;
      }
      if (is_doubtful) ++outcome.num_doubtful;
      outcome.constraints.push_back(&constraint);
    }
    outcomes.push_back(std::move(outcome));
  }
  return outcomes;
}

std::set<size_t> DoubtfulIn(const Audit& audit) {
  std::set<size_t> doubtful;
  for (const AuditedConstraint& audited : audit.constraints) {
    if (IsDoubtful(audited.verdict)) doubtful.insert(audited.constraint);
  }
  return doubtful;
}

// Long: a list of all.
std::vector<RowStatus> AuditStatuses() {
  const auto doubtful = [](const AuditVerdict verdict,
                           const char* const meaning,
                           const char* const option) {
    return RowStatus{AuditVerdictName(verdict),
                     absl::StrCat("doubtful: ", WordsOf(verdict)), Tone::kBad,
                     meaning, option};
  };
  const auto kept = [](const AuditVerdict verdict, const Tone tone,
                       const char* const meaning, const char* const option) {
    return RowStatus{AuditVerdictName(verdict),
                     absl::StrCat("kept: ", WordsOf(verdict)), tone, meaning,
                     option};
  };
  return {
      doubtful(AuditVerdict::kContradicted,
               "Walls of one stand in free space of the other.",
               "audit.max_contradiction_ratio"),
      doubtful(AuditVerdict::kContradictedByMap,
               "The map made of the others contradicts it.",
               "audit.outlier_rejection.max_translation_error_meters"),
      doubtful(AuditVerdict::kOutvoted,
               "Constraints with more weight contradict it.",
               "loop_closing.closing.consistency.max_mahalanobis_distance"),
      doubtful(AuditVerdict::kAmbiguous,
               "Another pose of the two submaps is as good.",
               "audit.min_margin"),
      doubtful(AuditVerdict::kUnlikely,
               "The walls do not support its pose, or too little agrees.",
               "audit.min_score"),
      doubtful(AuditVerdict::kUnsupported,
               "No other constraint supports it, and it is not certain alone.",
               "loop_closing.closing.consistency.min_unsupported_score"),
      kept(AuditVerdict::kAgreesWithMap, Tone::kCaution,
           "Not certain by itself, but the map made without it agrees.",
           "audit.max_agreeing_translation_meters"),
      kept(AuditVerdict::kUnchecked, Tone::kCaution,
           "It relates no two submaps with walls.", ""),
      kept(AuditVerdict::kConfirmed, Tone::kGood,
           "It looks right, and nothing contradicts it.", "")};
}

// Long: a list of all.
std::vector<Measure> AuditMeasures(const LoopClosingOptions& stages,
                                   const AuditOptions& options) {
  using Bound = Measure::Bound;
  const std::string grouping = "audit.grouping.max_distance_meters";
  const std::string outliers = "audit.outlier_rejection.";
  return {
      {"error_after", "error without doubtful ones", "m", 3,
       "The largest error of its constraints in the map made without the "
       "doubtful ones.",
       true, Bound::kAtMost,
       options.outlier_rejection.max_translation_error_meters,
       outliers + "max_translation_error_meters"},
      {"rotation_error_after", "rotation error without doubtful ones", "deg", 2,
       "The same of their rotation.", false, Bound::kAtMost,
       kAuditDegrees * options.outlier_rejection.max_rotation_error,
       outliers + "max_rotation_error"},
      {"error_before", "error before", "m", 3,
       "The largest error of its constraints in the map as it was."},
      {"contradiction_ratio", "contradictions", "%", 1,
       "Wall points that stand in the free space of the other submap, in the "
       "worse direction.",
       true, Bound::kAtMost, 100. * options.max_contradiction_ratio,
       "audit.max_contradiction_ratio"},
      {"probability", "probability", "%", 1,
       "Of being right, by the looks of both submaps.", true, Bound::kAtLeast,
       100. * ProbabilityOf(options.min_score), "audit.min_score"},
      {"score", "score", "", 2, "The same as log-odds.", false, Bound::kAtLeast,
       options.min_score, "audit.min_score"},
      {"margin", "lead over other poses", "", 2,
       "By how much the score exceeds that of the best other pose of the pair.",
       false, Bound::kAtLeast, options.min_margin, "audit.min_margin"},
      {"shift", "shift", "m", 3,
       "How far registration moves the query from where the constraints put "
       "it.",
       false, Bound::kAtMost, options.grouping.max_distance_meters, grouping},
      {"support", "support", "", 2,
       "Total score of other groups that agree with it in cycles.", false,
       Bound::kAtLeast, stages.closing.consistency.min_support,
       "loop_closing.closing.consistency.min_support"},
      {"contradiction", "contradiction", "", 2,
       "Total score of other groups that disagree with it in cycles."},
      {"hit_ratio", "walls that agree", "%", 1,
       "Wall points that lie on a wall of the other submap, in the worse "
       "direction."},
      {"overlap_area", "common area", "m\xC2\xB2", 1,
       "What both submaps have observed."},
      {"constraints", "constraints", "", 0, "Of the group.", true},
      {"doubtful", "doubtful", "", 0, "Of them."}};
}

std::vector<std::optional<double>> AuditValues(const GroupOutcome& outcome) {
  const AuditedGroup& group = *outcome.group;
  double before = 0.;
  ConstraintError after;
  for (const AuditedConstraint* const audited : outcome.constraints) {
    before = std::max(before, audited->error_before.translation);
    after.translation =
        std::max(after.translation, audited->error_after.translation);
    after.rotation = std::max(after.rotation, audited->error_after.rotation);
  }
  return {after.translation,
          kAuditDegrees * after.rotation,
          before,
          100. * group.claim.evidence.ContradictionRatio(),
          100. * ProbabilityOf(group.claim.score),
          group.claim.score,
          group.claim.margin,
          group.claim.shift,
          group.cycles.support,
          group.cycles.contradiction,
          100. * group.claim.evidence.HitRatio(),
          group.claim.evidence.overlap_area,
          static_cast<double>(outcome.constraints.size()),
          static_cast<double>(outcome.num_doubtful)};
}

std::vector<HistogramPlot> AuditHistograms(
    const std::vector<GroupOutcome>& outcomes) {
  std::vector<double> kept_scores, doubtful_scores, kept_contradictions,
      doubtful_contradictions;
  for (const GroupOutcome& outcome : outcomes) {
    const bool doubtful = outcome.num_doubtful > 0;
    (doubtful ? doubtful_scores : kept_scores)
        .push_back(outcome.group->claim.score);
    (doubtful ? doubtful_contradictions : kept_contradictions)
        .push_back(100. * outcome.group->claim.evidence.ContradictionRatio());
  }
  return {
      {"Scores of the groups",
       {"score (log-odds of being right)", {{-20., 20.}}},
       {{"kept", kept_scores}, {"doubtful", doubtful_scores}}},
      {"Walls in the other's free space",
       {"% of the wall points, in the worse direction", {{0., 30.}}},
       {{"kept", kept_contradictions}, {"doubtful", doubtful_contradictions}}}};
}

InspectedTable AuditGroupTable(const LoopClosingOptions& stages,
                               const AuditOptions& options,
                               const std::vector<GroupOutcome>& outcomes) {
  InspectedTable table{
      "constraints", "Constraints",
      "Groups of constraints that claim the same pose of two submaps.",
      AuditMeasures(stages, options), AuditStatuses()};
  for (const GroupOutcome& outcome : outcomes) {
    const AuditedGroup& group = *outcome.group;
    InspectedRow row;
    row.status = AuditVerdictName(outcome.verdict);
    row.pair = {group.group.reference, group.group.query,
                group.group.T_reference_query, group.claim.score};
    row.values = AuditValues(outcome);
    row.constraints = group.group.constraints;
    table.rows.push_back(std::move(row));
  }
  std::stable_sort(table.rows.begin(), table.rows.end(),
                   [](const InspectedRow& a, const InspectedRow& b) {
                     return ScoreOf(a) < ScoreOf(b);
                   });
  FinishTable(&table);
  return table;
}

std::string WallsText(const MapQuality& quality) {
  return absl::StrFormat("%.2f %% in free space, %.3f m apart",
                         100. * quality.contradiction_ratio,
                         quality.wall_distance);
}

// The walls where submaps lie over each other.
void AddQuality(const Audit& audit, Inspection* const inspection) {
  if (audit.quality_before.num_pairs == 0) return;
  inspection->numbers.emplace_back("Walls where submaps overlap",
                                   WallsText(audit.quality_before));
  if (audit.dropped.empty()) return;
  inspection->numbers.emplace_back("Without the dropped constraints",
                                   WallsText(audit.quality_after));
}

void AddAuditNumbers(const Audit& audit, Inspection* const inspection) {
  std::map<AuditVerdict, int> counts;
  for (const AuditedConstraint& constraint : audit.constraints) {
    ++counts[constraint.verdict];
  }
  inspection->numbers = {
      {"Submaps", absl::StrCat(audit.state.submaps.size())},
      {"Constraints between submaps",
       absl::StrFormat("%d, in %d groups", audit.constraints.size(),
                       audit.groups.size())},
      {"Doubtful constraints", absl::StrCat(audit.num_doubtful)}};
  for (const auto& [verdict, count] : counts) {
    inspection->numbers.emplace_back(
        absl::StrCat(IsDoubtful(verdict) ? "Doubtful: " : "Kept: ",
                     AuditVerdictName(verdict)),
        absl::StrCat(count));
  }
  AddQuality(audit, inspection);
  AddDisplacement(inspection);
  AddOptimization(audit.optimization, audit.optimizations, inspection);
}

// Which of the two maps is better, by how well its walls agree.
void CompareMaps(const Audit& audit, Inspection* const inspection) {
  const std::optional<Displacement> moved = DisplacementOf(inspection->states);
  if (!moved) return;
  const double before = audit.quality_before.contradiction_ratio;
  const double after = audit.quality_after.contradiction_ratio;
  // Less is the choice of pairs.
  constexpr double kMinDifference = 0.0005;
  const char* const comparison =
      !audit.refusal.empty()            ? "is WORSE, so that it is not written"
      : after < before - kMinDifference ? "is better"
      : after > before + kMinDifference ? "is not better"
                                        : "is as good as it was";
  inspection->tone = !audit.refusal.empty() ? Tone::kBad : Tone::kCaution;
  absl::StrAppendFormat(
      &inspection->verdict,
      " Without %s the map moves by up to %.2f m (%.2f m on average) and %s: "
      "%.2f %% of the walls stand in free space where submaps overlap, %.2f %% "
      "before.",
      audit.dropped.size() == 1 ? "it" : "them", moved->largest, moved->mean,
      comparison, 100. * after, 100. * before);
}

void JudgeAudit(const Audit& audit, const bool has_drop_list,
                Inspection* const inspection) {
  const std::string all =
      Counted(audit.constraints.size(), "constraint") + " between submaps";
  if (audit.constraints.empty()) {
    inspection->verdict =
        "The map has no constraints between submaps to check.";
  } else if (audit.num_doubtful == 0) {
    inspection->tone = Tone::kGood;
    inspection->verdict =
        absl::StrCat("Nothing is doubtful: all ", all, " hold.");
  } else {
    inspection->tone = Tone::kCaution;
    inspection->verdict =
        absl::StrCat(audit.num_doubtful, " of ", all,
                     audit.num_doubtful == 1 ? " is" : " are", " doubtful.");
  }
  if (has_drop_list) {
    absl::StrAppend(&inspection->verdict, " The list drops ",
                    audit.dropped.size(), ".");
  }
  CompareMaps(audit, inspection);
}

constexpr char kHeader[] =
    "constraint,submap_trajectory,submap_index,node_trajectory,node_index,x,y,"
    "yaw,doubtful,verdict,error_before,rotation_error_before,error_after,"
    "rotation_error_after,group,reference_trajectory,reference_index,"
    "query_trajectory,query_index,group_x,group_y,group_yaw,score,margin,"
    "overlap_area,overlap,hit_ratio,"
    "contradiction_ratio,shift,support,contradiction\n";

std::string GroupFields(const AuditedGroup& audited, const size_t number) {
  const ConstraintGroup& group = audited.group;
  const ClaimEvidence& claim = audited.claim;
  return absl::StrFormat(
      "%d,%d,%d,%d,%d,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%s,%.6f,%."
      "6f",
      number, group.reference.trajectory, group.reference.index,
      group.query.trajectory, group.query.index,
      group.T_reference_query.translation().x(),
      group.T_reference_query.translation().y(),
      group.T_reference_query.rotation(), claim.score, claim.margin,
      claim.evidence.overlap_area, claim.evidence.overlap,
      claim.evidence.HitRatio(), claim.evidence.ContradictionRatio(),
      claim.shift ? absl::StrFormat("%.6f", *claim.shift) : "",
      audited.cycles.support, audited.cycles.contradiction);
}

}  // namespace

absl::Status WriteAuditReport(const ReportRequest& request,
                              const LoopClosingOptions& stages,
                              const AuditOptions& options,
                              const std::string& input, const Audit& audit,
                              const SubmapsReader& read_submaps) {
  const bool has_drop_list = audit.dropped != DoubtfulIn(audit);
  const std::vector<GroupOutcome> outcomes = Outcomes(audit);
  Inspection inspection;
  inspection.title = "Audit of " + FileName(input);
  inspection.sessions = {{FileName(input)}};
  inspection.states = {
      {"before", "Before", "The map as it was", &audit.state.pose_graph}};
  if (!audit.dropped.empty()) {
    inspection.states.push_back(
        {"after", "After",
         has_drop_list ? "The map without the constraints of the list"
                       : "The map without the doubtful constraints",
         &audit.pose_graph});
  }
  AddSubmaps(audit.state, &inspection);
  JudgeAudit(audit, has_drop_list, &inspection);
  AddAuditNumbers(audit, &inspection);
  inspection.tables = {AuditGroupTable(stages, options, outcomes)};
  for (const AuditedConstraint& audited : audit.constraints) {
    const Constraint& constraint =
        audit.state.pose_graph.constraints[audited.constraint];
    inspection.constraints[audited.constraint] = {
        constraint.submap, constraint.node,
        audit.dropped.count(audited.constraint) > 0};
  }
  inspection.histograms = AuditHistograms(outcomes);
  inspection.stage_seconds = audit.stage_seconds;
  const absl::Status status =
      DrawInspection(request.options, read_submaps, &inspection);
  if (!status.ok()) return status;
  return WriteInspector(request, inspection);
}

absl::Status WriteAuditTable(const std::string& path, const Audit& audit) {
  std::map<size_t, size_t> group_of;
  for (size_t g = 0; g < audit.groups.size(); ++g) {
    for (const size_t k : audit.groups[g].group.constraints) group_of[k] = g;
  }
  std::string content = kHeader;
  for (const AuditedConstraint& audited : audit.constraints) {
    const Constraint& constraint =
        audit.state.pose_graph.constraints[audited.constraint];
    const Rigid2& T_submap_node = constraint.T_submap_node;
    const auto group = group_of.find(audited.constraint);
    absl::StrAppendFormat(
        &content,
        "%d,%d,%d,%d,%d,%.6f,%.6f,%.6f,%d,%s,%.6f,%.6f,%.6f,%.6f,%s\n",
        audited.constraint, constraint.submap.trajectory,
        constraint.submap.index, constraint.node.trajectory,
        constraint.node.index, T_submap_node.translation().x(),
        T_submap_node.translation().y(), T_submap_node.rotation(),
        IsDoubtful(audited.verdict) ? 1 : 0, AuditVerdictName(audited.verdict),
        audited.error_before.translation, audited.error_before.rotation,
        audited.error_after.translation, audited.error_after.rotation,
        group == group_of.end()
            ? std::string(16, ',')
            : GroupFields(audit.groups[group->second], group->second));
  }
  return WriteWholeFile(path, content);
}

}  // namespace cartographer_sdf
