// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/submap_cloud.h"

#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Beyond it, no raster can tell points apart [m].
constexpr double kMaxPointCoordinate = 1e6;

// The first and the last, and others evenly between.
std::vector<NodeId> Thin(const std::set<NodeId>& nodes, const int max_size) {
  const std::vector<NodeId> all(nodes.begin(), nodes.end());
  const size_t size = static_cast<size_t>(max_size);
  if (all.size() <= size) return all;
  std::vector<NodeId> thinned;
  for (size_t k = 0; k < size; ++k) {
    thinned.push_back(all[size == 1 ? 0 : k * (all.size() - 1) / (size - 1)]);
  }
  return thinned;
}

}  // namespace

std::string Validate(const SubmapCloudOptions& options) {
  if (options.max_num_scans < 1) return "max_num_scans must be positive";
  if (!(options.voxel_size_meters >= 0.005 &&
        options.voxel_size_meters <= 10.)) {
    return "voxel_size_meters must lie between 0.005 and 10";
  }
  return "";
}

SubmapCloud DownsampleCloud(const SubmapCloud& cloud, const double voxel_size) {
  struct Sum {
    Eigen::Vector2d position = Eigen::Vector2d::Zero();
    int count = 0;
  };
  std::map<std::pair<int64_t, int64_t>, Sum> voxels;
  for (const Eigen::Vector2d& point : cloud) {
    if (!(point.cwiseAbs().maxCoeff() < kMaxPointCoordinate)) continue;
    Sum& sum =
        voxels[{static_cast<int64_t>(std::floor(point.x() / voxel_size)),
                static_cast<int64_t>(std::floor(point.y() / voxel_size))}];
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
  std::map<SubmapId, std::set<NodeId>> inserted;
  for (const Constraint& constraint : pose_graph.constraints) {
    if (constraint.tag == Constraint::Tag::kIntraSubmap) {
      inserted[constraint.submap].insert(constraint.node);
    }
  }
  std::map<SubmapId, std::vector<NodeId>> chosen;
  std::set<NodeId> all;
  for (const auto& [submap, nodes] : inserted) {
    chosen[submap] = Thin(nodes, options.max_num_scans);
    all.insert(chosen[submap].begin(), chosen[submap].end());
  }
  const absl::StatusOr<std::map<NodeId, PointCloud2>> scans =
      ReadPointClouds(path, all, on_progress);
  if (!scans.ok()) return scans.status();
  std::map<SubmapId, SubmapCloud> clouds;
  for (const auto& [submap, nodes] : chosen) {
    const auto T_map_submap = pose_graph.submap_poses.find(submap);
    if (T_map_submap == pose_graph.submap_poses.end()) continue;
    SubmapCloud cloud;
    for (const NodeId& id : nodes) {
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
