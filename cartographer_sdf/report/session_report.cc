// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/localization/changes.h"
#include "cartographer_sdf/localization/probability.h"
#include "cartographer_sdf/report/closure_table.h"
#include "cartographer_sdf/report/reports.h"

namespace cartographer_sdf {
namespace {

constexpr char kPlacementPath[] = "localization.placement";
constexpr size_t kMaxCandidates = 50;

// The session of each trajectory in the picture.
std::map<int, size_t> SessionsOf(const std::vector<MapPart>& parts) {
  std::map<int, size_t> sessions;
  for (size_t k = 0; k < parts.size(); ++k) {
    for (const auto& [trajectory, number] : parts[k].trajectories) {
      sessions[number] = k;
    }
  }
  return sessions;
}

// Adds the submaps under the numbers of the parts. `shows_new_ids`: as those of
// the files are, or as the parts have them.
void AddSubmapsOfParts(const MapState& state, const std::vector<MapPart>& parts,
                       const bool shows_new_ids, Inspection* const inspection) {
  std::map<int, int> numbers_in_file;
  for (const MapPart& part : parts) {
    for (const auto& [trajectory, number] : part.trajectories) {
      numbers_in_file[number] = trajectory;
    }
  }
  const std::map<int, size_t> sessions = SessionsOf(parts);
  for (const auto& [id, submap] : state.submaps) {
    const SubmapId shown =
        shows_new_ids ? id
                      : SubmapId{numbers_in_file.at(id.trajectory), id.index};
    inspection->submaps[id] = {submap.geometry, shown,
                               sessions.at(id.trajectory)};
  }
}

// Calls back with the submaps of a file, except for some, under their new ids.
absl::Status ReadPart(const MapPart& part,
                      const std::map<SubmapId, OccupancyGrid>& but,
                      const ProgressCallback& on_progress,
                      const SubmapCallback& on_submap) {
  // What is missing was refused or dropped when the map was read for the work.
  return ReadMap({part.path, MissingRecords::kKeep},
                 {[&](const SubmapId& id, const SubmapSummary& summary,
                      const OccupancyGrid& grid) {
                   if (but.count(id) > 0) return;
                   on_submap(Renumbered(part, id), summary, grid);
                 }},
                 on_progress)
      .status();
}

std::string FormatScore(const std::optional<double>& score) {
  return score ? absl::StrFormat("%.1f", *score) : "none";
}

MapState Moved(const Rigid2& T_picture_map, MapState state) {
  for (auto& [id, pose] : state.pose_graph.submap_poses) {
    pose = T_picture_map * pose;
  }
  for (auto& [id, node] : state.pose_graph.nodes) {
    node.T_map_node = T_picture_map * node.T_map_node;
  }
  return state;
}

// --- relocalize. ---

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

InspectedRow MatchRowOf(const Match& match, const std::string& status,
                        const std::string& remark) {
  InspectedRow row;
  row.status = status;
  row.remark = remark;
  row.pair = match.pair;
  row.values = MatchValues(match);
  return row;
}

std::vector<RowStatus> VoteStatuses() {
  const std::string path = absl::StrCat(kPlacementPath, ".");
  return {
      {"crossed", "crossed by a wall", Tone::kBad,
       "The best placement puts a long wall of one across free space of the "
       "other.",
       path + "max_crossing_wall_meters"},
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

InspectedTable VoteTable(const LoopClosingOptions& stages,
                         const PlacementOptions& options, const Session& map,
                         const Session& query, const Localization& result) {
  InspectedTable table{
      "matches", "Matches", "",
      MatchMeasures(stages.recognition.match.verification.judgement,
                    kJudgementPath),
      VoteStatuses()};
  table.rows = CrossedRows(map, query, result, table.measures.size());
  table.measures.push_back(
      {"crossing_wall", "crossing wall", "m", 1,
       "The longest straight wall of one across free space of the other.",
       false, Measure::Bound::kAtMost, options.max_crossing_wall_meters,
       absl::StrCat(kPlacementPath, ".max_crossing_wall_meters")});
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

// --- merge. ---

// The outcome of each session and of each pair of sessions.
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
      VoteTable(stages, options.placement, map, query, result)};
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
