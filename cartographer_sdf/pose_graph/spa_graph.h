// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The least-squares problem of a pose graph, flattened: poses and relative
// measurements between them ("sparse pose adjustment" [Konolige2010], with the
// measurements that Cartographer uses in 2D).

#ifndef CARTOGRAPHER_SDF_POSE_GRAPH_SPA_GRAPH_H_
#define CARTOGRAPHER_SDF_POSE_GRAPH_SPA_GRAPH_H_

#include <Eigen/Core>
#include <cstddef>
#include <set>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/pose_graph/optimization.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

// A measured pose of `end` in the frame of `start`, both indices into
// SpaGraph::poses.
struct SpaEdge {
  int start = 0;
  int end = 0;
  Rigid2 T_start_end;
  double translation_weight = 0.;
  double rotation_weight = 0.;
  // Whether the Huber loss applies: to inter-submap constraints and to what
  // holds the two sides of a slip together (slips.h).
  bool robust = false;
};

struct SpaGraph {
  // (x, y, yaw) in the map frame: the submaps in order, then the nodes. The yaw
  // is not normalised.
  std::vector<Eigen::Vector3d> poses;
  // Fixed poses: those of frozen trajectories and, in each connected component
  // without one, the first submap (the first node if it has no submap).
  std::vector<bool> constant;
  std::vector<SpaEdge> edges;
  size_t num_slips = 0;
};

[[nodiscard]] SpaGraph BuildSpaGraph(const OptimizationOptions& options,
                                     const std::set<int>& frozen_trajectories,
                                     const PoseGraph& pose_graph);

// Deviation of an edge's end from the measurement: the residual is
// (w_t * (R_start^T (t_end - t_start) - t_measured),
//  w_r * (yaw_end - yaw_start - yaw_measured), in w_r * (-pi, pi]).
struct SpaError {
  Eigen::Vector3d residual;
  // Derivatives of the residual with respect to each pose.
  Eigen::Matrix3d jacobian_start;
  Eigen::Matrix3d jacobian_end;
};
[[nodiscard]] SpaError EvaluateSpaError(const SpaEdge& edge,
                                        const Eigen::Vector3d& start,
                                        const Eigen::Vector3d& end);

// Returns half the sum of squared residuals, robust ones under the Huber loss.
[[nodiscard]] double SpaCost(const SpaGraph& graph, double huber_scale);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_POSE_GRAPH_SPA_GRAPH_H_
