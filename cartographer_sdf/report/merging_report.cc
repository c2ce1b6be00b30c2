// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <map>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/report/closure_table.h"
#include "cartographer_sdf/report/reports.h"
#include "cartographer_sdf/report/session_submaps.h"
#include "cartographer_sdf/report/text.h"

namespace cartographer_sdf {
namespace {

// The outcome of each session and of each two that were compared.
void JudgeMerging(const MergingResult& result,
                  const std::vector<std::string>& names,
                  Inspection* const inspection) {
  size_t num_merged = 0;
  for (size_t k = 0; k < result.sessions.size(); ++k) {
    const MergedSession& session = result.sessions[k];
    num_merged += session.T_merged_session.has_value();
    inspection->numbers.emplace_back(
        absl::StrCat(k + 1, ": ", names[k]),
        session.T_merged_session
            ? "placed at " + FormatPose(*session.T_merged_session)
            : "not in the merged map: " + session.left_out);
    if (!session.T_merged_session) {
      inspection->remarks.push_back(absl::StrCat(
          names[k], " is not in the merged map: ", session.left_out, "."));
    }
  }
  if (!result.refusal.empty()) {
    inspection->tone = Tone::kBad;
    inspection->verdict = absl::StrCat("Refused: ", result.refusal, ".");
    return;
  }
  const bool is_clean =
      num_merged == result.sessions.size() && result.contradictions.empty();
  inspection->tone = is_clean ? Tone::kGood : Tone::kCaution;
  inspection->verdict = absl::StrFormat(
      "Merged %d of %d maps by %s; of %d pairs of submaps that overlap, %d "
      "contradict each other.",
      num_merged, result.sessions.size(),
      Counted(NumWithStatus(result.closed.closures, ClosureStatus::kInGraph),
              "closure"),
      result.num_overlapping, result.contradictions.size());
}

void AddMergingNumbers(const MergingResult& result,
                       Inspection* const inspection) {
  for (const SessionLink& link : result.links) {
    const Localization& found = link.localization;
    inspection->numbers.emplace_back(
        absl::StrCat(link.first + 1, " and ", link.second + 1),
        absl::StrCat(LocalizationVerdictName(found.verdict), ", score ",
                     FormatScore(found.score), ", runner-up ",
                     FormatScore(found.runner_up_score), ", ",
                     found.num_agreeing, " matches agree, ",
                     found.num_contradicting, " contradict: ", found.reason));
  }
  inspection->numbers.emplace_back("Overlapping pairs of submaps",
                                   absl::StrCat(result.num_overlapping));
  inspection->numbers.emplace_back("Pairs that contradict each other",
                                   absl::StrCat(result.contradictions.size()));
}

// The sessions in the merged map, in the order of the parts.
std::vector<InspectedSession> MergedSessions(const MergingResult& result) {
  std::vector<InspectedSession> sessions;
  for (const MapPart& part : result.parts) {
    sessions.push_back({FileName(part.path), "merged", Tone::kGood});
  }
  return sessions;
}

// Each session as it is by itself, where it was placed.
PoseGraph PlacedByThemselves(const MergingResult& result) {
  std::map<int, Rigid2> T_merged_trajectories;
  auto part = result.parts.begin();
  for (const MergedSession& session : result.sessions) {
    if (!session.T_merged_session) continue;
    if (part == result.parts.end()) break;
    for (const auto& [trajectory, number] : part->trajectories) {
      T_merged_trajectories[number] = *session.T_merged_session;
    }
    ++part;
  }
  PoseGraph placed = result.state.pose_graph;
  for (auto& [id, pose] : placed.submap_poses) {
    pose = T_merged_trajectories[id.trajectory] * pose;
  }
  for (auto& [id, node] : placed.nodes) {
    node.T_map_node = T_merged_trajectories[id.trajectory] * node.T_map_node;
  }
  return placed;
}

// How much the walls of the maps are at odds, once they are drawn.
void AddSeams(Inspection* const inspection) {
  const std::vector<StatePicture>& drawn = inspection->drawn.states;
  if (drawn.size() < 2 || !drawn.back().conflict_share) return;
  inspection->numbers.emplace_back(
      "Walls in free space of another map",
      absl::StrFormat("%.1f %% as placed, %.1f %% in the merged map",
                      100. * *drawn.front().conflict_share,
                      100. * *drawn.back().conflict_share));
}

InspectedTable MergingTable(const LoopClosingOptions& stages,
                            const MergingResult& result) {
  InspectedTable table = MakeClosureTable(stages, result.closed.closures, {});
  table.statuses.insert(
      table.statuses.begin(),
      {"contradicting", "contradicts", Tone::kBad,
       "The merged map puts walls of one in free space of the other.",
       "fold_check.max_contradiction_ratio"});
  for (const Match& match : result.contradictions) {
    table.rows.push_back(MatchRowOf(match, "contradicting", ""));
    table.rows.back().values.resize(table.measures.size());
  }
  FinishTable(&table);
  return table;
}

}  // namespace

absl::Status WriteMergingReport(const ReportRequest& request,
                                const LoopClosingOptions& stages,
                                const MergingResult& result,
                                const ProgressCallback& on_progress) {
  Inspection inspection;
  std::vector<std::string> names;
  for (const MergedSession& session : result.sessions) {
    names.push_back(FileName(session.path));
  }
  inspection.title = absl::StrCat("Merging ", names.size(), " maps");
  JudgeMerging(result, names, &inspection);
  AddMergingNumbers(result, &inspection);
  inspection.stage_seconds = result.stage_seconds;
  inspection.sessions = MergedSessions(result);
  const PoseGraph placed = PlacedByThemselves(result);
  if (!result.parts.empty()) {
    inspection.states = {
        {"before", "Before", "The maps as they are, where they were placed",
         &placed},
        {"after", "After", "The merged map", &result.closed.pose_graph}};
    AddSubmapsOfParts(result.state, result.parts, /*shows_new_ids=*/true,
                      &inspection);
    AddDisplacement(&inspection);
  }
  AddTornSubmaps(result.closed.torn_submaps, &inspection);
  AddSlips(result.closed.slips, result.state.pose_graph, &inspection);
  inspection.tables = {MergingTable(stages, result)};
  const auto read = [&](const SubmapCallback& on_submap) {
    absl::Status status;
    for (const MapPart& part : result.parts) {
      if (status.ok()) status = ReadPart(part, {}, on_progress, on_submap);
    }
    return status;
  };
  const absl::Status status =
      DrawInspection(request.options, read, &inspection);
  if (!status.ok()) return status;
  AddSeams(&inspection);
  return WriteInspector(request, inspection);
}

}  // namespace cartographer_sdf
