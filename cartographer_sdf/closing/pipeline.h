// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The pipeline from matches to an optimised pose graph: selects a mutually
// consistent set of closures, leaves out what the graph says already, generates
// their constraints, optimises, and rejects outliers. close_loops and merge run
// all of it (CloseGraph); beside a live Cartographer, which optimises by
// itself, closures are selected and their constraints generated for each new
// match.

#ifndef CARTOGRAPHER_SDF_CLOSING_PIPELINE_H_
#define CARTOGRAPHER_SDF_CLOSING_PIPELINE_H_

#include <map>
#include <set>
#include <string>
#include <vector>

#include "cartographer_sdf/closing/closure.h"
#include "cartographer_sdf/closing/consistency.h"
#include "cartographer_sdf/closing/constraint_generation.h"
#include "cartographer_sdf/closing/outlier_rejection.h"
#include "cartographer_sdf/closing/redundancy.h"
#include "cartographer_sdf/closing/torn_submaps.h"
#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/execution/stage_clock.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/place/trajectory_places.h"
#include "cartographer_sdf/pose_graph/optimization.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/pose_graph/slips.h"

namespace cartographer_sdf {

struct ClosingOptions {
  // Whether closures of submaps that their own scans show to be torn have zero
  // weight: they neither support nor contradict others, and enter the graph
  // only if others support them.
  bool detect_torn_submaps = true;
  TearOptions tear;
  ConsistencyOptions consistency;
  RedundancyOptions redundancy;
  ConstraintOptions constraints;
  OptimizationOptions optimization;
  // Whether odometry weights inferred from the map (optimization.h) replace
  // those of `optimization`.
  bool infer_odometry_weights = true;
  OutlierRejectionOptions outlier_rejection;
};
[[nodiscard]] std::string Validate(const ClosingOptions& options);

// Returns `options.optimization`, with inferred odometry weights if
// `infer_odometry_weights` is set and the map determines them.
[[nodiscard]] OptimizationOptions OptimizationInForce(
    const ClosingOptions& options, const PoseGraph& pose_graph);

// Sets the status of each undecided closure (selected, inconsistent,
// unsupported or ready) by its consistency with the others. Closures that are
// in the graph or were only detected contribute their weight; the rest are
// ignored. Returns the indices of closures in the graph that the others
// contradict.
std::vector<size_t> SelectClosures(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& odometry,
    const std::map<SubmapId, Tear>& torn_submaps,
    std::vector<Closure>* closures);

// Generates the constraints of the selected closures and sets their status:
// kInGraph, or kScansDisagree if there are too few. `places` must contain both
// places of each.
void GenerateConstraints(const ConstraintOptions& options,
                         const std::map<SubmapId, InsertedNodes>& nodes,
                         const std::map<SubmapId, Place>& places,
                         const ScansByNode& scans, const Executor& executor,
                         std::vector<Closure>* closures);

// Generates the constraints of those selected closures that carry information,
// and sets the status of the others: kAlreadyInGraph or kRedundant
// (redundancy.h). Where the scans of a closure disagree, those that it made
// redundant take part again.
void GenerateInformativeConstraints(
    const ClosingOptions& options, const PoseGraph& pose_graph,
    const std::map<SubmapId, Place>& places, const ScansByNode& scans,
    const std::map<SubmapId, Tear>& torn_submaps, const Executor& executor,
    std::vector<Closure>* closures);

// The map that CloseGraph closes; nothing is owned.
struct GraphToClose {
  // The optimisation starts from its poses.
  const PoseGraph* pose_graph;
  const std::map<SubmapId, OdometryPose>* odometry;
  const std::map<SubmapId, Place>* places;
  // Of all nodes with range data, in the node frames.
  const std::map<NodeId, PointCloud2>* point_clouds;
};

struct ClosedGraph {
  std::vector<Closure> closures;  // of all accepted matches, in their order
  // Empty if they were not searched for.
  std::map<SubmapId, Tear> torn_submaps;
  // Where the optimisation may give way.
  Slips slips;
  // Optimised, with the new constraints at the end; unchanged if there are
  // none.
  PoseGraph pose_graph;
  std::vector<OptimizationSummary> optimizations;  // one per round
};

// Frozen trajectories keep their poses. Uses `options.optimization` as given:
// inferring the weights is up to the caller, who knows which part of the graph
// belongs to which map.
[[nodiscard]] ClosedGraph CloseGraph(const ClosingOptions& options,
                                     const GraphToClose& graph,
                                     std::vector<Match> matches,
                                     const std::set<int>& frozen_trajectories,
                                     const Executor& executor,
                                     StageClock* clock);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CLOSING_PIPELINE_H_
