// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/localization/changes.h"
#include "cartographer_sdf/localization/probability.h"
#include "cartographer_sdf/report/closure_table.h"
#include "cartographer_sdf/report/reports.h"
#include "cartographer_sdf/report/session_submaps.h"
#include "cartographer_sdf/report/text.h"

namespace cartographer_sdf {
namespace {

constexpr char kPlacementPath[] = "localization.placement";
constexpr size_t kMaxCandidates = 50;

MapState Moved(const Rigid2& T_picture_map, MapState state) {
  for (auto& [id, pose] : state.pose_graph.submap_poses) {
    pose = T_picture_map * pose;
  }
  for (auto& [id, node] : state.pose_graph.nodes) {
    node.T_map_node = T_picture_map * node.T_map_node;
  }
  return state;
}

// Of each placement being right. The best one and a rival exclude each other;
// others stand for themselves.
std::vector<double> PlacementProbabilities(const Localization& result) {
  std::vector<double> probabilities;
  for (size_t k = 0; k < result.placements.size(); ++k) {
    const Placement& placement = result.placements[k];
    probabilities.push_back(
        k == 0 ? ProbabilityOf(placement.score, result.runner_up_score)
        : placement.is_rival ? ProbabilityOf(placement.score, result.score)
                             : ProbabilityOf(placement.score));
  }
  return probabilities;
}

// Where the drive of the query ended, in its map frame.
Rigid2 EndOf(const MapState& query) {
  const std::map<NodeId, Node>& nodes = query.pose_graph.nodes;
  return nodes.empty() ? Rigid2() : nodes.rbegin()->second.T_map_node;
}

std::vector<Measure> PlacementMeasures(const PlacementOptions& options) {
  const std::string path = absl::StrCat(kPlacementPath, ".");
  return {
      {"probability", "probability", "%", 2,
       "Of being right, as the scores say: the best one and a rival exclude "
       "each other.",
       true},
      {"score", "score", "", 2,
       "Log-odds: the evidence of the places that support it.", true,
       Measure::Bound::kAtLeast, options.min_score, path + "min_score"},
      {"lead", "lead", "", 2,
       "By how much its score exceeds that of the best placement that it "
       "excludes.",
       true, Measure::Bound::kAtLeast, options.min_lead, path + "min_lead"},
      {"matches", "matches", "", 0, "Pairs of submaps that vote for it.",
       true}};
}

std::vector<RowStatus> PlacementStatuses() {
  const std::string path = absl::StrCat(kPlacementPath, ".");
  return {{"answer", "the answer", Tone::kGood, "It is certain.", ""},
          {"best", "best, but refused", Tone::kCaution,
           "The best of them, which is not certain.", path + "min_score"},
          {"rival", "rival", Tone::kBad,
           "It and the best one exclude each other.", path + "min_lead"},
          {"other", "other", Tone::kNeutral,
           "Neither supports nor excludes the best one.", ""}};
}

InspectedTable PlacementTable(const PlacementOptions& options,
                              const MapState& query,
                              const Localization& result) {
  InspectedTable table{
      "candidates", "Candidates",
      "Placements of the query; arrows show where its drive ended.",
      PlacementMeasures(options), PlacementStatuses()};
  const std::vector<double> probabilities = PlacementProbabilities(result);
  for (size_t k = 0; k < std::min(result.placements.size(), kMaxCandidates);
       ++k) {
    const Placement& placement = result.placements[k];
    InspectedRow row;
    row.status = k > 0                ? placement.is_rival ? "rival" : "other"
                 : result.T_map_query ? "answer"
                                      : "best";
    row.T_map_robot = placement.T_map_query * EndOf(query);
    row.values = {
        100. * probabilities[k], placement.score,
        k == 0 && result.runner_up_score
            ? std::make_optional(placement.score - *result.runner_up_score)
            : std::nullopt,
        static_cast<double>(placement.votes.size())};
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<RowStatus> VoteStatuses() {
  const std::string path = absl::StrCat(kPlacementPath, ".");
  return {
      {"crossed", "crossed by a wall", Tone::kBad,
       "The best placement puts a long wall of one across free space of the "
       "other.",
       absl::StrCat(kCrossingPath, ".max_wall_meters")},
      {"contradicting", "contradicts", Tone::kBad,
       "The best placement puts walls of one in free space of the other.",
       path + "max_contradiction_ratio"},
      {"rival", "votes for a rival", Tone::kCaution,
       "It supports a placement that excludes the best one.",
       path + "min_lead"},
      {"agreeing", "agrees", Tone::kGood, "It votes for the best placement.",
       ""},
      {"other", "other", Tone::kNeutral,
       "It neither supports nor excludes the best placement.", ""}};
}

// The pairs that walls cross, at the pose that the best placement gives them.
std::vector<InspectedRow> CrossedRows(const Session& map, const Session& query,
                                      const Localization& result,
                                      const size_t num_match_values) {
  std::vector<InspectedRow> rows;
  for (const CrossingWall& wall : result.crossing_walls) {
    const Rigid2 T_reference_query =
        map.map.state.pose_graph.submap_poses.at(wall.reference).Inverse() *
        result.placements.front().T_map_query *
        query.map.state.pose_graph.submap_poses.at(wall.query);
    InspectedRow row;
    row.status = "crossed";
    row.pair = {wall.reference, wall.query, T_reference_query, 0.};
    row.values.resize(num_match_values);
    row.values.push_back(wall.length);
    rows.push_back(std::move(row));
  }
  return rows;
}

InspectedTable VoteTable(const LoopClosingOptions& stages, const Session& map,
                         const Session& query, const Localization& result) {
  InspectedTable table{
      "matches", "Matches", "",
      MatchMeasures(stages.recognition.match.verification.judgement,
                    kJudgementPath, LeastScoreOf(stages.recognition)),
      VoteStatuses()};
  table.rows = CrossedRows(map, query, result, table.measures.size());
  table.measures.push_back(
      {"crossing_wall", "crossing wall", "m", 1,
       "The longest straight wall of one across free space of the other.",
       false, Measure::Bound::kAtMost,
       stages.recognition.match.verification.crossing.max_wall_meters,
       absl::StrCat(kCrossingPath, ".max_wall_meters")});
  for (const Match& match : result.contradictions) {
    table.rows.push_back(MatchRowOf(match, "contradicting", ""));
  }
  for (size_t k = 0; k < result.placements.size(); ++k) {
    const Placement& placement = result.placements[k];
    const std::string status = k == 0               ? "agreeing"
                               : placement.is_rival ? "rival"
                                                    : "other";
    const std::string remark =
        k == 0 ? "" : absl::StrCat("It votes for candidate ", k + 1, ".");
    for (const size_t vote : placement.votes) {
      table.rows.push_back(MatchRowOf(result.matches[vote], status, remark));
    }
  }
  FinishTable(&table);
  return table;
}

// What changed since the map was made, and whether the query holds together.
void AddChanges(const Localization& result, Inspection* const inspection) {
  for (const Change& change : result.changes) {
    inspection->changes.push_back(
        {ChangeKindName(change.kind), change.box, change.wall_area});
  }
  if (!result.changes.empty()) {
    inspection->remarks.push_back(absl::StrCat(
        "Changed since the map was made: ", DescribeChanges(result.changes),
        "."));
  }
  if (!result.parts.jumps.empty()) {
    inspection->tone = Tone::kCaution;
    inspection->remarks.push_back(
        absl::StrCat("It jumps: ", DescribeJumps(result.parts.jumps), "."));
  }
  const size_t num_parts = result.parts.parts.size();
  if (num_parts > 1) {
    inspection->remarks.push_back(absl::StrFormat(
        "The query lies in %d parts at poses of their own; it is drawn as one, "
        "where the best part lies.",
        num_parts));
  }
}

void JudgeLocalization(const Session& map, const Session& query,
                       const Localization& result,
                       Inspection* const inspection) {
  if (result.T_map_query) {
    inspection->tone = Tone::kGood;
    inspection->verdict = absl::StrFormat(
        "Localised: %s lies at %s in %s, with a probability of %s. %s agree, "
        "%d contradict.",
        FileName(query.path), FormatPose(*result.T_map_query),
        FileName(map.path),
        FormatProbability(
            ProbabilityOf(result.score.value_or(0.), result.runner_up_score)),
        Counted(static_cast<size_t>(result.num_agreeing), "matching pair"),
        result.num_contradicting);
    AddChanges(result, inspection);
  } else {
    inspection->tone = Tone::kCaution;
    inspection->verdict =
        absl::StrCat("Not localised (", LocalizationVerdictName(result.verdict),
                     "): ", result.reason, ".");
  }
  inspection->numbers = {
      {"Answer",
       result.T_map_query
           ? FormatPose(*result.T_map_query)
           : absl::StrCat("none: ", LocalizationVerdictName(result.verdict))},
      {"Reason", result.reason},
      {"Score (log-odds)", FormatScore(result.score)},
      {"Score of the runner-up", FormatScore(result.runner_up_score)},
      {"Agreeing matches", absl::StrCat(result.num_agreeing)},
      {"Contradicting matches", absl::StrCat(result.num_contradicting)},
      {"Overlapping pairs of submaps", absl::StrCat(result.num_compared)},
      {"Of them crossed by a wall", absl::StrCat(result.crossing_walls.size())},
      {"Submaps of the map", absl::StrCat(map.map.places.size())},
      {"Submaps of the query", absl::StrCat(query.map.places.size())}};
}

void RenumberRows(const std::vector<MapPart>& parts,
                  InspectedTable* const table) {
  for (InspectedRow& row : table->rows) {
    row.pair->reference = Renumbered(parts[0], row.pair->reference);
    row.pair->query = Renumbered(parts[1], row.pair->query);
  }
}

const char* CaptionOf(const Localization& result) {
  return result.T_map_query ? "The map, and the query where it was found"
         : result.placements.empty()
             ? "The map; no placement of the query was found"
             : "The map, and the query at its best but refused placement";
}

// The map and, if there is a placement, the query at the best one.
class PlacedSessions {
 public:
  PlacedSessions(const Session& map, const Session& query,
                 const Localization& result)
      : query_(query),
        parts_(NumberTrajectories({map.path, query.path},
                                  {&map.map.state, &query.map.state})),
        shows_query_(!result.placements.empty()) {
    AppendMap(parts_[0], map.map.state, &shown_);
    if (!shows_query_) return;
    AppendMap(parts_[1],
              Moved(result.placements.front().T_map_query, query.map.state),
              &shown_);
  }

  [[nodiscard]] const std::vector<MapPart>& parts() const { return parts_; }
  [[nodiscard]] const MapState& shown() const { return shown_; }

  [[nodiscard]] absl::Status Read(const ProgressCallback& on_progress,
                                  const SubmapCallback& on_submap) const {
    for (const auto& [id, grid] : query_.scan_grids) {
      on_submap(Renumbered(parts_[1], id), {}, grid);
    }
    absl::Status status = ReadPart(parts_[0], {}, on_progress, on_submap);
    if (status.ok() && shows_query_ &&
        query_.scan_grids.size() < query_.map.state.submaps.size()) {
      status = ReadPart(parts_[1], query_.scan_grids, on_progress, on_submap);
    }
    return status;
  }

 private:
  const Session& query_;
  const std::vector<MapPart> parts_;
  MapState shown_;
  const bool shows_query_;
};

}  // namespace

absl::Status WriteRelocalizationReport(const ReportRequest& request,
                                       const LoopClosingOptions& stages,
                                       const LocalizationOptions& options,
                                       const Session& map, const Session& query,
                                       const Localization& result,
                                       const ProgressCallback& on_progress) {
  const PlacedSessions placed(map, query, result);
  Inspection inspection;
  inspection.title = absl::StrCat("Where is ", FileName(query.path), " in ",
                                  FileName(map.path), "?");
  JudgeLocalization(map, query, result, &inspection);
  inspection.sessions = {{FileName(map.path), "the map"},
                         {FileName(query.path), "the query"}};
  inspection.states = {
      {"placed", "Placed", CaptionOf(result), &placed.shown().pose_graph}};
  AddSubmapsOfParts(placed.shown(), placed.parts(), /*shows_new_ids=*/false,
                    &inspection);
  inspection.tables = {
      PlacementTable(options.placement, query.map.state, result),
      VoteTable(stages, map, query, result)};
  RenumberRows(placed.parts(), &inspection.tables.back());
  inspection.stage_seconds = result.stage_seconds;
  const absl::Status status = DrawInspection(
      request.options,
      [&](const SubmapCallback& on_submap) {
        return placed.Read(on_progress, on_submap);
      },
      &inspection);
  if (!status.ok()) return status;
  return WriteInspector(request, inspection);
}

}  // namespace cartographer_sdf
