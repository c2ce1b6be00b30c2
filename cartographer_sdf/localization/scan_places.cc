// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/scan_places.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "cartographer_sdf/grid/scan_grid.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Largest extent of a place from its first node, and of a scan from its node
// [m], so that grids fit into memory whatever the file contains.
constexpr double kMaxExtent = 50.;
constexpr double kMaxRange = 60.;

ScanGridOptions GridOptions(const ScanPlaceOptions& options) {
  ScanGridOptions grid;
  grid.resolution = options.resolution_meters;
  grid.hit_probability = options.hit_probability;
  grid.miss_probability = options.miss_probability;
  grid.max_range = kMaxRange;
  return grid;
}

bool IsIn(const TimeWindow& window, const int64_t begin, const int64_t time) {
  const double seconds =
      (static_cast<double>(time) - static_cast<double>(begin)) /
      static_cast<double>(kTicksPerSecond);
  return seconds >= window.start_seconds &&
         (!window.num_seconds ||
          seconds <= window.start_seconds + *window.num_seconds);
}

std::map<NodeId, Node> NodesIn(const TimeWindow& window,
                               const std::map<NodeId, Node>& nodes) {
  std::map<int, int64_t> begins;
  for (const auto& [id, node] : nodes) {
    const auto begin = begins.emplace(id.trajectory, node.time).first;
    begin->second = std::min(begin->second, node.time);
  }
  std::map<NodeId, Node> result;
  for (const auto& [id, node] : nodes) {
    if (IsIn(window, begins.at(id.trajectory), node.time)) {
      result.emplace(id, node);
    }
  }
  return result;
}

// Prefers the pose by local SLAM, which does not jump.
const Rigid2& SmoothPose(const Node& node) {
  return node.T_local_node ? *node.T_local_node : node.T_map_node;
}

// Groups nodes into places: runs of `size` that overlap by half. The last is
// shorter, unless the previous one already contains it. A run that leads too
// far away ends early.
std::vector<std::vector<NodeId>> GroupNodes(
    const std::vector<NodeId>& nodes, const size_t size,
    const std::map<NodeId, Node>& poses) {
  std::vector<std::vector<NodeId>> groups;
  size_t begin = 0;
  while (begin < nodes.size()) {
    const Eigen::Vector2d first =
        SmoothPose(poses.at(nodes[begin])).translation();
    size_t end = begin + 1;
    while (end < nodes.size() && end - begin < size &&
           (SmoothPose(poses.at(nodes[end])).translation() - first).norm() <=
               kMaxExtent) {
      ++end;
    }
    groups.emplace_back(nodes.begin() + static_cast<std::ptrdiff_t>(begin),
                        nodes.begin() + static_cast<std::ptrdiff_t>(end));
    if (end == nodes.size()) break;
    begin += (end - begin + 1) / 2;
  }
  return groups;
}

// Adds the submap and its constraints; returns its grid.
OccupancyGrid AddSubmap(const ScanPlaceOptions& options, const SubmapId& id,
                        const std::vector<NodeId>& nodes,
                        const std::map<NodeId, PointCloud2>& clouds,
                        MapState* const map) {
  PoseGraph& graph = map->pose_graph;
  const Node& first = graph.nodes.at(nodes.front());
  // The tracking frame, as the file's own poses have it.
  const Rigid2 T_node_submap =
      Project2D(Rigid3::Rotation(first.gravity_alignment));
  ScanGrid scan_grid(GridOptions(options));
  for (const NodeId& node : nodes) {
    const Rigid2 T_submap_node = T_node_submap.Inverse() *
                                 SmoothPose(first).Inverse() *
                                 SmoothPose(graph.nodes.at(node));
    graph.constraints.push_back(
        Constraint{id, node, T_submap_node, kIntraTranslationWeight,
                   kIntraRotationWeight, Constraint::Tag::kIntraSubmap});
    // Point clouds contain no beams without an echo.
    scan_grid.Insert(T_submap_node, {clouds.at(node), {}});
  }
  graph.submap_poses[id] = first.T_map_node * T_node_submap;
  OccupancyGrid grid = scan_grid.Crop();
  SubmapSummary summary;
  summary.num_range_data = static_cast<int>(nodes.size());
  summary.T_local_submap = SmoothPose(first) * T_node_submap;
  summary.geometry = grid.geometry;
  summary.num_known_cells = static_cast<int>(grid.known.count());
  map->submaps[id] = summary;
  return grid;
}

// Returns the nodes with scans, by trajectory.
std::map<int, std::vector<NodeId>> NodesWithScans(
    const std::map<NodeId, Node>& nodes,
    const std::map<NodeId, PointCloud2>& point_clouds) {
  std::map<int, std::vector<NodeId>> result;
  for (const auto& entry : nodes) {
    const auto cloud = point_clouds.find(entry.first);
    const bool has_near_points =
        cloud != point_clouds.end() &&
        std::any_of(cloud->second.begin(), cloud->second.end(),
                    [](const Eigen::Vector2f& point) {
                      return point.norm() <= kMaxRange;
                    });
    if (has_near_points) {
      result[entry.first.trajectory].push_back(entry.first);
    }
  }
  return result;
}

}  // namespace

std::string Validate(const ScanPlaceOptions& options) {
  if (options.num_scans < 1 || options.num_scans > 100000) {
    return "num_scans must lie between 1 and 100000";
  }
  return Validate(GridOptions(options));
}

ScanMap DescribeScans(const ScanPlaceOptions& options,
                      const PlaceOptions& place_options,
                      const MatchOptions& match_options,
                      const DescribedMap& map, const TimeWindow& window,
                      const Executor& executor,
                      const std::optional<std::set<int>>& trajectories) {
  CHECK_EQ(Validate(options), "");
  ScanMap scan_map;
  MapState& state = scan_map.map.state;
  state.format_version = map.state.format_version;
  state.trajectories = map.state.trajectories;
  state.pose_graph.nodes = NodesIn(window, map.state.pose_graph.nodes);
  for (const auto& [trajectory, nodes] :
       NodesWithScans(state.pose_graph.nodes, map.point_clouds)) {
    if (trajectories && trajectories->count(trajectory) == 0) continue;
    for (const std::vector<NodeId>& group :
         GroupNodes(nodes, static_cast<size_t>(options.num_scans),
                    state.pose_graph.nodes)) {
      const SubmapId id{trajectory, group.front().index};
      scan_map.grids.emplace(
          id, AddSubmap(options, id, group, map.point_clouds, &state));
    }
  }
  scan_map.map.odometry = OdometryPoses(state);
  scan_map.map.places =
      DescribePlaces(place_options, match_options, scan_map.grids, executor);
  return scan_map;
}

std::vector<OdometryScan> OdometryScansOf(const DescribedMap& map,
                                          const int trajectory) {
  std::vector<OdometryScan> scans;
  for (const auto& [id, node] : map.state.pose_graph.nodes) {
    const auto cloud = map.point_clouds.find(id);
    if (id.trajectory != trajectory || cloud == map.point_clouds.end()) {
      continue;
    }
    // (node <- robot)
    const Rigid2 T_node_robot =
        Project2D(Rigid3::Rotation(node.gravity_alignment));
    RobotScan scan;
    for (const Eigen::Vector2f& p_node : cloud->second) {
      scan.scan.returns.push_back(
          (T_node_robot.Inverse() * Eigen::Vector2d(p_node.cast<double>()))
              .cast<float>());
    }
    scans.push_back(
        {static_cast<double>(node.time) / static_cast<double>(kTicksPerSecond),
         SmoothPose(node) * T_node_robot,
         {std::move(scan)}});
  }
  return scans;
}

}  // namespace cartographer_sdf
