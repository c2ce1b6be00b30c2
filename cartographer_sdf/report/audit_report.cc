// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/report/reports.h"

namespace cartographer_sdf {
namespace {

constexpr Color kKeptColor{0.2, 0.45, 0.7, 0.35};
constexpr Color kDoubtfulColor{0.84, 0.15, 0.16, 0.85};
constexpr size_t kMaxNamedConstraints = 6;

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

std::string VerdictText(const GroupOutcome& outcome) {
  switch (outcome.verdict) {
    case AuditVerdict::kConfirmed:
      return "looks right";
    case AuditVerdict::kAgreesWithMap:
      return "not certain by itself, but the map made without it agrees";
    case AuditVerdict::kUnchecked:
      return "could not be checked";
    case AuditVerdict::kContradicted:
      return "walls of one stand in free space of the other";
    case AuditVerdict::kAmbiguous:
      return "another pose of the two submaps is as good";
    case AuditVerdict::kUnlikely:
      return outcome.group->claim.is_held ? "too little agrees"
                                          : "the walls do not support its pose";
    case AuditVerdict::kOutvoted:
      return "constraints with more weight contradict it";
    case AuditVerdict::kUnsupported:
      return "no other constraint supports it, and it is not certain alone";
    case AuditVerdict::kContradictedByMap:
      return "the map made of the others contradicts it";
  }
  return "";
}

std::string ReasonOf(const Audit& audit, const GroupOutcome& outcome) {
  const AuditedGroup& group = *outcome.group;
  std::vector<std::string> names;
  double before = 0.;
  ConstraintError after;
  for (const AuditedConstraint* const audited : outcome.constraints) {
    const Constraint& constraint =
        audit.state.pose_graph.constraints[audited->constraint];
    if (names.size() < kMaxNamedConstraints) {
      names.push_back(
          absl::StrFormat("(%d,%d)-(%d,%d)", constraint.submap.trajectory,
                          constraint.submap.index, constraint.node.trajectory,
                          constraint.node.index));
    }
    before = std::max(before, audited->error_before.translation);
    after.translation =
        std::max(after.translation, audited->error_after.translation);
    after.rotation = std::max(after.rotation, audited->error_after.rotation);
  }
  const std::string more =
      outcome.constraints.size() > names.size()
          ? absl::StrCat(" and ", outcome.constraints.size() - names.size(),
                         " more")
          : "";
  return absl::StrFormat(
      "%s; margin %.1f to the next pose; support %.1f and contradiction %.1f "
      "from cycles; error %.2f m in the original map, %.2f m and %.1f deg in "
      "the map made without doubtful constraints; %d of %d constraints "
      "(submap)-(node) doubtful: %s%s",
      VerdictText(outcome), group.claim.margin, group.cycles.support,
      group.cycles.contradiction, before, after.translation,
      after.rotation * 180. / M_PI, outcome.num_doubtful,
      outcome.constraints.size(), absl::StrJoin(names, " "), more);
}

std::vector<std::pair<std::string, std::string>> MakeSummary(
    const Audit& audit) {
  std::map<AuditVerdict, int> counts;
  for (const AuditedConstraint& constraint : audit.constraints) {
    ++counts[constraint.verdict];
  }
  std::vector<std::pair<std::string, std::string>> summary = {
      {"Submaps", absl::StrCat(audit.state.submaps.size())},
      {"Inter-submap constraints",
       absl::StrFormat("%d, in %d groups", audit.constraints.size(),
                       audit.groups.size())},
      {"Doubtful", absl::StrCat(audit.num_doubtful)}};
  for (const auto& [verdict, count] : counts) {
    summary.emplace_back(
        absl::StrCat(IsDoubtful(verdict) ? "Doubtful: " : "Kept: ",
                     AuditVerdictName(verdict)),
        absl::StrCat(count));
  }
  return summary;
}

std::vector<HistogramPlot> MakeHistograms(
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

ReportedClosure ReportedGroup(const Audit& audit, const GroupOutcome& outcome) {
  const AuditedGroup& group = *outcome.group;
  ReportedClosure reported;
  reported.match.pair = {group.group.reference, group.group.query,
                         group.group.T_reference_query, group.claim.score};
  reported.match.evidence = group.claim.evidence;
  reported.accepted = outcome.num_doubtful == 0;
  reported.status = absl::StrCat(reported.accepted ? "kept: " : "doubtful: ",
                                 AuditVerdictName(outcome.verdict));
  reported.reason = ReasonOf(audit, outcome);
  if (!reported.accepted) reported.link = kDoubtfulColor;
  return reported;
}

// The content without pictures: the groups that are doubtful, or that are kept
// only because the map agrees.
ReportContent MakeText(const std::string& input, const Audit& audit,
                       const std::vector<GroupOutcome>& outcomes) {
  ReportContent content;
  content.title = "Audit of " + FileName(input);
  content.subtitle =
      "Every inter-submap constraint, checked against the shapes of its "
      "submaps, the other constraints, and the map made without doubtful "
      "constraints.";
  content.summary = MakeSummary(audit);
  AddOptimization(audit.optimization, audit.optimizations, &content);
  content.closures_heading = "Doubtful constraints";
  for (const GroupOutcome& outcome : outcomes) {
    if (outcome.num_doubtful > 0 ||
        outcome.verdict == AuditVerdict::kAgreesWithMap) {
      content.closures.push_back(ReportedGroup(audit, outcome));
    }
  }
  SortByInterest(&content.closures);
  content.histograms = MakeHistograms(outcomes);
  content.stages = audit.stage_seconds;
  return content;
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
                              const std::string& input, const Audit& audit,
                              const SubmapsReader& read_submaps) {
  const std::vector<GroupOutcome> outcomes = Outcomes(audit);
  ReportContent content = MakeText(input, audit, outcomes);
  content.options = request.options_text;
  std::vector<MapPicture> maps = {
      {"Before; red: doubtful constraints, blue: the others", &audit.state,
       &audit.state.pose_graph, /*shows_links=*/true}};
  for (const GroupOutcome& outcome : outcomes) {
    if (outcome.num_doubtful > 0) continue;
    maps.front().other_links.push_back({outcome.group->group.reference,
                                        outcome.group->group.query,
                                        kKeptColor});
  }
  if (audit.num_doubtful > 0) {
    maps.push_back({"After, without the doubtful constraints", &audit.state,
                    &audit.pose_graph});
  }
  const absl::Status status =
      DrawPictures(maps, read_submaps, request.options, &content);
  if (!status.ok()) return status;
  return WriteReport(request.directory, content);
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
