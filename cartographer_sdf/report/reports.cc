// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/reports.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/report/submap_pictures.h"

namespace cartographer_sdf {
namespace {

int LayerOf(const MapPicture& map, const int trajectory) {
  return map.layers.empty() ? 0 : map.layers.at(trajectory);
}

std::vector<MapPainter> PaintersOf(const MapPicture& map,
                                   const int max_pixels) {
  int last = 0;
  for (const auto& [trajectory, layer] : map.layers) {
    last = std::max(last, layer);
  }
  return std::vector<MapPainter>(
      static_cast<size_t>(last) + 1,
      MapPainter(PlaceGrids(*map.state, *map.pose_graph), max_pixels));
}

void AddSubmap(const MapPicture& map, const SubmapId& id,
               const OccupancyGrid& grid,
               std::vector<MapPainter>* const painters) {
  const auto pose = map.pose_graph->submap_poses.find(id);
  if (map.state->submaps.count(id) > 0 &&
      pose != map.pose_graph->submap_poses.end()) {
    (*painters)[LayerOf(map, id.trajectory)].AddSubmap(grid, pose->second);
  }
}

// Mean position of each submap's nodes in the map frame; the submap's origin if
// it has none.
std::map<SubmapId, Eigen::Vector2d> SubmapCentres(const PoseGraph& pose_graph) {
  std::map<SubmapId, std::pair<Eigen::Vector2d, int>> sums;
  for (const Constraint& constraint : pose_graph.constraints) {
    if (constraint.tag != Constraint::Tag::kIntraSubmap) continue;
    auto& [sum, count] =
        sums.try_emplace(constraint.submap, Eigen::Vector2d::Zero(), 0)
            .first->second;
    sum += constraint.T_submap_node.translation();
    ++count;
  }
  std::map<SubmapId, Eigen::Vector2d> centres;
  for (const auto& [id, pose] : pose_graph.submap_poses) {
    const auto sum = sums.find(id);
    centres[id] = sum == sums.end()
                      ? pose.translation()
                      : pose * (sum->second.first / sum->second.second);
  }
  return centres;
}

void DrawLinks(const MapPicture& map,
               const std::vector<ReportedClosure>& closures,
               const PixelFrame& frame, Picture* const picture) {
  std::vector<SubmapLink> links = map.other_links;
  for (auto closure = closures.rbegin(); closure != closures.rend();
       ++closure) {
    if (!closure->link) continue;
    links.push_back({closure->match.pair.reference, closure->match.pair.query,
                     *closure->link});
  }
  const std::map<SubmapId, Eigen::Vector2d> centres =
      SubmapCentres(*map.pose_graph);
  for (const SubmapLink& link : links) {
    const auto from = centres.find(link.from);
    const auto to = centres.find(link.to);
    if (from == centres.end() || to == centres.end()) continue;
    DrawLink(from->second, to->second, frame, link.color, picture);
  }
}

Picture DrawMap(const MapPicture& map, const std::vector<MapPainter>& painters,
                const std::vector<ReportedClosure>& closures) {
  Picture picture =
      map.layers.empty() ? painters.front().Paint() : PaintOverlaid(painters);
  const PixelFrame& frame = painters.front().frame();
  DrawMetricGrid(frame, &picture);
  for (const auto& [trajectory, path] : PathsOf(*map.pose_graph)) {
    const int color =
        map.layers.empty() ? trajectory : LayerOf(map, trajectory);
    DrawTrajectory(path, frame, CategoryColor(color), &picture);
  }
  if (map.shows_links) DrawLinks(map, closures, frame, &picture);
  DrawScaleBar(frame, &picture);
  return picture;
}

// Empty if either submap has no grid.
std::string DrawPair(const Match& match,
                     const std::map<SubmapId, OccupancyGrid>& grids,
                     const int max_pixels) {
  const auto reference = grids.find(match.pair.reference);
  const auto query = grids.find(match.pair.query);
  if (reference == grids.end() || query == grids.end()) return "";
  return DrawMatchedPair(reference->second, query->second,
                         match.pair.T_reference_query, match.inliers,
                         max_pixels)
      .EncodePng();
}

}  // namespace

std::vector<PlacedGrid> PlaceGrids(const MapState& state,
                                   const PoseGraph& pose_graph) {
  std::vector<PlacedGrid> grids;
  for (const auto& [id, submap] : state.submaps) {
    const auto pose = pose_graph.submap_poses.find(id);
    if (pose != pose_graph.submap_poses.end()) {
      grids.push_back({submap.geometry, pose->second});
    }
  }
  return grids;
}

std::map<int, std::vector<Eigen::Vector2d>> PathsOf(
    const PoseGraph& pose_graph) {
  std::map<int, std::vector<Eigen::Vector2d>> paths;
  for (const auto& [id, node] : pose_graph.nodes) {
    paths[id.trajectory].push_back(node.T_map_node.translation());
  }
  return paths;
}

absl::Status DrawPictures(const std::vector<MapPicture>& maps,
                          const SubmapsReader& read_submaps,
                          const ReportOptions& options,
                          ReportContent* const content) {
  std::vector<ReportedClosure>& closures = content->closures;
  const size_t num_pairs = std::min(
      closures.size(), static_cast<size_t>(options.max_closure_pictures));
  if (num_pairs > 0) {
    content->num_undrawn = static_cast<int>(closures.size() - num_pairs);
  }
  std::set<SubmapId> wanted;
  for (size_t k = 0; k < num_pairs; ++k) {
    wanted.insert(closures[k].match.pair.reference);
    wanted.insert(closures[k].match.pair.query);
  }
  std::vector<std::vector<MapPainter>> painters;
  for (const MapPicture& map : maps) {
    painters.push_back(PaintersOf(map, options.map_picture_pixels));
  }
  std::map<SubmapId, OccupancyGrid> grids;
  const absl::Status status = read_submaps(
      [&](const SubmapId& id, const SubmapSummary&, const OccupancyGrid& grid) {
        for (size_t k = 0; k < maps.size(); ++k) {
          AddSubmap(maps[k], id, grid, &painters[k]);
        }
        if (wanted.count(id) > 0) grids.emplace(id, grid);
      });
  if (!status.ok()) return status;
  for (size_t k = 0; k < maps.size(); ++k) {
    content->maps.push_back(
        {maps[k].caption, DrawMap(maps[k], painters[k], closures).EncodePng()});
  }
  for (size_t k = 0; k < num_pairs; ++k) {
    closures[k].png =
        DrawPair(closures[k].match, grids, options.closure_picture_pixels);
  }
  return absl::OkStatus();
}

void SortByInterest(std::vector<ReportedClosure>* const closures) {
  std::stable_sort(closures->begin(), closures->end(),
                   [](const ReportedClosure& a, const ReportedClosure& b) {
                     return std::pair(a.accepted, a.match.pair.score) <
                            std::pair(b.accepted, b.match.pair.score);
                   });
}

std::string FileName(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

std::string FormatPose(const Rigid2& pose) {
  return absl::StrFormat("x %.3f m, y %.3f m, yaw %.2f deg",
                         pose.translation().x(), pose.translation().y(),
                         pose.rotation() * 180. / M_PI);
}

std::string FormatError(const ConstraintError& error) {
  return absl::StrFormat("%.2f m, %.1f deg", error.translation,
                         error.rotation * 180. / M_PI);
}

void AddOptimization(const OptimizationOptions& options,
                     const std::vector<OptimizationSummary>& summaries,
                     ReportContent* const content) {
  content->summary.emplace_back(
      "Odometry weights", absl::StrFormat("%.3g (translation), %.3g (rotation)",
                                          options.odometry_translation_weight,
                                          options.odometry_rotation_weight));
  if (summaries.empty()) return;
  const OptimizationSummary& last = summaries.back();
  content->summary.emplace_back(
      "Optimisation",
      absl::StrFormat("cost %.4g to %.4g in %d iterations, %d rounds",
                      last.initial_cost, last.final_cost, last.num_iterations,
                      summaries.size()));
  if (!last.converged) {
    content->warnings.push_back("The optimisation did not converge: " +
                                last.message);
  }
}

void AddTornSubmaps(const std::map<SubmapId, Tear>& torn_submaps,
                    ReportContent* const content) {
  for (const auto& [id, tear] : torn_submaps) {
    content->warnings.push_back(
        "A submap is torn inside; its closures have zero weight. " +
        DescribeTear(id, tear));
  }
}

}  // namespace cartographer_sdf
