// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Constraint generation: turns closures into constraints of the pose graph.
// Cartographer's graph only has constraints between a submap and a node, so a
// closure of two submaps becomes several constraints: nodes of the query
// against the reference submap, and nodes of the reference against the query
// submap. Each node's own scan is registered to the other submap's field,
// because local SLAM bends within a submap by more than that registration errs.

#ifndef CARTOGRAPHER_SDF_CLOSING_CONSTRAINT_GENERATION_H_
#define CARTOGRAPHER_SDF_CLOSING_CONSTRAINT_GENERATION_H_

#include <map>
#include <string>
#include <vector>

#include "cartographer_sdf/grid/pair_pose.h"
#include "cartographer_sdf/place/surface_model.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

struct ConstraintOptions {
  // Nodes of each of the two submaps that are registered to the other one.
  // Larger: a stronger and smoother pull.
  int num_nodes_per_submap = 5;
  // A closure that yields fewer constraints is rejected.
  int min_num_constraints = 3;
  // The host's POSE_GRAPH.constraint_builder.loop_closure_translation_weight
  // and loop_closure_rotation_weight.
  double translation_weight = 1.1e4;
  double rotation_weight = 1e5;
  // Standard deviations of a node's pose within its submap: the prior of its
  // registration [m], [rad].
  double translation_sigma_meters = 0.1;
  double rotation_sigma = 0.02;
  // A node yields no constraint if registration moves it by more than this many
  // sigmas, or leaves a smaller fraction of its scan's points on walls.
  double max_num_sigmas = 3.;
  double min_hit_ratio = 0.6;
};
[[nodiscard]] std::string Validate(const ConstraintOptions& options);

// (submap <- node) of the nodes whose scans were inserted into a submap.
using InsertedNodes = std::map<NodeId, Rigid2>;

// Returns the inserted nodes of all submaps, from the intra-submap constraints.
[[nodiscard]] std::map<SubmapId, InsertedNodes> FindInsertedNodes(
    const PoseGraph& pose_graph);

// Selects the nodes that get a constraint: evenly spaced ones, in order.
[[nodiscard]] InsertedNodes ChooseNodes(const ConstraintOptions& options,
                                        const InsertedNodes& nodes);

// Filtered range data of nodes, in the node frames. An empty point cloud counts
// as absent.
using ScansByNode = std::map<NodeId, PointCloud2>;

// Returns the inter-submap constraints of one pair of submaps. Nodes whose
// scans do not fit yield none; nodes without a scan keep their pose by local
// SLAM. `nodes` has the nodes of the submaps; a submap that is absent
// contributes none.
[[nodiscard]] std::vector<Constraint> GenerateConstraints(
    const ConstraintOptions& options, const PairPose& pair,
    const std::map<SubmapId, InsertedNodes>& nodes,
    const SurfaceModel& reference, const SurfaceModel& query,
    const ScansByNode& scans);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CLOSING_CONSTRAINT_GENERATION_H_
