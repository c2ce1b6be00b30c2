// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/session_report.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/report/html_report.h"
#include "cartographer_sdf/report/map_painter.h"
#include "cartographer_sdf/report/map_picture.h"
#include "cartographer_sdf/report/submap_pictures.h"

namespace cartographer_sdf {
namespace {

constexpr Color kAgreeingColor{0., 0.5, 0.3, 0.6};
constexpr Color kRivalColor{0.58, 0.35, 0.75, 0.8};
constexpr Color kContradictingColor{0.9, 0.1, 0.1, 0.9};

std::string FileName(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

// One map of those that are laid over each other, by the ids of its file.
struct Layer {
  std::string path;
  std::map<SubmapId, PlacedGrid> submaps;  // in the frame of the picture
  // Where the robot was in the middle of each, in the same frame.
  std::map<SubmapId, Eigen::Vector2d> centres;
  std::map<int, std::vector<Eigen::Vector2d>> driven;
  // Of submaps that are not in the file.
  std::map<SubmapId, OccupancyGrid> scan_grids;
};

// A pair of submaps of layers, as shown.
struct ShownMatch {
  size_t reference_layer = 0;
  size_t query_layer = 0;
  SubmapId reference;  // by the ids of their files
  SubmapId query;
  Match match;
  bool is_accepted = false;
  std::string reason;
  Color color;
};

Layer MakeLayer(const std::string& path, const MapState& state,
                const Rigid2& T_picture_map) {
  Layer layer;
  layer.path = path;
  const std::map<SubmapId, Eigen::Vector2d> centres =
      SubmapCentres(state.pose_graph);
  for (const auto& [id, submap] : state.submaps) {
    const Rigid2 T_picture_submap =
        T_picture_map * state.pose_graph.submap_poses.at(id);
    layer.submaps[id] = {submap.geometry, T_picture_submap};
    layer.centres[id] = T_picture_submap * centres.at(id);
  }
  for (const auto& [id, node] : state.pose_graph.nodes) {
    layer.driven[id.trajectory].push_back(T_picture_map *
                                          node.T_map_node.translation());
  }
  return layer;
}

class OverlayReport {
 public:
  OverlayReport(const ReportOptions& options, std::vector<Layer> layers,
                std::vector<ShownMatch> matches)
      : options_(options),
        layers_(std::move(layers)),
        matches_(std::move(matches)) {
    const size_t max_pictures =
        static_cast<size_t>(options.max_closure_pictures);
    for (size_t k = 0; k < std::min(matches_.size(), max_pictures); ++k) {
      const ShownMatch& match = matches_[k];
      wanted_.emplace(match.reference_layer, match.reference);
      wanted_.emplace(match.query_layer, match.query);
    }
  }

  absl::Status Paint(const std::string& caption, ReportContent* const content,
                     const ProgressCallback& on_progress) {
    std::vector<PlacedGrid> all;
    for (const Layer& layer : layers_) {
      for (const auto& [id, submap] : layer.submaps) all.push_back(submap);
    }
    std::vector<MapPainter> painters(
        layers_.size(), MapPainter(all, options_.map_picture_pixels));
    for (size_t k = 0; k < layers_.size(); ++k) {
      if (absl::Status status = AddGrids(k, &painters[k], on_progress);
          !status.ok()) {
        return status;
      }
    }
    std::vector<const MapPainter*> pointers;
    for (const MapPainter& painter : painters) pointers.push_back(&painter);
    Picture picture = PaintOverlaid(pointers);
    DrawPathsAndLinks(painters.front().frame(), &picture);
    content->maps.push_back({caption, picture.EncodePng()});
    for (const ShownMatch& match : matches_) {
      content->closures.push_back(
          {match.match, match.is_accepted, {}, match.reason, DrawPair(match)});
    }
    return absl::OkStatus();
  }

 private:
  void DrawPathsAndLinks(const PixelFrame& frame,
                         Picture* const picture) const {
    DrawMetricGrid(frame, picture);
    for (size_t k = 0; k < layers_.size(); ++k) {
      for (const auto& [trajectory, path] : layers_[k].driven) {
        DrawTrajectory(path, frame, CategoryColor(static_cast<int>(k)),
                       picture);
      }
    }
    // What matters most is drawn last.
    for (auto match = matches_.rbegin(); match != matches_.rend(); ++match) {
      const Layer& reference = layers_[match->reference_layer];
      const Layer& query = layers_[match->query_layer];
      const auto from = reference.centres.find(match->reference);
      const auto to = query.centres.find(match->query);
      if (from == reference.centres.end() || to == query.centres.end()) {
        continue;
      }
      DrawLink(from->second, to->second, frame, match->color, picture);
    }
    DrawScaleBar(frame, picture);
  }

  absl::Status AddGrids(const size_t k, MapPainter* const painter,
                        const ProgressCallback& on_progress) {
    const Layer& layer = layers_[k];
    const auto add = [&](const SubmapId& id, const OccupancyGrid& grid) {
      const auto submap = layer.submaps.find(id);
      if (submap == layer.submaps.end()) return;
      painter->AddSubmap(grid, submap->second.T_map_submap);
      if (wanted_.count({k, id}) > 0) grids_.emplace(std::pair(k, id), grid);
    };
    for (const auto& [id, grid] : layer.scan_grids) add(id, grid);
    if (layer.scan_grids.size() == layer.submaps.size()) {
      return absl::OkStatus();
    }
    return ReadMap(layer.path,
                   {[&](const SubmapId& id, const SubmapSummary&,
                        const OccupancyGrid& grid) {
                     if (layer.scan_grids.count(id) == 0) add(id, grid);
                   }},
                   on_progress)
        .status();
  }

  [[nodiscard]] std::string DrawPair(const ShownMatch& match) const {
    const auto reference =
        grids_.find({match.reference_layer, match.reference});
    const auto query = grids_.find({match.query_layer, match.query});
    if (reference == grids_.end() || query == grids_.end()) return "";
    std::vector<PointPair> pairs;
    for (const auto& inlier : match.match.inliers) {
      pairs.push_back({inlier.first, inlier.second});
    }
    return DrawMatchedPair(reference->second, query->second,
                           match.match.pair.T_reference_query, pairs,
                           options_.closure_picture_pixels)
        .EncodePng();
  }

  const ReportOptions& options_;
  const std::vector<Layer> layers_;
  const std::vector<ShownMatch> matches_;
  std::set<std::pair<size_t, SubmapId>> wanted_;
  std::map<std::pair<size_t, SubmapId>, OccupancyGrid> grids_;
};

// Least certain first, where one should look.
void SortByScore(std::vector<ShownMatch>* const matches) {
  std::stable_sort(matches->begin(), matches->end(),
                   [](const ShownMatch& a, const ShownMatch& b) {
                     return std::pair(a.is_accepted, a.match.pair.score) <
                            std::pair(b.is_accepted, b.match.pair.score);
                   });
}

ShownMatch BetweenMapAndQuery(const Match& match) {
  ShownMatch shown;
  shown.query_layer = 1;
  shown.reference = match.pair.reference;
  shown.query = match.pair.query;
  shown.match = match;
  return shown;
}

std::vector<ShownMatch> MatchesOf(const Localization& result) {
  std::vector<ShownMatch> matches;
  for (const Match& match : result.contradictions) {
    matches.push_back(BetweenMapAndQuery(match));
    matches.back().reason = "walls in free space where this is found";
    matches.back().color = kContradictingColor;
  }
  for (size_t k = 0; k < result.placements.size(); ++k) {
    const Placement& placement = result.placements[k];
    for (const size_t vote : placement.votes) {
      matches.push_back(BetweenMapAndQuery(result.matches[vote]));
      ShownMatch& shown = matches.back();
      shown.is_accepted = k == 0 && result.T_map_query.has_value();
      shown.reason = k == 0 ? "agrees with the best placement"
                     : placement.is_rival
                         ? absl::StrCat("for another placement, number ", k + 1)
                         : "neither supports nor excludes the best placement";
      shown.color = k == 0 ? kAgreeingColor : kRivalColor;
    }
  }
  SortByScore(&matches);
  return matches;
}

std::string FormatPose(const Rigid2& pose) {
  return absl::StrFormat("x %.3f m, y %.3f m, yaw %.2f deg",
                         pose.translation().x(), pose.translation().y(),
                         pose.rotation() * 180. / M_PI);
}

std::string FormatScore(const std::optional<double>& score) {
  return score ? absl::StrFormat("%.1f", *score) : "none";
}

// The layers of a merged map, in its frame.
std::vector<Layer> LayersOf(const MergingResult& result) {
  std::vector<Layer> layers;
  // As read: optimisation does not move nodes within a submap by much.
  const std::map<SubmapId, Eigen::Vector2d> centres =
      SubmapCentres(result.state.pose_graph);
  for (const MapPart& part : result.parts) {
    Layer layer;
    layer.path = part.path;
    for (const auto& [trajectory, number] : part.trajectories) {
      for (auto submap = result.state.submaps.lower_bound({number, 0});
           submap != result.state.submaps.end() &&
           submap->first.trajectory == number;
           ++submap) {
        const auto pose =
            result.closed.pose_graph.submap_poses.find(submap->first);
        if (pose == result.closed.pose_graph.submap_poses.end()) continue;
        layer.submaps[{trajectory, submap->first.index}] = {
            submap->second.geometry, pose->second};
        layer.centres[{trajectory, submap->first.index}] =
            pose->second * centres.at(submap->first);
      }
      for (auto node = result.closed.pose_graph.nodes.lower_bound({number, 0});
           node != result.closed.pose_graph.nodes.end() &&
           node->first.trajectory == number;
           ++node) {
        layer.driven[trajectory].push_back(
            node->second.T_map_node.translation());
      }
    }
    layers.push_back(std::move(layer));
  }
  return layers;
}

// The part and the id in its file of a submap of the merged map.
std::pair<size_t, SubmapId> InFile(const std::vector<MapPart>& parts,
                                   const SubmapId& id) {
  for (size_t k = 0; k < parts.size(); ++k) {
    for (const auto& [trajectory, number] : parts[k].trajectories) {
      if (number == id.trajectory) return {k, {trajectory, id.index}};
    }
  }
  return {};
}

ShownMatch InMergedMap(const std::vector<MapPart>& parts, const Match& match) {
  ShownMatch shown;
  std::tie(shown.reference_layer, shown.reference) =
      InFile(parts, match.pair.reference);
  std::tie(shown.query_layer, shown.query) = InFile(parts, match.pair.query);
  shown.match = match;
  return shown;
}

std::vector<ShownMatch> MatchesOf(const MergingResult& result) {
  std::vector<ShownMatch> matches;
  for (const Match& match : result.contradictions) {
    matches.push_back(InMergedMap(result.parts, match));
    matches.back().reason = "walls in free space in the merged map";
    matches.back().color = kContradictingColor;
  }
  for (const Closure& closure : result.closed.closures) {
    matches.push_back(InMergedMap(result.parts, closure.match));
    ShownMatch& shown = matches.back();
    shown.is_accepted = closure.status == ClosureStatus::kInGraph;
    shown.reason =
        shown.is_accepted
            ? absl::StrFormat("in the graph; error %.2f m, %.1f deg",
                              closure.graph_error.translation,
                              closure.graph_error.rotation * 180. / M_PI)
            : ClosureStatusName(closure.status);
    shown.color = shown.is_accepted ? kAgreeingColor : kRivalColor;
  }
  SortByScore(&matches);
  return matches;
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

// What became of each session and of each pair of them.
void AddMergingSummary(const MergingResult& result,
                       const std::vector<std::string>& names,
                       ReportContent* const content) {
  for (size_t k = 0; k < result.sessions.size(); ++k) {
    const MergedSession& session = result.sessions[k];
    content->summary.emplace_back(
        absl::StrCat(k + 1, ": ", names[k]),
        session.T_merged_session
            ? "laid at " + FormatPose(*session.T_merged_session)
            : "not connected with the merged maps");
    if (!session.T_merged_session) {
      content->warnings.push_back(absl::StrCat(
          names[k], " is not connected with the others, and not in the map."));
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
  for (const auto& [id, tear] : result.closed.torn_submaps) {
    content->warnings.push_back(
        absl::StrCat("A submap is torn inside; its closures have zero weight. ",
                     DescribeTear(id, tear)));
  }
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
  const std::optional<Rigid2> T_map_query =
      !result.placements.empty()
          ? std::make_optional(result.placements.front().T_map_query)
          : std::nullopt;
  std::vector<Layer> layers = {MakeLayer(map.path, map.map.state, Rigid2())};
  if (T_map_query) {
    layers.push_back(MakeLayer(query.path, query.map.state, *T_map_query));
    layers.back().scan_grids = query.scan_grids;
  }
  const absl::Status status =
      OverlayReport(request.options, std::move(layers), MatchesOf(result))
          .Paint(!T_map_query ? "The map; there is no place for the query"
                 : result.T_map_query
                     ? "The map, and over it the query; red where walls of "
                       "one stand in the other's free space"
                     : "The map, and over it the query where it fits best, "
                       "which is not believed",
                 &content, on_progress);
  if (!status.ok()) return status;
  return WriteReport(request.directory, content, request.options);
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
  if (!result.parts.empty()) {
    const absl::Status status =
        OverlayReport(request.options, LayersOf(result), MatchesOf(result))
            .Paint(
                "The merged map, a colour for each map; red where walls of "
                "one stand in another's free space",
                &content, on_progress);
    if (!status.ok()) return status;
  }
  return WriteReport(request.directory, content, request.options);
}

}  // namespace cartographer_sdf
