// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pose_graph/spa_graph.h"

#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <utility>

#include "cartographer_sdf/pose_graph/slips.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

Eigen::Vector3d ToVector(const Rigid2& pose) {
  return {pose.translation().x(), pose.translation().y(), pose.rotation()};
}

void AddConstraints(const PoseGraph& pose_graph, const Slips& slips,
                    const std::map<SubmapId, int>& submap_indices,
                    const std::map<NodeId, int>& node_indices,
                    SpaGraph* const graph) {
  const std::set<SubmapId> slipped = SubmapsWithSlips(slips, pose_graph);
  for (const Constraint& constraint : pose_graph.constraints) {
    const auto submap = submap_indices.find(constraint.submap);
    const auto node = node_indices.find(constraint.node);
    CHECK(submap != submap_indices.end() && node != node_indices.end())
        << "constraint of submap " << constraint.submap << " and node "
        << constraint.node << ", which are not both in the graph";
    const bool robust = constraint.tag == Constraint::Tag::kInterSubmap ||
                        slipped.count(constraint.submap) != 0;
    graph->edges.push_back(SpaEdge{
        submap->second, node->second, constraint.T_submap_node,
        constraint.translation_weight, constraint.rotation_weight, robust});
  }
}

OdometryWeights WeightsOf(const OptimizationOptions& options,
                          const PoseGraph& pose_graph, const int trajectory) {
  const auto own = pose_graph.odometry_weights.find(trajectory);
  if (own != pose_graph.odometry_weights.end()) return own->second;
  return {options.odometry_translation_weight,
          options.odometry_rotation_weight};
}

// Adds edges between consecutive nodes, none across a trimmed node; as in the
// host, none for frozen trajectories.
void AddConsecutiveNodes(const OptimizationOptions& options,
                         const PoseGraph& pose_graph, const Slips& slips,
                         const int first_index, SpaGraph* const graph) {
  int index = first_index;
  const std::pair<const NodeId, Node>* previous = nullptr;
  for (const auto& current : pose_graph.nodes) {
    if (previous != nullptr &&
        previous->first.trajectory == current.first.trajectory &&
        previous->first.index + 1 == current.first.index &&
        !graph->constant[index]) {
      const Node& node = current.second;
      const bool robust = slips.count(current.first) != 0;
      if (node.T_previous_node_by_odometry.has_value()) {
        const OdometryWeights weights =
            WeightsOf(options, pose_graph, current.first.trajectory);
        graph->edges.push_back(
            SpaEdge{index - 1, index, *node.T_previous_node_by_odometry,
                    weights.translation, weights.rotation, robust});
      }
      if (previous->second.T_local_node.has_value() &&
          node.T_local_node.has_value()) {
        graph->edges.push_back(SpaEdge{
            index - 1, index,
            previous->second.T_local_node->Inverse() * *node.T_local_node,
            options.local_slam_pose_translation_weight,
            options.local_slam_pose_rotation_weight, robust});
      }
    }
    previous = &current;
    ++index;
  }
}

// Fixes one pose of each connected component that has no constant one.
void FixGauge(SpaGraph* const graph) {
  std::vector<int> parents(graph->poses.size());
  std::iota(parents.begin(), parents.end(), 0);
  const auto root = [&parents](int index) {
    while (parents[index] != index) {
      parents[index] = parents[parents[index]];
      index = parents[index];
    }
    return index;
  };
  for (const SpaEdge& edge : graph->edges) {
    parents[root(edge.start)] = root(edge.end);
  }
  std::vector<bool> fixed(graph->poses.size(), false);
  for (size_t i = 0; i != graph->poses.size(); ++i) {
    if (graph->constant[i]) {
      fixed[root(static_cast<int>(i))] = true;
    }
  }
  for (size_t i = 0; i != graph->poses.size(); ++i) {
    const int component = root(static_cast<int>(i));
    if (!fixed[component]) {
      fixed[component] = true;
      graph->constant[i] = true;
    }
  }
}

}  // namespace

SpaGraph BuildSpaGraph(const OptimizationOptions& options,
                       const std::set<int>& frozen_trajectories,
                       const PoseGraph& pose_graph) {
  SpaGraph graph;
  const auto add_pose = [&](const int trajectory, const Rigid2& pose) {
    graph.poses.push_back(ToVector(pose));
    graph.constant.push_back(frozen_trajectories.count(trajectory) != 0);
    return static_cast<int>(graph.poses.size()) - 1;
  };
  std::map<SubmapId, int> submap_indices;
  for (const auto& [id, T_map_submap] : pose_graph.submap_poses) {
    submap_indices[id] = add_pose(id.trajectory, T_map_submap);
  }
  std::map<NodeId, int> node_indices;
  for (const auto& [id, node] : pose_graph.nodes) {
    node_indices[id] = add_pose(id.trajectory, node.T_map_node);
  }
  const Slips slips = FindSlips(options.min_slip_angle, pose_graph);
  graph.num_slips = slips.size();
  AddConstraints(pose_graph, slips, submap_indices, node_indices, &graph);
  AddConsecutiveNodes(options, pose_graph, slips,
                      static_cast<int>(pose_graph.submap_poses.size()), &graph);
  FixGauge(&graph);
  return graph;
}

SpaError EvaluateSpaError(const SpaEdge& edge, const Eigen::Vector3d& start,
                          const Eigen::Vector3d& end) {
  const double w_t = edge.translation_weight;
  const double w_r = edge.rotation_weight;
  const double c = std::cos(start.z());
  const double s = std::sin(start.z());
  const Eigen::Vector2d delta = end.head<2>() - start.head<2>();
  const Eigen::Vector2d p_start(c * delta.x() + s * delta.y(),
                                -s * delta.x() + c * delta.y());
  SpaError error;
  error.residual.head<2>() = w_t * (p_start - edge.T_start_end.translation());
  error.residual.z() =
      w_r * NormalizeAngle(end.z() - start.z() - edge.T_start_end.rotation());
  error.jacobian_end << w_t * c, w_t * s, 0.,  //
      -w_t * s, w_t * c, 0.,                   //
      0., 0., w_r;
  error.jacobian_start = -error.jacobian_end;
  // The derivative of R^T with respect to the angle turns p_start by -90
  // degrees.
  error.jacobian_start(0, 2) = w_t * p_start.y();
  error.jacobian_start(1, 2) = -w_t * p_start.x();
  return error;
}

double SpaCost(const SpaGraph& graph, const double huber_scale) {
  double cost = 0.;
  for (const SpaEdge& edge : graph.edges) {
    const double squared_norm =
        EvaluateSpaError(edge, graph.poses[edge.start], graph.poses[edge.end])
            .residual.squaredNorm();
    const double norm = std::sqrt(squared_norm);
    cost += edge.robust && norm > huber_scale
                ? huber_scale * (norm - 0.5 * huber_scale)
                : 0.5 * squared_norm;
  }
  return cost;
}

}  // namespace cartographer_sdf
