// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Cartographer's 2D pose graph optimisation [Hess2016, Sec. VI-A]: moves the
// poses of submaps and nodes (map frame, metres and radians) to a local minimum
// of the host's cost:
//
// - every constraint, with its own weights; inter-submap ones under the Huber
//   loss, which bounds the pull of each to huber_scale * weight;
// - between consecutive nodes of a trajectory, the motion by local SLAM and, of
//   nodes that have it, by odometry.
//
// Not read and hence not optimised: landmark observations and fixed frame
// (GPS) poses. Landmarks move along with the node that was nearest to them.
//
// Single-threaded, so that the same graph gives the same bytes: the solver adds
// up costs per thread, and evaluation is but a fifth of its time. About 25 ms
// per iteration for 10000 nodes (pose_graph_optimization_benchmark).

#ifndef CARTOGRAPHER_SDF_POSE_GRAPH_OPTIMIZATION_H_
#define CARTOGRAPHER_SDF_POSE_GRAPH_OPTIMIZATION_H_

#include <optional>
#include <set>
#include <string>

#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

// Names and defaults of the host's POSE_GRAPH.optimization_problem, and its
// max_num_final_iterations: a map that is already optimised with other weights
// will be bent by these.
struct OptimizationOptions {
  // Of the norm of a constraint's weighted residual.
  double huber_scale = 1e1;
  double local_slam_pose_translation_weight = 1e5;
  double local_slam_pose_rotation_weight = 1e5;
  double odometry_translation_weight = 1e5;
  double odometry_rotation_weight = 1e5;
  int max_num_iterations = 200;
};

// A sentence that begins with the offending field, or nothing.
[[nodiscard]] std::string Validate(const OptimizationOptions& options);

struct OptimizationSummary {
  // Of the host's problem, before and after.
  double initial_cost = 0.;
  double final_cost = 0.;
  int num_iterations = 0;
  double seconds = 0.;
  // False also where the iterations ran out; the graph is better then, but not
  // at the minimum.
  bool converged = false;
  // Why the solver ended.
  std::string message;
};

// Submaps and nodes of frozen trajectories stay. So does, in each part of the
// graph that nothing connects to a frozen one, its first submap: in a connected
// graph with nothing frozen the first of all, as in the host.
//
// Starts from the given poses or, where that costs less, from a rotation-first
// initialisation (rotation_first.h), without which trajectories that are turned
// by nearly 180 degrees do not arrive. Leaves the graph as it was where the
// solver fails or a value is not finite. Constraints must name submaps and
// nodes of the graph.
OptimizationSummary Optimize(const OptimizationOptions& options,
                             const std::set<int>& frozen_trajectories,
                             PoseGraph* pose_graph);

// How far the graph's poses are from a measurement.
struct ConstraintError {
  double translation = 0.;  // [m], not negative
  double rotation = 0.;     // [rad], in [0, pi]
};
[[nodiscard]] ConstraintError ConstraintResidual(const PoseGraph& pose_graph,
                                                 const Constraint& constraint);

// With which odometry weights was a map optimised? The file does not say, and
// others than the user's bend the whole map. But it shows: between consecutive
// nodes local SLAM and odometry pull in proportion to their squared weights,
// and everything else is soft or far away. So an optimised step lies at
//   local + lambda * (odometry - local),  lambda = w_o^2 / (w_o^2 + w_l^2),
// and lambda is found by linear regression over all steps.
//
// The odometry weights that fit the map's poses, given the local SLAM weights
// of the options. Zero where odometry had no part, as in a map that was never
// optimised. None where there is too little odometry, or it agrees with local
// SLAM so well that its weight does not matter.
[[nodiscard]] std::optional<OdometryWeights> InferOdometryWeights(
    const OptimizationOptions& options, const PoseGraph& pose_graph);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_POSE_GRAPH_OPTIMIZATION_H_
