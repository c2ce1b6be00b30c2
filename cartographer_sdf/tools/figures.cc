// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// `figures`: the pictures of the paper, of any map.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/report/feature_pictures.h"
#include "cartographer_sdf/report/map_painter.h"
#include "cartographer_sdf/report/match_map.h"
#include "cartographer_sdf/report/match_table.h"
#include "cartographer_sdf/report/submap_pictures.h"
#include "cartographer_sdf/report/svg_plot.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/method_options.h"
#include "cartographer_sdf/tools/progress.h"
#include "cartographer_sdf/tools/subcommand.h"

DECLARE_string(matches);
DECLARE_string(method);

DEFINE_string(submap, "",
              "The submap whose features are drawn, by trajectory,index; if "
              "empty, the first of those with the most features.");
DEFINE_string(
    figure_pair, "",
    "The match that is drawn, by trajectory,index of the reference "
    "and of the query; if empty, of two maps the best of the accepted "
    "ones, of one map the accepted one of submaps farthest apart in "
    "time.");
DEFINE_int32(figure_pixels, 700, "Longer side of the pictures [pixels].");

namespace cartographer_sdf {
namespace {

constexpr double kMaskClearances[] = {2., 1.5, 1., 0.5};  // [m], Fig. 6

absl::StatusOr<std::vector<int>> ParseIds(const std::string& flag,
                                          const std::string& text,
                                          const size_t count) {
  std::vector<int> ids;
  for (const absl::string_view part : absl::StrSplit(text, ',')) {
    int id = 0;
    ids.push_back(absl::SimpleAtoi(part, &id) ? id : -1);
  }
  if (ids.size() != count || *std::min_element(ids.begin(), ids.end()) < 0) {
    return UsageError(absl::StrCat("--", flag, " must be ", count,
                                   " numbers, separated by commas, it is ",
                                   text));
  }
  return ids;
}

struct DescribedGrid {
  OccupancyGrid grid;
  DistanceField field;
  Eigen::ArrayXXf smoothed;
  FeatureSet features;
};

std::optional<DescribedGrid> DescribeGrid(const PlaceOptions& options,
                                          const OccupancyGrid& grid) {
  std::optional<DistanceField> field = MakeDistanceField(options.field, grid);
  if (!field) return std::nullopt;
  DescribedGrid described{grid, *std::move(field), {}, {}};
  described.smoothed =
      SmoothField(described.field, options.keypoint.smoothing_sigma_cells);
  described.features = DescribeKeypoints(
      options.descriptor, described.field, described.smoothed,
      DetectKeypoints(options.keypoint, described.field, described.smoothed));
  return described;
}

// Where pictures go, and which were written.
class Output {
 public:
  [[nodiscard]] absl::Status Open() const {
    std::error_code error;
    std::filesystem::create_directories(FLAGS_output, error);
    if (!std::filesystem::is_directory(FLAGS_output, error)) {
      return absl::UnavailableError(
          absl::StrCat("cannot make the directory ", FLAGS_output));
    }
    return absl::OkStatus();
  }
  void Write(const std::string& name, const std::string& content) {
    if (!status_.ok()) return;
    const std::string path = absl::StrCat(FLAGS_output, "/", name);
    status_ = WriteWholeFile(path, content);
    if (status_.ok()) paths_.push_back(path);
  }
  [[nodiscard]] const absl::Status& status() const { return status_; }
  [[nodiscard]] const std::vector<std::string>& paths() const { return paths_; }

 private:
  absl::Status status_;
  std::vector<std::string> paths_;
};

// A strong one in free space, of the middle of a room: the strongest maximum
// whose window holds no wall, or else the strongest of all.
size_t ChooseFeature(const DescriptorOptions& options,
                     const FeatureSet& features) {
  const auto rank = [&options](const Feature& feature) {
    const Keypoint& keypoint = feature.keypoint;
    return std::make_pair(keypoint.kind == KeypointKind::kMaximum &&
                              keypoint.clearance > options.radius_meters,
                          keypoint.strength);
  };
  const auto best =
      std::max_element(features.features.begin(), features.features.end(),
                       [&rank](const Feature& a, const Feature& b) {
                         return rank(a) < rank(b);
                       });
  return static_cast<size_t>(best - features.features.begin());
}

void DrawSubmap(const PlaceOptions& options, const DescribedGrid& submap,
                Output* const output) {
  const int pixels = FLAGS_figure_pixels;
  const std::vector<MarkedKeypoint> keypoints = MarkKeypoints(submap.features);
  output->Write("grid.png", DrawOccupancyGrid(submap.grid, pixels).EncodePng());
  const auto draw_field = [&](const std::vector<MarkedKeypoint>& marked) {
    return DrawDistanceField(submap.field.geometry, submap.field.distance,
                             submap.field.observed, marked, pixels)
        .EncodePng();
  };
  output->Write("field.png", draw_field({}));
  output->Write("keypoints.png", draw_field(keypoints));
  output->Write("surface.png",
                DrawFieldSurface(submap.field, keypoints, pixels).EncodePng());
  for (const double clearance : kMaskClearances) {
    output->Write(
        absl::StrFormat("mask_%.1fm.png", clearance),
        DrawClearanceMask(submap.field, clearance, pixels).EncodePng());
  }
  if (submap.features.features.empty()) return;
  const size_t chosen = ChooseFeature(options.descriptor, submap.features);
  const Feature& feature = submap.features.features[chosen];
  output->Write("feature_location.png", draw_field({keypoints[chosen]}));
  output->Write("feature_window.png",
                DrawFeatureWindow(options.descriptor, submap.field,
                                  submap.smoothed, feature, pixels)
                    .EncodePng());
  output->Write("feature_histogram.svg",
                StandaloneSvg(RenderDescriptor(submap.features.descriptors.col(
                    static_cast<Eigen::Index>(chosen)))));
}

std::vector<PlacedGrid> PlaceGrids(const MapState& state) {
  std::vector<PlacedGrid> grids;
  for (const auto& [id, submap] : state.submaps) {
    const auto pose = state.pose_graph.submap_poses.find(id);
    if (pose != state.pose_graph.submap_poses.end()) {
      grids.push_back({submap.geometry, pose->second});
    }
  }
  return grids;
}

std::vector<ShownPath> Paths(const PoseGraph& pose_graph,
                             const Rigid2& T_picture_map, const bool is_query) {
  std::map<int, ShownPath> paths;
  for (const auto& [id, node] : pose_graph.nodes) {
    ShownPath& path = paths[id.trajectory];
    path.is_query = is_query;
    path.positions.push_back(T_picture_map * node.T_map_node.translation());
  }
  std::vector<ShownPath> list;
  for (auto& entry : paths) list.push_back(std::move(entry.second));
  return list;
}

absl::StatusOr<std::pair<SubmapId, SubmapId>> ChooseMatch(
    const bool has_query) {
  if (!FLAGS_figure_pair.empty()) {
    const absl::StatusOr<std::vector<int>> ids =
        ParseIds("figure_pair", FLAGS_figure_pair, 4);
    if (!ids.ok()) return ids.status();
    return std::make_pair(SubmapId{(*ids)[0], (*ids)[1]},
                          SubmapId{(*ids)[2], (*ids)[3]});
  }
  const absl::StatusOr<std::vector<MatchRow>> matches =
      ReadMatches(FLAGS_matches);
  if (!matches.ok()) return matches.status();
  const auto rank = [has_query](const MatchRow& match) {
    const int gap =
        has_query || match.reference.trajectory != match.query.trajectory
            ? 0
            : std::abs(match.query.index - match.reference.index);
    return std::make_pair(gap, match.score);
  };
  const MatchRow* best = nullptr;
  for (const MatchRow& match : *matches) {
    if (match.accepted && (best == nullptr || rank(*best) < rank(match))) {
      best = &match;
    }
  }
  if (best == nullptr) {
    return absl::NotFoundError(
        absl::StrCat(FLAGS_matches, " has no accepted match"));
  }
  return std::make_pair(best->reference, best->query);
}

// Reads one map, and one grid of it apart.
absl::StatusOr<MapState> ReadWithGrid(
    const std::string& path, const std::set<SubmapId>& wanted,
    std::map<SubmapId, OccupancyGrid>* const grids,
    const ProgressCallback& on_progress) {
  absl::StatusOr<MapState> state =
      ReadMap(path,
              {[&](const SubmapId& id, const SubmapSummary&,
                   const OccupancyGrid& grid) {
                if (wanted.count(id) > 0) grids->emplace(id, grid);
              }},
              on_progress);
  if (!state.ok()) return state.status();
  for (const SubmapId& id : wanted) {
    if (grids->count(id) == 0 ||
        state->pose_graph.submap_poses.count(id) == 0) {
      return absl::NotFoundError(
          absl::StrCat(path, " has no submap ", id.trajectory, ",", id.index));
    }
  }
  return state;
}

// Two submaps, and the maps that they are of.
struct SubmapPair {
  SubmapId reference_id;
  SubmapId query_id;
  OccupancyGrid reference_grid;
  OccupancyGrid query_grid;
  MapState map;
  // None where the query is of the same map.
  std::optional<MapState> query_map;
};

absl::StatusOr<SubmapPair> ReadPair(const SubmapId& reference_id,
                                    const SubmapId& query_id,
                                    const ProgressCallback& on_progress) {
  const bool has_query = !FLAGS_query.empty();
  std::map<SubmapId, OccupancyGrid> reference_grids, query_grids;
  std::set<SubmapId> wanted = {reference_id};
  if (!has_query) wanted.insert(query_id);
  absl::StatusOr<MapState> map =
      ReadWithGrid(FLAGS_input, wanted, &reference_grids, on_progress);
  if (!map.ok()) return map.status();
  std::optional<MapState> query_map;
  if (has_query) {
    absl::StatusOr<MapState> read =
        ReadWithGrid(FLAGS_query, {query_id}, &query_grids, on_progress);
    if (!read.ok()) return read.status();
    query_map = *std::move(read);
  }
  return SubmapPair{reference_id,
                    query_id,
                    reference_grids.at(reference_id),
                    (has_query ? query_grids : reference_grids).at(query_id),
                    *std::move(map),
                    std::move(query_map)};
}

absl::StatusOr<Match> MatchPair(const LoopClosingOptions& stages,
                                const SubmapPair& pair) {
  std::optional<Place> reference =
      DescribePlace(stages.place, pair.reference_id, pair.reference_grid);
  std::optional<Place> query =
      DescribePlace(stages.place, pair.query_id, pair.query_grid);
  std::optional<Match> match;
  if (reference && query) {
    if (stages.recognition.match.method == Method::kSdf) {
      FindSelfSimilarities(stages.recognition.match, &*reference);
      FindSelfSimilarities(stages.recognition.match, &*query);
    }
    match = MatchPlaces(stages.recognition.match, *reference, *query);
  }
  if (!match) {
    return absl::NotFoundError(
        absl::StrCat("submaps ", pair.reference_id.trajectory, ",",
                     pair.reference_id.index, " and ", pair.query_id.trajectory,
                     ",", pair.query_id.index, " do not match"));
  }
  return *std::move(match);
}

// Draws all submaps of the map at --input.
absl::Status PaintInput(const PoseGraph& pose_graph,
                        const ProgressCallback& on_progress,
                        MapPainter* const painter) {
  return ReadMap(FLAGS_input,
                 {[&](const SubmapId& id, const SubmapSummary&,
                      const OccupancyGrid& grid) {
                   const auto pose = pose_graph.submap_poses.find(id);
                   if (pose != pose_graph.submap_poses.end()) {
                     painter->AddSubmap(grid, pose->second);
                   }
                 }},
                 on_progress)
      .status();
}

// Within one map, both lie where the map has them: the lines show by how much
// it is off. Another session is put where the match says.
absl::StatusOr<Picture> DrawPairOnMap(const FieldOptions& field,
                                      const SubmapPair& pair,
                                      const Rigid2& T_reference_query,
                                      const std::vector<PointPair>& inliers,
                                      const ProgressCallback& on_progress) {
  const PoseGraph& pose_graph = pair.map.pose_graph;
  const Rigid2 T_map_reference = pose_graph.submap_poses.at(pair.reference_id);
  const Rigid2 T_map_query = pair.query_map
                                 ? T_map_reference * T_reference_query
                                 : pose_graph.submap_poses.at(pair.query_id);
  std::vector<PlacedGrid> grids = PlaceGrids(pair.map);
  std::vector<ShownPath> paths = Paths(pose_graph, Rigid2(), false);
  if (pair.query_map) {
    const PoseGraph& query_graph = pair.query_map->pose_graph;
    const Rigid2 T_map_other =
        T_map_query * query_graph.submap_poses.at(pair.query_id).Inverse();
    for (ShownPath& path : Paths(query_graph, T_map_other, true)) {
      paths.push_back(std::move(path));
    }
    grids.push_back({pair.query_grid.geometry, T_map_query});
  }
  MapPainter painter(grids, 2 * FLAGS_figure_pixels);
  const absl::Status status = PaintInput(pose_graph, on_progress, &painter);
  if (!status.ok()) return status;
  const ShownMatch shown{
      {*MakeDistanceField(field, pair.reference_grid), T_map_reference},
      {*MakeDistanceField(field, pair.query_grid), T_map_query},
      inliers};
  return DrawMatchOnMap(painter, paths, shown);
}

absl::Status DrawMatch(const MethodOptions& method, Output* const output) {
  const absl::StatusOr<std::pair<SubmapId, SubmapId>> chosen =
      ChooseMatch(!FLAGS_query.empty());
  if (!chosen.ok()) return chosen.status();
  Progress progress("draw a match");
  const absl::StatusOr<SubmapPair> pair =
      ReadPair(chosen->first, chosen->second, progress.Callback());
  if (!pair.ok()) return pair.status();
  const LoopClosingOptions& stages = method.options.loop_closing;
  const absl::StatusOr<Match> match = MatchPair(stages, *pair);
  if (!match.ok()) return match.status();
  const Rigid2& T_reference_query = match->pair.T_reference_query;
  std::vector<PointPair> inliers;
  for (const auto& inlier : match->inliers) {
    inliers.push_back({inlier.first, inlier.second});
  }
  output->Write("match_pair.png",
                DrawMatchedPair(pair->reference_grid, pair->query_grid,
                                T_reference_query, inliers, FLAGS_figure_pixels)
                    .EncodePng());
  const absl::StatusOr<Picture> on_map =
      DrawPairOnMap(stages.place.field, *pair, T_reference_query, inliers,
                    progress.Callback());
  if (!on_map.ok()) return on_map.status();
  output->Write("match_map.png", on_map->EncodePng());
  return absl::OkStatus();
}

absl::StatusOr<DescribedGrid> ReadSubmap(const PlaceOptions& options) {
  std::optional<SubmapId> wanted;
  if (!FLAGS_submap.empty()) {
    const absl::StatusOr<std::vector<int>> ids =
        ParseIds("submap", FLAGS_submap, 2);
    if (!ids.ok()) return ids.status();
    wanted = SubmapId{(*ids)[0], (*ids)[1]};
  }
  Progress progress("read");
  std::optional<DescribedGrid> best;
  const absl::StatusOr<MapState> state = ReadMap(
      FLAGS_input,
      {[&](const SubmapId& id, const SubmapSummary&,
           const OccupancyGrid& grid) {
        if (wanted && id != *wanted) return;
        std::optional<DescribedGrid> described = DescribeGrid(options, grid);
        if (described && (!best || described->features.features.size() >
                                       best->features.features.size())) {
          best = std::move(described);
        }
      }},
      progress.Callback());
  if (!state.ok()) return state.status();
  if (!best) {
    return absl::NotFoundError(
        wanted ? absl::StrCat(FLAGS_input, " has no submap ", FLAGS_submap,
                              " with walls")
               : absl::StrCat(FLAGS_input, " has no submap with walls"));
  }
  return *std::move(best);
}

absl::Status RunFigures() {
  if (FLAGS_figure_pixels < 16 || FLAGS_figure_pixels > 8192) {
    return UsageError("--figure_pixels must be from 16 to 8192");
  }
  const bool has_match = !FLAGS_matches.empty() || !FLAGS_figure_pair.empty();
  if (!FLAGS_query.empty() && !has_match) {
    return UsageError("--query needs --matches or --figure_pair");
  }
  const absl::StatusOr<MethodOptions> method =
      LoadOptionsOfMethod(FLAGS_method);
  if (!method.ok()) return method.status();
  if (method->describes_clouds) {
    return UsageError("figures are of method sdf or paper");
  }
  const PlaceOptions& place = method->options.loop_closing.place;
  const absl::StatusOr<DescribedGrid> submap = ReadSubmap(place);
  if (!submap.ok()) return submap.status();
  Output output;
  absl::Status status = output.Open();
  if (!status.ok()) return status;
  DrawSubmap(place, *submap, &output);
  if (has_match) {
    status = DrawMatch(*method, &output);
    if (!status.ok()) return status;
  }
  if (!output.status().ok()) return output.status();
  for (const std::string& path : output.paths()) std::cout << path << "\n";
  return absl::OkStatus();
}

}  // namespace

Subcommand Figures() {
  return Subcommand{
      "figures",
      "pictures of a map's features, and of a match",
      "--input A.pbstream [--query B.pbstream] [--submap 0,12] "
      "[--matches M.csv] --output DIR",
      "Draws one submap: its probability grid (grid.png) and distance field "
      "(field.png, with keypoints in keypoints.png, as a surface in "
      "surface.png), where features within some distance of walls may lie "
      "(mask_*.png), and one feature: where it is (feature_location.png), the "
      "weighted gradients around it (feature_window.png) and its descriptor "
      "(feature_histogram.svg). Maxima are red, saddles green, minima "
      "yellow.\n\n"
      "With --matches or --figure_pair, also one match: both submaps on the "
      "map "
      "with the paths of the robot (match_map.png; reference blue, query red, "
      "features that agree black) and laid over each other (match_pair.png).",
      {"input", "output"},
      {"query", "submap", "matches", "figure_pair", "method", "figure_pixels",
       "configuration_directory", "configuration_basename"},
      &RunFigures};
}

}  // namespace cartographer_sdf
