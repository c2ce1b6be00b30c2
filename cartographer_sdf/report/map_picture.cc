// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/map_picture.h"

#include <map>
#include <utility>

namespace cartographer_sdf {
namespace {

std::vector<PlacedGrid> Grids(const MapState& state,
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

}  // namespace

void DrawPaths(const PoseGraph& pose_graph, const PixelFrame& frame,
               Picture* const picture) {
  std::map<int, std::vector<Eigen::Vector2d>> paths;
  for (const auto& [id, node] : pose_graph.nodes) {
    paths[id.trajectory].push_back(node.T_map_node.translation());
  }
  for (const auto& [trajectory, path] : paths) {
    DrawTrajectory(path, frame, CategoryColor(trajectory), picture);
  }
}

std::map<SubmapId, Eigen::Vector2d> SubmapCentres(const PoseGraph& pose_graph) {
  std::map<SubmapId, std::pair<Eigen::Vector2d, int>> sums;
  for (const auto& [id, pose] : pose_graph.submap_poses) {
    sums[id] = {Eigen::Vector2d::Zero(), 0};
  }
  for (const Constraint& constraint : pose_graph.constraints) {
    if (constraint.tag != Constraint::Tag::kIntraSubmap) continue;
    auto& [sum, count] = sums[constraint.submap];
    sum += constraint.T_submap_node.translation();
    ++count;
  }
  std::map<SubmapId, Eigen::Vector2d> centres;
  for (const auto& [id, sum] : sums) {
    centres[id] = sum.second > 0 ? Eigen::Vector2d(sum.first / sum.second)
                                 : Eigen::Vector2d::Zero();
  }
  return centres;
}

MapPicture::MapPicture(const MapState& state, const PoseGraph& pose_graph,
                       const int max_pixels)
    : pose_graph_(pose_graph), painter_(Grids(state, pose_graph), max_pixels) {}

void MapPicture::AddSubmap(const SubmapId& id, const OccupancyGrid& grid) {
  const auto pose = pose_graph_.submap_poses.find(id);
  if (pose != pose_graph_.submap_poses.end()) {
    painter_.AddSubmap(grid, pose->second);
  }
}

ReportedPicture MapPicture::Finish(const std::string& caption,
                                   const std::vector<SubmapLink>& links) const {
  const std::map<SubmapId, Eigen::Vector2d> centres =
      SubmapCentres(pose_graph_);
  const auto place = [&](const SubmapId& id) {
    return pose_graph_.submap_poses.at(id) * centres.at(id);
  };
  Picture picture = painter_.Paint();
  const PixelFrame& frame = painter_.frame();
  DrawMetricGrid(frame, &picture);
  DrawPaths(pose_graph_, frame, &picture);
  for (const SubmapLink& link : links) {
    DrawLink(place(link.from), place(link.to), frame, link.color, &picture);
  }
  DrawScaleBar(frame, &picture);
  return {caption, picture.EncodePng()};
}

}  // namespace cartographer_sdf
