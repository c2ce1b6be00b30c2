// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// `figures`: the pictures of the paper, for any map.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/file/whole_file.h"
#include "cartographer_sdf/report/feature_pictures.h"
#include "cartographer_sdf/report/match_table.h"
#include "cartographer_sdf/report/reports.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/method_options.h"
#include "cartographer_sdf/tools/progress.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "cartographer_sdf/tools/submap_flag.h"

DECLARE_string(matches);
DECLARE_string(method);

DEFINE_int32(figure_pixels, 700, "Longer side of the pictures [pixels].");

namespace cartographer_sdf {
namespace {

constexpr double kMaskClearances[] = {2., 1.5, 1., 0.5};  // [m], Fig. 6

absl::StatusOr<std::optional<SubmapId>> SubmapOfFlags() {
  if (FLAGS_submap.empty()) return std::nullopt;
  const absl::StatusOr<SubmapId> id = ParseSubmap("submap", FLAGS_submap);
  if (!id.ok()) return id.status();
  return *id;
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

// Names and contents of files.
using Pictures = std::vector<std::pair<std::string, std::string>>;

// Chooses a strong feature in the middle of a room: the strongest maximum whose
// window holds no wall, or else the strongest feature.
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

Pictures DrawSubmap(const PlaceOptions& options, const DescribedGrid& submap) {
  const int pixels = FLAGS_figure_pixels;
  const std::vector<Feature>& features = submap.features.features;
  const auto draw_field = [&](const std::vector<Feature>& marked) {
    return DrawDistanceField(submap.field, marked, pixels).EncodePng();
  };
  Pictures pictures = {
      {"grid.png", DrawOccupancyGrid(submap.grid, pixels).EncodePng()},
      {"field.png", draw_field({})},
      {"keypoints.png", draw_field(features)},
      {"surface.png",
       DrawFieldSurface(submap.field, features, pixels).EncodePng()}};
  for (const double clearance : kMaskClearances) {
    pictures.emplace_back(
        absl::StrFormat("mask_%.1fm.png", clearance),
        DrawClearanceMask(submap.field, clearance, pixels).EncodePng());
  }
  if (features.empty()) return pictures;
  const size_t chosen = ChooseFeature(options.descriptor, submap.features);
  pictures.emplace_back("feature_location.png", draw_field({features[chosen]}));
  pictures.emplace_back(
      "feature_window.png",
      DrawFeatureWindow(options.descriptor, submap.field, submap.smoothed,
                        features[chosen], pixels)
          .EncodePng());
  pictures.emplace_back(
      "feature_histogram.svg",
      StandaloneSvg(RenderDescriptor(
          submap.features.descriptors.col(static_cast<Eigen::Index>(chosen)))));
  return pictures;
}

// Chooses the accepted match of submaps farthest apart along one trajectory, or
// the best accepted match of two maps.
absl::StatusOr<MatchRow> ChooseMatch() {
  absl::StatusOr<std::vector<MatchRow>> matches = ReadMatches(FLAGS_matches);
  if (!matches.ok()) return matches.status();
  const auto rank = [](const MatchRow& match) {
    const int gap = !FLAGS_query.empty() ||
                            match.reference.trajectory != match.query.trajectory
                        ? 0
                        : std::abs(match.query.index - match.reference.index);
    return std::make_pair(gap, match.score);
  };
  matches->erase(
      std::remove_if(matches->begin(), matches->end(),
                     [](const MatchRow& match) { return !match.accepted; }),
      matches->end());
  if (matches->empty()) {
    return absl::NotFoundError(
        absl::StrCat(FLAGS_matches, " has no accepted match"));
  }
  return *std::max_element(matches->begin(), matches->end(),
                           [&rank](const MatchRow& a, const MatchRow& b) {
                             return rank(a) < rank(b);
                           });
}

// A map with all its grids.
struct LoadedMap {
  MapState state;
  std::map<SubmapId, OccupancyGrid> grids;
};

absl::StatusOr<LoadedMap> LoadMap(const std::string& path,
                                  StageProgress* const progress) {
  LoadedMap map;
  absl::StatusOr<MapState> state = ReadMap(
      path,
      {[&map](const SubmapId& id, const SubmapSummary&,
              const OccupancyGrid& grid) { map.grids.emplace(id, grid); }},
      progress->Begin("read"));
  progress->End();
  if (!state.ok()) return state.status();
  map.state = *std::move(state);
  return map;
}

absl::Status CheckHas(const std::string& path, const LoadedMap& map,
                      const SubmapId& id) {
  if (map.grids.count(id) > 0 &&
      map.state.pose_graph.submap_poses.count(id) > 0) {
    return absl::OkStatus();
  }
  return absl::NotFoundError(
      absl::StrCat(path, " has no submap ", id.trajectory, ",", id.index));
}

absl::StatusOr<Match> MatchPair(const LoopClosingOptions& stages,
                                const MatchRow& pair,
                                const OccupancyGrid& reference_grid,
                                const OccupancyGrid& query_grid) {
  std::optional<Place> reference =
      DescribePlace(stages.place, pair.reference, reference_grid);
  std::optional<Place> query =
      DescribePlace(stages.place, pair.query, query_grid);
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
        absl::StrCat("submaps ", pair.reference.trajectory, ",",
                     pair.reference.index, " and ", pair.query.trajectory, ",",
                     pair.query.index, " do not match"));
  }
  return *std::move(match);
}

// Within one map, both submaps keep their poses in the map: the lines show the
// map's error. A submap of another map is placed by the match.
Picture DrawPairOnMap(const FieldOptions& field, const LoadedMap& map,
                      const LoadedMap& query_map, const Match& match) {
  const PoseGraph& pose_graph = map.state.pose_graph;
  const SubmapId& query_id = match.pair.query;
  const OccupancyGrid& query_grid = query_map.grids.at(query_id);
  const ShownSubmap reference{
      *MakeDistanceField(field, map.grids.at(match.pair.reference)),
      pose_graph.submap_poses.at(match.pair.reference), PathsOf(pose_graph)};
  ShownSubmap query{*MakeDistanceField(field, query_grid),
                    reference.T_map_submap * match.pair.T_reference_query,
                    {}};
  std::vector<PlacedGrid> grids = PlaceGrids(map.state, pose_graph);
  if (&map == &query_map) {
    query.T_map_submap = pose_graph.submap_poses.at(query_id);
  } else {
    const PoseGraph& query_graph = query_map.state.pose_graph;
    const Rigid2 T_map_other =
        query.T_map_submap * query_graph.submap_poses.at(query_id).Inverse();
    query.paths = PathsOf(query_graph);
    for (auto& [trajectory, path] : query.paths) {
      for (Eigen::Vector2d& position : path) position = T_map_other * position;
    }
    grids.push_back({query_grid.geometry, query.T_map_submap});
  }
  MapPainter painter(grids, 2 * FLAGS_figure_pixels);
  for (const auto& [id, grid] : map.grids) {
    const auto pose = pose_graph.submap_poses.find(id);
    if (pose == pose_graph.submap_poses.end()) continue;
    painter.AddSubmap(grid, pose->second);
  }
  return DrawMatchOnMap(painter, reference, query, match.inliers);
}

absl::Status DrawMatch(const LoopClosingOptions& stages, const LoadedMap& map,
                       StageProgress* const progress,
                       Pictures* const pictures) {
  const absl::StatusOr<MatchRow> chosen = ChooseMatch();
  if (!chosen.ok()) return chosen.status();
  absl::Status status = CheckHas(FLAGS_input, map, chosen->reference);
  if (!status.ok()) return status;
  std::optional<LoadedMap> other;
  if (!FLAGS_query.empty()) {
    absl::StatusOr<LoadedMap> loaded = LoadMap(FLAGS_query, progress);
    if (!loaded.ok()) return loaded.status();
    other = *std::move(loaded);
  }
  const LoadedMap& query_map = other ? *other : map;
  status =
      CheckHas(other ? FLAGS_query : FLAGS_input, query_map, chosen->query);
  if (!status.ok()) return status;
  const OccupancyGrid& reference_grid = map.grids.at(chosen->reference);
  const OccupancyGrid& query_grid = query_map.grids.at(chosen->query);
  const absl::StatusOr<Match> match =
      MatchPair(stages, *chosen, reference_grid, query_grid);
  if (!match.ok()) return match.status();
  pictures->emplace_back(
      "match_pair.png",
      DrawMatchedPair(reference_grid, query_grid, match->pair.T_reference_query,
                      match->inliers, FLAGS_figure_pixels)
          .EncodePng());
  pictures->emplace_back(
      "match_map.png",
      DrawPairOnMap(stages.place.field, map, query_map, *match).EncodePng());
  return absl::OkStatus();
}

absl::StatusOr<DescribedGrid> DescribeSubmap(const PlaceOptions& options,
                                             const LoadedMap& map) {
  const absl::StatusOr<std::optional<SubmapId>> wanted = SubmapOfFlags();
  if (!wanted.ok()) return wanted.status();
  std::optional<DescribedGrid> best;
  for (const auto& [id, grid] : map.grids) {
    if (*wanted && id != **wanted) continue;
    std::optional<DescribedGrid> described = DescribeGrid(options, grid);
    if (described && (!best || described->features.features.size() >
                                   best->features.features.size())) {
      best = std::move(described);
    }
  }
  if (!best) {
    return absl::NotFoundError(
        absl::StrCat(FLAGS_input, " has no submap ", FLAGS_submap,
                     FLAGS_submap.empty() ? "" : " ", "with walls"));
  }
  return *std::move(best);
}

absl::Status WritePictures(const Pictures& pictures, RunRecord* const record) {
  std::error_code error;
  std::filesystem::create_directories(FLAGS_output, error);
  if (!std::filesystem::is_directory(FLAGS_output, error)) {
    return absl::UnavailableError(
        absl::StrCat("cannot make the directory ", FLAGS_output));
  }
  Json names = Json::array();
  for (const auto& [name, content] : pictures) {
    names.push_back(name);
    const std::string path = absl::StrCat(FLAGS_output, "/", name);
    const absl::Status status = WriteWholeFile(path, content);
    if (!status.ok()) return status;
    std::cout << path << "\n";
  }
  record->Count("pictures", pictures.size());
  record->answer["pictures"] = std::move(names);
  return absl::OkStatus();
}

absl::Status RunFigures(RunRecord* const record) {
  if (FLAGS_figure_pixels < 16 || FLAGS_figure_pixels > 8192) {
    return UsageError("--figure_pixels must be from 16 to 8192");
  }
  if (!FLAGS_query.empty() && FLAGS_matches.empty()) {
    return UsageError("--query needs --matches");
  }
  const absl::StatusOr<MethodOptions> method =
      LoadOptionsOfMethod(FLAGS_method);
  if (!method.ok()) return method.status();
  if (method->describes_clouds) {
    return UsageError("figures are of method sdf or paper");
  }
  const LoopClosingOptions& stages = method->options.loop_closing;
  StageProgress progress(record);
  const absl::StatusOr<LoadedMap> map = LoadMap(FLAGS_input, &progress);
  if (!map.ok()) return map.status();
  const absl::StatusOr<DescribedGrid> submap =
      DescribeSubmap(stages.place, *map);
  if (!submap.ok()) return submap.status();
  Pictures pictures = DrawSubmap(stages.place, *submap);
  if (!FLAGS_matches.empty()) {
    const absl::Status status = DrawMatch(stages, *map, &progress, &pictures);
    if (!status.ok()) return status;
  }
  return WritePictures(pictures, record);
}

}  // namespace

// Long: a description, with all flags.
Subcommand Figures() {
  Subcommand subcommand{
      "figures",
      "draw a map's features, and a match",
      "A.pbstream --output DIR [--query B.pbstream] [--submap 0,12] "
      "[--matches M.csv]",
      "Draws one submap: its probability grid (grid.png) and distance field "
      "(field.png, with keypoints in keypoints.png, as a surface in "
      "surface.png), the areas within some distances of walls (mask_*.png), "
      "and one feature: its location (feature_location.png), the weighted "
      "gradients around it (feature_window.png) and its descriptor "
      "(feature_histogram.svg). Maxima are red, saddles green, minima "
      "yellow.\n\n"
      "With --matches, also draws one accepted match (with --query, the best; "
      "otherwise that of submaps farthest apart along one trajectory): both "
      "submaps on the map with the paths of the robot (match_map.png; "
      "reference blue, query red, features that agree black) and laid over "
      "each other (match_pair.png).",
      {{"input", FileUse::kRead},
       {"output",
        FileUse::kWriteInto,
        {},
        "Directory to write the pictures to, made if it is missing."}},
      {{"query",
        FileUse::kRead,
        {},
        "Second map, that of the queries of --matches."},
       "submap",
       {"matches",
        FileUse::kRead,
        {},
        "Matches, as `match` writes them; one of them is drawn."},
       "method",
       "figure_pixels",
       "configuration_directory",
       "configuration_basename"},
      &RunFigures};
  subcommand.positional_flags = {"input"};
  return subcommand;
}

}  // namespace cartographer_sdf
