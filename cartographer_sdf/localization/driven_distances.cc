// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/driven_distances.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace cartographer_sdf {
namespace {

// A loop closure is as uncertain as driving through half a submap [m].
constexpr double kClosureLength = 5.;
constexpr double kNoWay = std::numeric_limits<double>::infinity();

using Edges = std::vector<std::map<size_t, double>>;

void AddEdge(const size_t a, const size_t b, const double length,
             Edges* const edges) {
  if (a == b) return;
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
    const auto edge = (*edges)[from].emplace(to, length).first;
    edge->second = std::min(edge->second, length);
  }
}

Edges MakeEdges(const PoseGraph& pose_graph,
                const std::map<SubmapId, OdometryPose>& odometry,
                const std::map<SubmapId, size_t>& indices) {
  Edges edges(indices.size());
  const auto driven = [&odometry](const SubmapId& id) {
    const auto pose = odometry.find(id);
    return pose == odometry.end() ? 0. : pose->second.distance_driven;
  };
  const std::pair<const SubmapId, size_t>* previous = nullptr;
  for (const auto& current : indices) {
    if (previous != nullptr &&
        previous->first.trajectory == current.first.trajectory) {
      AddEdge(previous->second, current.second,
              std::abs(driven(current.first) - driven(previous->first)),
              &edges);
    }
    previous = &current;
  }
  // A constraint with a node relates its submap to those that contain the node.
  std::map<NodeId, std::vector<size_t>> holders;
  for (const Constraint& constraint : pose_graph.constraints) {
    const auto submap = indices.find(constraint.submap);
    if (constraint.tag == Constraint::Tag::kIntraSubmap &&
        submap != indices.end()) {
      holders[constraint.node].push_back(submap->second);
    }
  }
  for (const Constraint& constraint : pose_graph.constraints) {
    if (constraint.tag != Constraint::Tag::kInterSubmap) continue;
    const auto submap = indices.find(constraint.submap);
    const auto it = holders.find(constraint.node);
    if (submap == indices.end() || it == holders.end()) continue;
    for (const size_t holder : it->second) {
      AddEdge(submap->second, holder, kClosureLength, &edges);
    }
  }
  return edges;
}

// Dijkstra's algorithm.
void FindShortestWays(const Edges& edges, const size_t start,
                      double* const distances) {
  std::fill_n(distances, edges.size(), kNoWay);
  using Entry = std::pair<double, size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  queue.emplace(0., start);
  distances[start] = 0.;
  while (!queue.empty()) {
    const auto [distance, index] = queue.top();
    queue.pop();
    if (distance > distances[index]) continue;
    for (const auto& [neighbour, length] : edges[index]) {
      if (distance + length < distances[neighbour]) {
        distances[neighbour] = distance + length;
        queue.emplace(distances[neighbour], neighbour);
      }
    }
  }
}

}  // namespace

DrivenDistances::DrivenDistances(
    const PoseGraph& pose_graph,
    const std::map<SubmapId, OdometryPose>& odometry) {
  for (const auto& [id, pose] : pose_graph.submap_poses) {
    const size_t index = indices_.size();
    indices_[id] = index;
  }
  const Edges edges = MakeEdges(pose_graph, odometry, indices_);
  distances_.resize(edges.size() * edges.size());
  for (size_t start = 0; start < edges.size(); ++start) {
    FindShortestWays(edges, start, &distances_[start * edges.size()]);
  }
}

std::optional<double> DrivenDistances::Between(const SubmapId& a,
                                               const SubmapId& b) const {
  const double distance =
      distances_[indices_.at(a) * indices_.size() + indices_.at(b)];
  if (distance == kNoWay) return std::nullopt;
  return distance;
}

}  // namespace cartographer_sdf
