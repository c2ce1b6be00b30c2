// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/run_record.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "cartographer_sdf/config/nearest_name.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "glog/logging.h"

DEFINE_string(fail_on, "",
              "Conditions, separated by commas, under which the exit code is "
              "3 although the run succeeded: refused (no certain answer), "
              "nothing (nothing found), warning (any), or the code of a "
              "warning, see the documentation. What was found is written "
              "nevertheless.");

namespace cartographer_sdf {
namespace {

constexpr char kAnyWarning[] = "warning";

constexpr RunWarning kAllWarnings[] = {RunWarning::kRepaired,
                                       RunWarning::kIncomplete,
                                       RunWarning::kTornSubmaps,
                                       RunWarning::kSlips,
                                       RunWarning::kNotConverged,
                                       RunWarning::kOdometryBends,
                                       RunWarning::kDoubtful,
                                       RunWarning::kOdometryLeftOut,
                                       RunWarning::kContradictions,
                                       RunWarning::kSessionsLeftOut,
                                       RunWarning::kWindowsNotLocalized,
                                       RunWarning::kPlacesNotUsed,
                                       RunWarning::kMapsFailed};

std::vector<std::string> AllConditions() {
  std::vector<std::string> names = {OutcomeName(Outcome::kRefused),
                                    OutcomeName(Outcome::kNothing),
                                    kAnyWarning};
  for (const RunWarning warning : kAllWarnings) {
    names.emplace_back(RunWarningCode(warning));
  }
  return names;
}

std::vector<std::string> ConditionsOfFlags() {
  return absl::StrSplit(FLAGS_fail_on, ',', absl::SkipEmpty());
}

bool IsMet(const std::string& condition, const RunRecord& record) {
  if (record.outcome != Outcome::kDone &&
      condition == OutcomeName(record.outcome)) {
    return true;
  }
  return std::any_of(record.warnings.begin(), record.warnings.end(),
                     [&condition](const auto& warning) {
                       return condition == kAnyWarning ||
                              condition == RunWarningCode(warning.first);
                     });
}

}  // namespace

const char* OutcomeName(const Outcome outcome) {
  switch (outcome) {
    case Outcome::kDone:
      return "done";
    case Outcome::kNothing:
      return "nothing";
    case Outcome::kRefused:
      return "refused";
  }
  LOG(FATAL) << "no outcome";
}

const char* RunWarningCode(const RunWarning warning) {
  switch (warning) {
    case RunWarning::kRepaired:
      return "repaired";
    case RunWarning::kIncomplete:
      return "incomplete";
    case RunWarning::kTornSubmaps:
      return "torn_submaps";
    case RunWarning::kSlips:
      return "slips";
    case RunWarning::kNotConverged:
      return "not_converged";
    case RunWarning::kOdometryBends:
      return "odometry_bends";
    case RunWarning::kDoubtful:
      return "doubtful";
    case RunWarning::kOdometryLeftOut:
      return "odometry_left_out";
    case RunWarning::kContradictions:
      return "contradictions";
    case RunWarning::kSessionsLeftOut:
      return "sessions_left_out";
    case RunWarning::kWindowsNotLocalized:
      return "windows_not_localized";
    case RunWarning::kPlacesNotUsed:
      return "places_not_used";
    case RunWarning::kMapsFailed:
      return "maps_failed";
  }
  LOG(FATAL) << "no warning";
}

void RecordMap(const MapState& map, RunRecord* const record) {
  record->Count("trajectories", map.trajectories.size());
  record->Count("submaps", map.pose_graph.submap_poses.size());
  record->Count("nodes", map.pose_graph.nodes.size());
  record->Count("constraints", map.pose_graph.constraints.size());
  if (map.num_unrecorded_submaps + map.num_unrecorded_nodes == 0) return;
  record->Warn(
      RunWarning::kRepaired,
      absl::StrFormat("%d submaps and %d nodes without data were left out",
                      map.num_unrecorded_submaps, map.num_unrecorded_nodes));
}

void RecordConvergence(const std::vector<OptimizationSummary>& summaries,
                       RunRecord* const record) {
  if (summaries.empty() || summaries.back().converged) return;
  record->Warn(RunWarning::kNotConverged,
               absl::StrCat("the optimisation did not converge: ",
                            summaries.back().message));
}

absl::Status CheckFailOn() {
  const std::vector<std::string> all = AllConditions();
  for (const std::string& condition : ConditionsOfFlags()) {
    if (std::find(all.begin(), all.end(), condition) != all.end()) continue;
    const std::optional<std::string> nearest = NearestName(condition, all);
    return UsageError(absl::StrCat(
        "--fail_on: there is no condition '", condition, "'",
        nearest ? absl::StrCat(", did you mean '", *nearest, "'?")
                : absl::StrCat("; there are ", absl::StrJoin(all, ", "))));
  }
  return absl::OkStatus();
}

std::string ConditionToFailOn(const RunRecord& record) {
  for (const std::string& condition : ConditionsOfFlags()) {
    if (IsMet(condition, record)) return condition;
  }
  return "";
}

}  // namespace cartographer_sdf
