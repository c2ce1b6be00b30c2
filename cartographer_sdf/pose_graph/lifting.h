// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Cartographer's pose graph has constraints between a submap and a node, and
// nothing else. A closure of two submaps becomes several of them: nodes of the
// query against the reference submap, and nodes of the reference against the
// query submap. Each node's own scan is registered to the other submap's field,
// because local SLAM bends within a submap by more than that registration errs.

#ifndef CARTOGRAPHER_SDF_POSE_GRAPH_LIFTING_H_
#define CARTOGRAPHER_SDF_POSE_GRAPH_LIFTING_H_

#include <map>
#include <set>
#include <string>
#include <vector>

#include "cartographer_sdf/closure/loop_closure.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/verification/agreement.h"
#include "cartographer_sdf/verification/registration.h"
#include "cartographer_sdf/verification/surface_model.h"

namespace cartographer_sdf {

struct LiftingOptions {
  // Nodes of each of the two submaps that are held against the other one. More:
  // a stronger and smoother pull.
  int num_nodes_per_submap = 5;
  // The host's POSE_GRAPH.constraint_builder.loop_closure_translation_weight
  // and loop_closure_rotation_weight.
  double translation_weight = 1.1e4;
  double rotation_weight = 1e5;
  // How far a node's pose within its submap may be off: the prior of its
  // registration [m], [rad].
  double translation_sigma_meters = 0.1;
  double rotation_sigma = 0.02;
  // A registration that moves a node farther than this many times the sigmas,
  // or after which fewer of the scan's points are on walls, is not believed,
  // and the node gives no constraint.
  double max_num_sigmas = 3.;
  double min_hit_ratio = 0.6;
};
[[nodiscard]] std::string Validate(const LiftingOptions& options);

// Scans in their nodes' frames.
using ScansByNode = std::map<NodeId, std::vector<SurfacePoint>>;

// Evenly spaced among the nodes whose scans were inserted into the submap, in
// order; its intra-submap constraints name them.
[[nodiscard]] std::vector<NodeId> NodesToLift(const LiftingOptions& options,
                                              const PoseGraph& pose_graph,
                                              const SubmapId& submap);

// Inter-submap constraints; empty where the scans do not bear the closure out.
// Nodes without a scan are taken as local SLAM placed them.
[[nodiscard]] std::vector<Constraint> LiftClosure(const LiftingOptions& options,
                                                  const PoseGraph& pose_graph,
                                                  const LoopClosure& closure,
                                                  const SurfaceModel& reference,
                                                  const SurfaceModel& query,
                                                  const ScansByNode& scans);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_POSE_GRAPH_LIFTING_H_
