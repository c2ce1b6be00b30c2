// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/operator_view.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/localization/probability.h"

namespace cartographer_sdf {
namespace {

// [m]
constexpr double kClosureWidth = 0.12;
constexpr double kRefusedWidth = 0.02;

struct StatusLook {
  ClosureStatus status;
  Color color;
};

// Distinct on dark and on bright ground: green is in the map, blue will be,
// yellow waits, red is contradicted, grey is history.
constexpr StatusLook kLooks[] = {
    {ClosureStatus::kInGraph, {0.10f, 0.75f, 0.25f, 1.f}},
    {ClosureStatus::kReady, {0.15f, 0.45f, 1.f, 1.f}},
    {ClosureStatus::kDetectedOnly, {0.10f, 0.75f, 0.85f, 1.f}},
    {ClosureStatus::kUnsupported, {0.95f, 0.75f, 0.10f, 0.8f}},
    {ClosureStatus::kInconsistent, {0.90f, 0.15f, 0.15f, 0.8f}},
    {ClosureStatus::kScansDisagree, {1.f, 0.45f, 0.10f, 0.8f}},
    {ClosureStatus::kGone, {0.55f, 0.55f, 0.55f, 0.5f}},
};
constexpr Color kRefusedColor = {0.75f, 0.30f, 0.75f, 0.35f};

std::optional<Segment> SegmentOf(
    const PairPose& pair, const std::map<SubmapId, Rigid2>& T_map_submap) {
  const auto reference = T_map_submap.find(pair.reference);
  if (reference == T_map_submap.end()) return std::nullopt;
  const auto query = T_map_submap.find(pair.query);
  const Rigid2 T_map_query = query == T_map_submap.end()
                                 ? reference->second * pair.T_reference_query
                                 : query->second;
  return Segment{reference->second.translation(), T_map_query.translation()};
}

std::string Message(const SearchState state,
                    const std::optional<LocalizationResult>& localization) {
  const std::string name = SearchStateName(state);
  if (state == SearchState::kMapping) return name;
  if (state == SearchState::kLocated) {
    return absl::StrFormat("%s, probability %.4f", name,
                           ProbabilitiesOf(*localization).best);
  }
  return absl::StrCat(name, " for ",
                      absl::StrFormat("%.1f", localization->distance_driven),
                      " m: ", LocalizationVerdictName(localization->verdict));
}

}  // namespace

std::vector<SegmentGroup> DrawMatches(
    const std::vector<ClosureRecord>& closures,
    const std::vector<RefusedMatch>& refused,
    const std::map<SubmapId, Rigid2>& T_map_submap) {
  std::vector<SegmentGroup> groups;
  const auto add = [&T_map_submap](const PairPose& pair,
                                   SegmentGroup* const group) {
    const std::optional<Segment> segment = SegmentOf(pair, T_map_submap);
    if (segment) group->segments.push_back(*segment);
  };
  for (const StatusLook& look : kLooks) {
    groups.push_back(
        {ClosureStatusName(look.status), look.color, kClosureWidth, {}});
    for (const ClosureRecord& closure : closures) {
      if (closure.status == look.status) add(closure.pair, &groups.back());
    }
  }
  groups.push_back({"refused", kRefusedColor, kRefusedWidth, {}});
  for (const RefusedMatch& match : refused) add(match.pair, &groups.back());
  return groups;
}

Probabilities ProbabilitiesOf(const LocalizationResult& result) {
  Probabilities probabilities;
  if (!result.T_map_tracking) return probabilities;
  if (!result.T_map_runner_up) {
    probabilities.best = ProbabilityOf(result.score);
    return probabilities;
  }
  probabilities.best = ProbabilityOf(result.score, result.runner_up_score);
  probabilities.runner_up = ProbabilityOf(result.runner_up_score, result.score);
  return probabilities;
}

const char* SearchStateName(const SearchState state) {
  switch (state) {
    case SearchState::kMapping:
      return "mapping";
    case SearchState::kSearching:
      return "searching";
    case SearchState::kLocated:
      return "located";
    case SearchState::kLost:
      return "lost";
  }
  return "";
}

SearchState StateOf(const std::optional<LocalizationResult>& localization) {
  if (!localization || localization->verdict == LocalizationVerdict::kNoMap ||
      localization->verdict == LocalizationVerdict::kFinished) {
    return SearchState::kMapping;
  }
  if (localization->localized) return SearchState::kLocated;
  return localization->was_localized ? SearchState::kLost
                                     : SearchState::kSearching;
}

NodeStatus DescribeStatus(const LiveSummary& summary,
                          const std::optional<LocalizationResult>& localization,
                          const double cpu_share) {
  const SearchState state = StateOf(localization);
  NodeStatus status;
  status.is_fine =
      state == SearchState::kMapping || state == SearchState::kLocated;
  status.message = Message(state, localization);
  auto& values = status.values;
  values = {{"state", SearchStateName(state)},
            {"places", absl::StrCat(summary.num_places)},
            {"queue", absl::StrCat(summary.num_waiting_tasks)},
            {"CPU share", absl::StrFormat("%.3f", cpu_share)},
            {"submaps described", absl::StrCat(summary.num_submaps)},
            {"closures", absl::StrCat(summary.num_closures)},
            {"closures in the graph", absl::StrCat(summary.num_injected)},
            {"constraints", absl::StrCat(summary.num_constraints)}};
  if (!localization) return status;
  values.emplace_back("trajectory", absl::StrCat(localization->trajectory_id));
  values.emplace_back("verdict",
                      LocalizationVerdictName(localization->verdict));
  values.emplace_back("reason", localization->reason);
  values.emplace_back("score", absl::StrFormat("%.1f", localization->score));
  values.emplace_back("runner-up score",
                      absl::StrFormat("%.1f", localization->runner_up_score));
  if (localization->T_map_tracking) {
    const Eigen::Vector3d deviations =
        localization->covariance.diagonal().cwiseSqrt();
    values.emplace_back(
        "deviation x, y [m]",
        absl::StrFormat("%.2f, %.2f", deviations.x(), deviations.y()));
    values.emplace_back("deviation yaw [rad]",
                        absl::StrFormat("%.3f", deviations.z()));
  }
  values.emplace_back("searched for [m]",
                      absl::StrFormat("%.1f", localization->distance_driven));
  return status;
}

}  // namespace cartographer_sdf
