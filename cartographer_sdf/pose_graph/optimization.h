// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Cartographer's 2D pose graph optimisation [Hess2016, Sec. VI-A]: moves the
// poses of submaps and nodes (map frame, metres and radians) to a local minimum
// of the host's cost:
//
// - every constraint, with its own weights; inter-submap ones under the Huber
//   loss, which bounds the pull of each to huber_scale * weight;
// - between consecutive nodes of a trajectory, the relative motion by local
//   SLAM and, where nodes have it, by odometry.
//
// Where odometry contradicts local SLAM (slips.h), neither is believed more
// than closures are: both motions, and the constraints of the submaps that hold
// scans from both sides, are under the Huber loss, too. The host holds them
// rigidly.
//
// Landmark observations and fixed frame (GPS) poses are not read and hence not
// optimised. Each landmark moves with the node nearest to it.
//
// Single-threaded, so that the same graph gives the same bytes: the solver sums
// costs per thread, and evaluation takes only a fifth of its time. About 25 ms
// per iteration for 10000 nodes (pose_graph_optimization_benchmark).

#ifndef CARTOGRAPHER_SDF_POSE_GRAPH_OPTIMIZATION_H_
#define CARTOGRAPHER_SDF_POSE_GRAPH_OPTIMIZATION_H_

#include <optional>
#include <set>
#include <string>

#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

// Names and defaults are those of the host's POSE_GRAPH.optimization_problem
// and its max_num_final_iterations. They will distort a map that was optimised
// with other weights.
struct OptimizationOptions {
  // Huber threshold on the norm of a constraint's weighted residual.
  double huber_scale = 1e1;
  double local_slam_pose_translation_weight = 1e5;
  double local_slam_pose_rotation_weight = 1e5;
  double odometry_translation_weight = 1e5;
  double odometry_rotation_weight = 1e5;
  // Steps at which local SLAM and odometry turn by angles that differ by more
  // [rad] are slips (slips.h). Not of the host; pi and more find none.
  double min_slip_angle = 0.15;
  int max_num_iterations = 200;
};

// Returns a sentence that begins with the offending field, or an empty string.
[[nodiscard]] std::string Validate(const OptimizationOptions& options);

// How an optimization begins, and how exactly it ends.
struct OptimizationRun {
  // Whether to try a rotation-first initialisation (rotation_first.h), without
  // which trajectories rotated by nearly 180 degrees do not converge. It takes
  // about a third of the time.
  bool initialize_rotation_first = true;
  // Ends where no pose moves by more than this in an iteration [m], [rad]; or,
  // as always, where the cost hardly falls.
  double max_step_meters = 0.;
  double max_step_angle = 0.;
};
// Near enough to the minimum to see outliers: less than a tenth of the errors
// that make one (OutlierRejectionOptions).
constexpr OptimizationRun kRoughRun{true, 2e-2, 2e-3};
// From poses that are near the minimum.
constexpr OptimizationRun kSettlingRun{false};

struct OptimizationSummary {
  // Cost of the host's problem, before and after.
  double initial_cost = 0.;
  double final_cost = 0.;
  int num_iterations = 0;
  double seconds = 0.;
  // Also false if the iterations ran out; the graph is then improved, but not
  // at the minimum.
  bool converged = false;
  // Why the solver stopped.
  std::string message;
};

// Submaps and nodes of frozen trajectories stay fixed. So does the first submap
// of each connected component without a frozen trajectory: in a connected graph
// with nothing frozen the very first submap, as in the host.
//
// Starts from the given poses or, where that is asked for and its cost is
// lower, from a rotation-first initialisation. Leaves the graph unchanged if
// the solver fails or a value is not finite. Constraints must refer to submaps
// and nodes of the graph.
OptimizationSummary Optimize(const OptimizationOptions& options,
                             const std::set<int>& frozen_trajectories,
                             PoseGraph* pose_graph,
                             const OptimizationRun& run = {});

// Deviation of the graph's poses from a measurement.
struct ConstraintError {
  double translation = 0.;  // [m], not negative
  double rotation = 0.;     // [rad], in [0, pi]
};
[[nodiscard]] ConstraintError ConstraintResidual(const PoseGraph& pose_graph,
                                                 const Constraint& constraint);

// Infers the odometry weights that a map was optimised with: the file does not
// store them, and other weights distort the whole map. Between consecutive
// nodes, local SLAM and odometry pull in proportion to their squared weights,
// and everything else is soft or far away. An optimised step therefore lies at
//   local + lambda * (odometry - local),  lambda = w_o^2 / (w_o^2 + w_l^2),
// and linear regression over all steps but slips yields lambda.
//
// The weights are relative to the local SLAM weights of the options. Zero if
// odometry was not used, as in a map that was never optimised. None if there is
// too little odometry, or if it agrees with local SLAM so closely that its
// weight does not matter.
[[nodiscard]] std::optional<OdometryWeights> InferOdometryWeights(
    const OptimizationOptions& options, const PoseGraph& pose_graph);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_POSE_GRAPH_OPTIMIZATION_H_
