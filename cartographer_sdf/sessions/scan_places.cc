// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/sessions/scan_places.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "cartographer_sdf/simulation/submap_grid.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Of the file's times.
constexpr double kTicksPerSecond = 1e7;

// Weights of the host's defaults between a submap and its nodes; nobody
// optimises with them.
constexpr double kIntraTranslationWeight = 5e2;
constexpr double kIntraRotationWeight = 1.6e3;

// How far a place reaches from its first node, and a scan from its node [m]:
// grids stay of a size that fits into memory, whatever the file says.
constexpr double kMaxExtent = 50.;
constexpr float kMaxRange = 60.f;

// Clouds have no beams without an echo.
SubmapGridOptions GridOptions(const ScanPlaceOptions& options) {
  SubmapGridOptions grid;
  grid.resolution = options.resolution_meters;
  grid.hit_probability = options.hit_probability;
  grid.miss_probability = options.miss_probability;
  return grid;
}

bool IsIn(const TimeWindow& window, const int64_t begin, const int64_t time) {
  const double seconds =
      (static_cast<double>(time) - static_cast<double>(begin)) /
      kTicksPerSecond;
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

// By local SLAM, which does not jump.
const Rigid2& SmoothPose(const Node& node) {
  return node.T_local_node ? *node.T_local_node : node.T_map_node;
}

// Nodes of the places: runs of `size` that overlap by half; the last is
// shorter, unless the one before holds it already. A run that leads far away
// ends early.
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
                        const std::map<NodeId, Scan>& scans,
                        MapState* const map) {
  PoseGraph& graph = map->pose_graph;
  const Node& first = graph.nodes.at(nodes.front());
  // The tracking frame, as the file's own poses have it.
  const Rigid2 T_node_submap =
      Project2D(Rigid3::Rotation(first.gravity_alignment));
  std::vector<PosedScan> posed;
  for (const NodeId& node : nodes) {
    const Rigid2 T_submap_node = T_node_submap.Inverse() *
                                 SmoothPose(first).Inverse() *
                                 SmoothPose(graph.nodes.at(node));
    graph.constraints.push_back(
        Constraint{id, node, T_submap_node, kIntraTranslationWeight,
                   kIntraRotationWeight, Constraint::Tag::kIntraSubmap});
    posed.push_back({T_submap_node, &scans.at(node)});
  }
  graph.submap_poses[id] = first.T_map_node * T_node_submap;
  OccupancyGrid grid = BuildSubmapGrid(posed, GridOptions(options));
  SubmapSummary summary;
  summary.num_range_data = static_cast<int>(nodes.size());
  summary.T_local_submap = SmoothPose(first) * T_node_submap;
  summary.geometry = grid.geometry;
  summary.num_known_cells = static_cast<int>(grid.known.count());
  map->submaps[id] = summary;
  return grid;
}

}  // namespace

std::string Validate(const ScanPlaceOptions& options) {
  if (options.num_scans < 1 || options.num_scans > 100000) {
    return "num_scans must lie between 1 and 100000";
  }
  return Validate(GridOptions(options));
}

absl::StatusOr<ScanMap> DescribeScans(
    const ScanPlaceOptions& options, const PlaceOptions& place_options,
    const MatchOptions& match_options, const std::string& path,
    const MapState& map, const TimeWindow& window, const Executor& executor,
    const std::optional<std::set<int>>& trajectories) {
  CHECK_EQ(Validate(options), "");
  ScanMap scan_map;
  DescribedMap& result = scan_map.map;
  result.state.format_version = map.format_version;
  result.state.num_trajectories = map.num_trajectories;
  result.state.trajectories = map.trajectories;
  result.state.pose_graph.nodes = NodesIn(window, map.pose_graph.nodes);
  std::set<NodeId> ids;
  for (const auto& [id, node] : result.state.pose_graph.nodes) {
    if (!trajectories || trajectories->count(id.trajectory) > 0) ids.insert(id);
  }
  if (ids.empty()) return scan_map;
  const absl::StatusOr<std::map<NodeId, PointCloud2>> clouds =
      ReadPointClouds(path, ids);
  if (!clouds.ok()) return clouds.status();
  std::map<NodeId, Scan> scans;
  std::map<int, std::vector<NodeId>> nodes;
  for (const auto& [id, cloud] : *clouds) {
    std::vector<Eigen::Vector2f> returns;
    std::copy_if(
        cloud.begin(), cloud.end(), std::back_inserter(returns),
        [](const Eigen::Vector2f& point) { return point.norm() <= kMaxRange; });
    if (returns.empty()) continue;
    scans[id].returns = std::move(returns);
    nodes[id.trajectory].push_back(id);
  }
  std::vector<SubmapId> submaps;
  for (const auto& [trajectory, trajectory_nodes] : nodes) {
    for (const std::vector<NodeId>& group :
         GroupNodes(trajectory_nodes, static_cast<size_t>(options.num_scans),
                    result.state.pose_graph.nodes)) {
      submaps.push_back({trajectory, group.front().index});
      scan_map.grids.emplace(
          submaps.back(),
          AddSubmap(options, submaps.back(), group, scans, &result.state));
    }
  }
  std::vector<std::optional<Place>> places(submaps.size());
  executor(submaps.size(), [&](const size_t k) {
    places[k] =
        DescribePlace(place_options, submaps[k], scan_map.grids.at(submaps[k]));
    if (places[k]) FindSelfSimilarities(match_options, &*places[k]);
  });
  for (std::optional<Place>& place : places) {
    if (place) result.places.emplace(place->id, *std::move(place));
  }
  return scan_map;
}

}  // namespace cartographer_sdf
