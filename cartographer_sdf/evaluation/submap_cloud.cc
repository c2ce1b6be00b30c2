// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/submap_cloud.h"

#include <cmath>
#include <set>

#include "cartographer_sdf/closing/constraint_generation.h"
#include "cartographer_sdf/geometry/number_range.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Beyond it, a raster cannot distinguish points [m].
constexpr double kMaxPointCoordinate = 1e6;

// The first and the last, and others evenly spaced between them.
InsertedNodes Thin(const InsertedNodes& nodes, const int max_size) {
  const std::vector<InsertedNodes::value_type> all(nodes.begin(), nodes.end());
  const size_t size = static_cast<size_t>(max_size);
  if (all.size() <= size) return nodes;
  InsertedNodes thinned;
  for (size_t k = 0; k < size; ++k) {
    thinned.insert(all[size == 1 ? 0 : k * (all.size() - 1) / (size - 1)]);
  }
  return thinned;
}

}  // namespace

std::string Validate(const SubmapCloudOptions& options) {
  return FirstOutside(
      {{"max_num_scans", options.max_num_scans, 1, 1e5},
       {"voxel_size_meters", options.voxel_size_meters, 0.005, 10.}});
}

Square SquareAt(const Eigen::Vector2d& point, const double side) {
  return {static_cast<int64_t>(std::floor(point.x() / side)),
          static_cast<int64_t>(std::floor(point.y() / side))};
}

PointRaster::PointRaster(const SubmapCloud& points, const double radius)
    : points_(points), side_(radius) {
  for (size_t k = 0; k < points.size(); ++k) {
    squares_[SquareAt(points[k], side_)].push_back(static_cast<int>(k));
  }
}

SubmapCloud DownsampleCloud(const SubmapCloud& cloud, const double voxel_size) {
  struct Sum {
    Eigen::Vector2d position = Eigen::Vector2d::Zero();
    int count = 0;
  };
  std::map<Square, Sum> voxels;
  for (const Eigen::Vector2d& point : cloud) {
    if (!(point.cwiseAbs().maxCoeff() < kMaxPointCoordinate)) continue;
    Sum& sum = voxels[SquareAt(point, voxel_size)];
    sum.position += point;
    ++sum.count;
  }
  SubmapCloud means;
  for (const auto& [cell, sum] : voxels) {
    means.emplace_back(sum.position / sum.count);
  }
  return means;
}

absl::StatusOr<std::map<SubmapId, SubmapCloud>> ReadSubmapClouds(
    const SubmapCloudOptions& options, const std::string& path,
    const PoseGraph& pose_graph, const ProgressCallback& on_progress) {
  CHECK_EQ(Validate(options), "");
  std::map<SubmapId, InsertedNodes> chosen = FindInsertedNodes(pose_graph);
  std::set<NodeId> all;
  for (auto& [submap, nodes] : chosen) {
    nodes = Thin(nodes, options.max_num_scans);
    for (const auto& [id, pose] : nodes) all.insert(id);
  }
  const absl::StatusOr<std::map<NodeId, PointCloud2>> scans =
      ReadPointClouds(path, all, on_progress);
  if (!scans.ok()) return scans.status();
  std::map<SubmapId, SubmapCloud> clouds;
  for (const auto& [submap, nodes] : chosen) {
    const auto T_map_submap = pose_graph.submap_poses.find(submap);
    if (T_map_submap == pose_graph.submap_poses.end()) continue;
    SubmapCloud cloud;
    for (const auto& [id, pose_by_local_slam] : nodes) {
      const auto scan = scans->find(id);
      const auto node = pose_graph.nodes.find(id);
      if (scan == scans->end() || node == pose_graph.nodes.end()) continue;
      const Rigid2 T_submap_node =
          T_map_submap->second.Inverse() * node->second.T_map_node;
      for (const Eigen::Vector2f& p_node : scan->second) {
        cloud.emplace_back(T_submap_node *
                           Eigen::Vector2d(p_node.cast<double>()));
      }
    }
    if (cloud.empty()) continue;
    clouds[submap] = DownsampleCloud(cloud, options.voxel_size_meters);
  }
  return clouds;
}

}  // namespace cartographer_sdf
