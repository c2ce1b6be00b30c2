// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/audit/node_scans.h"

#include <map>
#include <utility>
#include <vector>

namespace cartographer_sdf {
namespace {

std::vector<SurfacePoint> ToSurfacePoints(const PointCloud2& cloud) {
  std::vector<SurfacePoint> points;
  points.reserve(cloud.size());
  for (const Eigen::Vector2f& point : cloud) {
    points.push_back({point.cast<double>(), 1.});
  }
  return points;
}

}  // namespace

absl::StatusOr<ScansByNode> ReadScans(const std::string& path,
                                      const std::set<NodeId>& nodes,
                                      const ProgressCallback& on_progress) {
  ScansByNode scans;
  if (nodes.empty()) return scans;
  const absl::StatusOr<std::map<NodeId, PointCloud2>> clouds =
      ReadPointClouds(path, nodes, on_progress);
  if (!clouds.ok()) return clouds.status();
  for (const auto& [node, cloud] : *clouds) {
    if (!cloud.empty()) scans.emplace(node, ToSurfacePoints(cloud));
  }
  return scans;
}

}  // namespace cartographer_sdf
