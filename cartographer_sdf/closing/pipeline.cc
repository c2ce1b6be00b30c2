// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/pipeline.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

bool IsUndecided(const ClosureStatus status) {
  return status == ClosureStatus::kSelected ||
         status == ClosureStatus::kInconsistent ||
         status == ClosureStatus::kUnsupported ||
         status == ClosureStatus::kReady;
}

bool TakesPart(const ClosureStatus status) {
  return IsUndecided(status) || status == ClosureStatus::kInGraph ||
         status == ClosureStatus::kDetectedOnly;
}

ClosureStatus StatusOf(const Selection selection) {
  switch (selection) {
    case Selection::kSelected:
      return ClosureStatus::kSelected;
    case Selection::kInconsistent:
      return ClosureStatus::kInconsistent;
    case Selection::kUnsupported:
      return ClosureStatus::kUnsupported;
  }
  LOG(FATAL) << "not a selection: " << static_cast<int>(selection);
}

}  // namespace

std::string Validate(const ClosingOptions& options) {
  for (const std::string& error :
       {Validate(options.tear), Validate(options.consistency),
        Validate(options.constraints), Validate(options.optimization),
        Validate(options.outlier_rejection)}) {
    if (!error.empty()) return error;
  }
  return "";
}

OptimizationOptions OptimizationInForce(const ClosingOptions& options,
                                        const PoseGraph& pose_graph) {
  OptimizationOptions in_force = options.optimization;
  if (!options.infer_odometry_weights) return in_force;
  const std::optional<OdometryWeights> inferred =
      InferOdometryWeights(options.optimization, pose_graph);
  if (inferred) {
    in_force.odometry_translation_weight = inferred->translation;
    in_force.odometry_rotation_weight = inferred->rotation;
  }
  return in_force;
}

std::vector<size_t> SelectClosures(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& odometry,
    const std::map<SubmapId, Tear>& torn_submaps,
    std::vector<Closure>* const closures) {
  std::vector<size_t> voters;
  std::vector<PairPose> pairs;
  for (size_t k = 0; k < closures->size(); ++k) {
    const Closure& closure = (*closures)[k];
    if (!TakesPart(closure.status)) continue;
    voters.push_back(k);
    pairs.push_back(closure.match.pair);
    if (torn_submaps.count(pairs.back().reference) > 0 ||
        torn_submaps.count(pairs.back().query) > 0) {
      pairs.back().score = std::min(pairs.back().score, 0.);
    }
  }
  const std::vector<SelectionResult> results =
      SelectConsistent(options, odometry, pairs);
  std::vector<size_t> contradicted;
  for (size_t k = 0; k < voters.size(); ++k) {
    Closure& closure = (*closures)[voters[k]];
    if (IsUndecided(closure.status)) {
      closure.status = StatusOf(results[k].selection);
    } else if (closure.status == ClosureStatus::kInGraph &&
               results[k].selection == Selection::kInconsistent) {
      contradicted.push_back(voters[k]);
    }
  }
  return contradicted;
}

void GenerateConstraints(const ConstraintOptions& options,
                         const std::map<SubmapId, InsertedNodes>& nodes,
                         const std::map<SubmapId, Place>& places,
                         const ScansByNode& scans, const Executor& executor,
                         std::vector<Closure>* const closures) {
  executor(closures->size(), [&](const size_t k) {
    Closure& closure = (*closures)[k];
    if (closure.status != ClosureStatus::kSelected) return;
    const PairPose& pair = closure.match.pair;
    closure.constraints = GenerateConstraints(
        options, pair, nodes, places.at(pair.reference).surface,
        places.at(pair.query).surface, scans);
    closure.status = ClosureStatus::kInGraph;
    if (closure.constraints.size() <
        static_cast<size_t>(options.min_num_constraints)) {
      closure.constraints.clear();
      closure.status = ClosureStatus::kScansDisagree;
    }
  });
}

ClosedGraph CloseGraph(const ClosingOptions& options, const GraphToClose& graph,
                       std::vector<Match> matches,
                       const std::set<int>& frozen_trajectories,
                       const Executor& executor, StageClock* const clock) {
  CHECK_EQ(Validate(options), "");
  ClosedGraph result;
  result.closures = MakeClosures(std::move(matches));
  if (options.detect_torn_submaps) {
    result.torn_submaps =
        FindTornSubmaps(options.tear, *graph.pose_graph, *graph.point_clouds,
                        executor, clock->Begin("find torn submaps"));
  }
  clock->Begin("select consistent");
  SelectClosures(options.consistency, *graph.odometry, result.torn_submaps,
                 &result.closures);
  clock->Begin("generate constraints");
  GenerateConstraints(options.constraints, FindInsertedNodes(*graph.pose_graph),
                      *graph.places, *graph.point_clouds, executor,
                      &result.closures);
  OptimizedGraph optimized = OptimizeAndRejectOutliers(
      options.outlier_rejection, options.optimization, frozen_trajectories,
      *graph.pose_graph, &result.closures, clock->Begin("optimise"));
  result.pose_graph = std::move(optimized.pose_graph);
  result.optimizations = std::move(optimized.optimizations);
  return result;
}

}  // namespace cartographer_sdf
