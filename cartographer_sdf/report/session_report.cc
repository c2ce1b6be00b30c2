// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/report/reports.h"

namespace cartographer_sdf {
namespace {

constexpr Color kAgreeingColor{0., 0.5, 0.3, 0.6};
constexpr Color kRivalColor{0.58, 0.35, 0.75, 0.8};
constexpr Color kContradictingColor{0.9, 0.1, 0.1, 0.9};

ReportedClosure Reported(const Match& match, const bool accepted,
                         const std::string& reason, const Color& color) {
  return {match, accepted, {}, reason, color, {}};
}

std::vector<ReportedClosure> ClosuresOf(const Localization& result) {
  std::vector<ReportedClosure> closures;
  for (const Match& match : result.contradictions) {
    closures.push_back(Reported(
        match, false, "walls in free space at this pose", kContradictingColor));
  }
  for (size_t k = 0; k < result.placements.size(); ++k) {
    const Placement& placement = result.placements[k];
    const std::string reason =
        k == 0 ? "agrees with the best placement"
        : placement.is_rival
            ? absl::StrCat("supports another placement, number ", k + 1)
            : "neither supports nor excludes the best placement";
    for (const size_t vote : placement.votes) {
      closures.push_back(Reported(
          result.matches[vote], k == 0 && result.T_map_query.has_value(),
          reason, k == 0 ? kAgreeingColor : kRivalColor));
    }
  }
  SortByInterest(&closures);
  return closures;
}

std::vector<ReportedClosure> ClosuresOf(const MergingResult& result) {
  std::vector<ReportedClosure> closures;
  for (const Match& match : result.contradictions) {
    closures.push_back(Reported(match, false,
                                "walls in free space in the merged map",
                                kContradictingColor));
  }
  for (const Closure& closure : result.closed.closures) {
    const bool in_graph = closure.status == ClosureStatus::kInGraph;
    closures.push_back(Reported(
        closure.match, in_graph,
        in_graph ? "in the graph; error " + FormatError(closure.graph_error)
                 : ClosureStatusName(closure.status),
        in_graph ? kAgreeingColor : kRivalColor));
  }
  SortByInterest(&closures);
  return closures;
}

std::map<int, int> LayersOf(const std::vector<MapPart>& parts) {
  std::map<int, int> layers;
  for (size_t k = 0; k < parts.size(); ++k) {
    for (const auto& [trajectory, number] : parts[k].trajectories) {
      layers[number] = static_cast<int>(k);
    }
  }
  return layers;
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

std::vector<std::pair<std::string, std::string>> LocalizationSummary(
    const Session& map, const Session& query, const Localization& result) {
  return {
      {"Answer",
       result.T_map_query
           ? FormatPose(*result.T_map_query)
           : absl::StrCat("none: ", LocalizationVerdictName(result.verdict))},
      {"Reason", result.reason},
      {"Score (log-odds)", FormatScore(result.score)},
      {"Score of the runner-up", FormatScore(result.runner_up_score)},
      {"Agreeing matches", absl::StrCat(result.num_agreeing)},
      {"Contradicting matches", absl::StrCat(result.num_contradicting)},
      {"Submaps of the map", absl::StrCat(map.map.places.size())},
      {"Submaps of the query", absl::StrCat(query.map.places.size())}};
}

// The outcome of each session and of each pair of sessions.
void AddMergingSummary(const MergingResult& result,
                       const std::vector<std::string>& names,
                       ReportContent* const content) {
  for (size_t k = 0; k < result.sessions.size(); ++k) {
    const MergedSession& session = result.sessions[k];
    content->summary.emplace_back(
        absl::StrCat(k + 1, ": ", names[k]),
        session.T_merged_session
            ? "placed at " + FormatPose(*session.T_merged_session)
            : "not in the merged map: " + session.left_out);
    if (!session.T_merged_session) {
      content->warnings.push_back(absl::StrCat(
          names[k], " is not in the merged map: ", session.left_out, "."));
    }
  }
  for (const SessionLink& link : result.links) {
    content->summary.emplace_back(
        absl::StrCat(link.first + 1, " and ", link.second + 1),
        absl::StrCat(LocalizationVerdictName(link.localization.verdict),
                     ", score ", FormatScore(link.localization.score),
                     ", runner-up ",
                     FormatScore(link.localization.runner_up_score), ", ",
                     link.localization.num_agreeing, " matches agree, ",
                     link.localization.num_contradicting,
                     " contradict: ", link.localization.reason));
  }
  content->summary.emplace_back("Overlapping pairs of submaps",
                                absl::StrCat(result.num_overlapping));
  content->summary.emplace_back("Pairs that contradict each other",
                                absl::StrCat(result.contradictions.size()));
  if (!result.refusal.empty()) {
    content->warnings.push_back("Refused: " + result.refusal);
  }
  AddTornSubmaps(result.closed.torn_submaps, content);
}

const char* CaptionOf(const Localization& result) {
  return result.T_map_query ? "The map, overlaid with the query; red where "
                              "walls of one stand in the other's free space"
         : result.placements.empty()
             ? "The map; no placement of the query was found"
             : "The map, overlaid with the query at its best but refused "
               "placement";
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

// Adds the picture of the map and, at its placement, of the query.
absl::Status DrawPlacement(const ReportOptions& options, const Session& map,
                           const Session& query, const Localization& result,
                           const ProgressCallback& on_progress,
                           ReportContent* const content) {
  const std::vector<MapPart> parts = NumberTrajectories(
      {map.path, query.path}, {&map.map.state, &query.map.state});
  MapState shown;
  AppendMap(parts[0], map.map.state, &shown);
  if (!result.placements.empty()) {
    AppendMap(parts[1],
              Moved(result.placements.front().T_map_query, query.map.state),
              &shown);
  }
  const auto read = [&](const SubmapCallback& on_submap) -> absl::Status {
    for (const auto& [id, grid] : query.scan_grids) {
      on_submap(Renumbered(parts[1], id), {}, grid);
    }
    absl::Status status = ReadPart(parts[0], {}, on_progress, on_submap);
    if (status.ok() && !result.placements.empty() &&
        query.scan_grids.size() < query.map.state.submaps.size()) {
      status = ReadPart(parts[1], query.scan_grids, on_progress, on_submap);
    }
    return status;
  };
  for (ReportedClosure& closure : content->closures) {
    PairPose& pair = closure.match.pair;
    pair.reference = Renumbered(parts[0], pair.reference);
    pair.query = Renumbered(parts[1], pair.query);
  }
  return DrawPictures({{CaptionOf(result),
                        &shown,
                        &shown.pose_graph,
                        /*shows_links=*/true,
                        {},
                        LayersOf(parts)}},
                      read, options, content);
}

}  // namespace

absl::Status WriteRelocalizationReport(const ReportRequest& request,
                                       const Session& map, const Session& query,
                                       const Localization& result,
                                       const ProgressCallback& on_progress) {
  ReportContent content;
  content.title = absl::StrCat("Where is ", FileName(query.path), " in ",
                               FileName(map.path), "?");
  content.subtitle = "Found by the shape of free space, without a pose prior.";
  content.summary = LocalizationSummary(map, query, result);
  if (!result.T_map_query) {
    content.warnings.push_back("Not localized: " + result.reason);
  }
  content.stages = result.stage_seconds;
  content.options = request.options_text;
  const std::vector<ReportedClosure> closures = ClosuresOf(result);
  content.closures = closures;
  const absl::Status status =
      DrawPlacement(request.options, map, query, result, on_progress, &content);
  if (!status.ok()) return status;
  // The page uses the ids in the files.
  for (size_t k = 0; k < closures.size(); ++k) {
    content.closures[k].match.pair = closures[k].match.pair;
  }
  return WriteReport(request.directory, content);
}

absl::Status WriteMergingReport(const ReportRequest& request,
                                const MergingResult& result,
                                const ProgressCallback& on_progress) {
  ReportContent content;
  std::vector<std::string> names;
  for (const MergedSession& session : result.sessions) {
    names.push_back(FileName(session.path));
  }
  content.title = absl::StrCat("Merging ", names.size(), " maps");
  content.subtitle = "Found by the shape of free space, without a pose prior.";
  AddMergingSummary(result, names, &content);
  content.stages = result.stage_seconds;
  content.options = request.options_text;
  content.closures = ClosuresOf(result);
  const auto read = [&](const SubmapCallback& on_submap) {
    absl::Status status;
    for (const MapPart& part : result.parts) {
      if (status.ok()) status = ReadPart(part, {}, on_progress, on_submap);
    }
    return status;
  };
  if (!result.parts.empty()) {
    const absl::Status status =
        DrawPictures({{"The merged map, with a colour for each input; red "
                       "where walls of one stand in another's free space",
                       &result.state,
                       &result.closed.pose_graph,
                       /*shows_links=*/true,
                       {},
                       LayersOf(result.parts)}},
                     read, request.options, &content);
    if (!status.ok()) return status;
  }
  return WriteReport(request.directory, content);
}

}  // namespace cartographer_sdf
