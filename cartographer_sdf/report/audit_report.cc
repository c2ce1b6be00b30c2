// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/audit_report.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/report/html_report.h"
#include "cartographer_sdf/report/map_picture.h"
#include "cartographer_sdf/report/submap_pictures.h"

namespace cartographer_sdf {
namespace {

constexpr Color kKeptColor{0.2, 0.45, 0.7, 0.35};
constexpr Color kDoubtfulColor{0.84, 0.15, 0.16, 0.85};
constexpr size_t kMaxNamedConstraints = 6;

double ToDegrees(const double radians) { return radians * 180. / M_PI; }

// A group and what became of its constraints.
struct GroupOutcome {
  const AuditedGroup* group = nullptr;
  std::vector<const AuditedConstraint*> constraints;
  // The first doubtful verdict, or the first one.
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

// Doubtful groups by falling contradiction; then those that only the map saved.
std::vector<GroupOutcome> OfInterest(std::vector<GroupOutcome> outcomes) {
  outcomes.erase(std::remove_if(outcomes.begin(), outcomes.end(),
                                [](const GroupOutcome& outcome) {
                                  return outcome.num_doubtful == 0 &&
                                         outcome.verdict !=
                                             AuditVerdict::kAgreesWithMap;
                                }),
                 outcomes.end());
  std::stable_sort(outcomes.begin(), outcomes.end(),
                   [](const GroupOutcome& a, const GroupOutcome& b) {
                     if ((a.num_doubtful > 0) != (b.num_doubtful > 0)) {
                       return a.num_doubtful > 0;
                     }
                     return a.group->claim.score < b.group->claim.score;
                   });
  return outcomes;
}

std::string VerdictText(const GroupOutcome& outcome) {
  switch (outcome.verdict) {
    case AuditVerdict::kConfirmed:
      return "looks right";
    case AuditVerdict::kAgreesWithMap:
      return "not certain by itself, but where the map made without it has it";
    case AuditVerdict::kUnchecked:
      return "could not be checked";
    case AuditVerdict::kContradicted:
      return "walls of one stand in free space of the other";
    case AuditVerdict::kAmbiguous:
      return "another pose of the two submaps is as good";
    case AuditVerdict::kUnlikely:
      return outcome.group->claim.is_held
                 ? "too little agrees"
                 : "the walls do not hold it where it is";
    case AuditVerdict::kOutvoted:
      return "constraints with more weight contradict it";
    case AuditVerdict::kUnsupported:
      return "no other constraint supports it, and it is not certain alone";
    case AuditVerdict::kContradictedByMap:
      return "the map made of the others has it elsewhere";
  }
  return "";
}

std::string ReasonOf(const Audit& audit, const GroupOutcome& outcome) {
  const AuditedGroup& group = *outcome.group;
  std::vector<std::string> names;
  double before = 0.;
  double after = 0.;
  double turn_after = 0.;
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
    after = std::max(after, audited->error_after.translation);
    turn_after = std::max(turn_after, audited->error_after.rotation);
  }
  const std::string more =
      outcome.constraints.size() > names.size()
          ? absl::StrCat(" and ", outcome.constraints.size() - names.size(),
                         " more")
          : "";
  return absl::StrFormat(
      "%s; margin %.1f to the next pose; cycles for %.1f, against %.1f; error "
      "%.2f m in the map as it was, %.2f m and %.1f deg in the one made "
      "without doubtful ones; %d of %d constraints (submap)-(node) doubtful: "
      "%s%s",
      VerdictText(outcome), group.claim.margin, group.cycles.support,
      group.cycles.contradiction, before, after, ToDegrees(turn_after),
      outcome.num_doubtful, outcome.constraints.size(),
      absl::StrJoin(names, " "), more);
}

std::vector<SubmapLink> LinksOf(const std::vector<GroupOutcome>& outcomes) {
  std::vector<SubmapLink> links;
  for (const bool doubtful : {false, true}) {
    for (const GroupOutcome& outcome : outcomes) {
      if ((outcome.num_doubtful > 0) != doubtful) continue;
      links.push_back({outcome.group->group.reference,
                       outcome.group->group.query,
                       doubtful ? kDoubtfulColor : kKeptColor});
    }
  }
  return links;
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
  summary.emplace_back(
      "Odometry weights",
      absl::StrFormat("%.3g (translation), %.3g (rotation)",
                      audit.optimization.odometry_translation_weight,
                      audit.optimization.odometry_rotation_weight));
  if (!audit.optimizations.empty()) {
    const OptimizationSummary& last = audit.optimizations.back();
    summary.emplace_back(
        "Optimisation",
        absl::StrFormat("cost %.4g to %.4g in %d iterations, %d rounds",
                        last.initial_cost, last.final_cost, last.num_iterations,
                        audit.optimizations.size()));
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
  HistogramPlot scores;
  scores.title = "Scores of the groups";
  scores.x.label = "score (log-odds of being right)";
  scores.x.range = {{-20., 20.}};
  scores.series = {{"kept", kept_scores}, {"doubtful", doubtful_scores}};
  HistogramPlot contradictions;
  contradictions.title = "Walls in the other's free space";
  contradictions.x.label = "% of the wall points, the worse direction";
  contradictions.x.range = {{0., 30.}};
  contradictions.series = {{"kept", kept_contradictions},
                           {"doubtful", doubtful_contradictions}};
  return {scores, contradictions};
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
  return reported;
}

// All but the maps and the groups.
ReportContent MakeText(const ReportRequest& request, const std::string& input,
                       const Audit& audit,
                       const std::vector<GroupOutcome>& outcomes) {
  ReportContent content;
  content.title =
      "Audit of " + std::filesystem::path(input).filename().string();
  content.subtitle =
      "Every inter-submap constraint held against what its submaps look like, "
      "the others, and the map that the undoubted ones make.";
  content.summary = MakeSummary(audit);
  if (!audit.optimizations.empty() && !audit.optimizations.back().converged) {
    content.warnings.push_back(
        absl::StrCat("The optimisation did not converge: ",
                     audit.optimizations.back().message));
  }
  content.closures_heading = "Doubtful constraints";
  content.histograms = MakeHistograms(outcomes);
  content.stages = audit.stage_seconds;
  content.options = request.options_text;
  return content;
}

// Reads the map for all pictures: those of the whole, and of the groups that
// are shown.
absl::Status DrawPictures(const SubmapsReader& read_submaps,
                          const ReportOptions& options, const Audit& audit,
                          const std::vector<GroupOutcome>& outcomes,
                          const std::vector<GroupOutcome>& shown,
                          ReportContent* const content) {
  std::set<SubmapId> wanted;
  for (const GroupOutcome& outcome : shown) {
    wanted.insert(outcome.group->group.reference);
    wanted.insert(outcome.group->group.query);
  }
  MapPicture before(audit.state, audit.state.pose_graph,
                    options.map_picture_pixels);
  MapPicture after(audit.state, audit.pose_graph, options.map_picture_pixels);
  std::map<SubmapId, OccupancyGrid> grids;
  const absl::Status status = read_submaps(
      [&](const SubmapId& id, const SubmapSummary&, const OccupancyGrid& grid) {
        before.AddSubmap(id, grid);
        after.AddSubmap(id, grid);
        if (wanted.count(id) > 0) grids.emplace(id, grid);
      });
  if (!status.ok()) return status;
  content->maps.push_back(
      before.Finish("As it was; red: doubtful constraints, blue: the others",
                    LinksOf(outcomes)));
  if (audit.num_doubtful > 0) {
    content->maps.push_back(after.Finish("Without the doubtful ones", {}));
  }
  for (size_t k = 0; k < shown.size(); ++k) {
    const ConstraintGroup& group = shown[k].group->group;
    content->closures[k].png =
        DrawMatchedPair(grids.at(group.reference), grids.at(group.query),
                        group.T_reference_query, {},
                        options.closure_picture_pixels)
            .EncodePng();
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status WriteAuditReport(const ReportRequest& request,
                              const std::string& input, const Audit& audit,
                              const SubmapsReader& read_submaps) {
  const std::vector<GroupOutcome> outcomes = Outcomes(audit);
  std::vector<GroupOutcome> order = OfInterest(outcomes);
  ReportContent content = MakeText(request, input, audit, outcomes);
  for (const GroupOutcome& outcome : order) {
    content.closures.push_back(ReportedGroup(audit, outcome));
  }
  order.resize(std::min(
      order.size(), static_cast<size_t>(request.options.max_closure_pictures)));
  const absl::Status status = DrawPictures(read_submaps, request.options, audit,
                                           outcomes, order, &content);
  if (!status.ok()) return status;
  return WriteReport(request.directory, content, request.options);
}

}  // namespace cartographer_sdf
