// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/pipeline.h"

#include <algorithm>
#include <cstddef>
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

// A closure of torn submaps has no weight.
PairPose WeighedPair(const Closure& closure,
                     const std::map<SubmapId, Tear>& torn_submaps) {
  PairPose pair = closure.match.pair;
  if (torn_submaps.count(pair.reference) > 0 ||
      torn_submaps.count(pair.query) > 0) {
    pair.score = std::min(pair.score, 0.);
  }
  return pair;
}

// Sets the status of selected closures that the graph has constraints of.
void SkipThoseInGraph(const ConstraintOptions& options,
                      const std::map<SubmapId, InsertedNodes>& nodes,
                      const PoseGraph& pose_graph,
                      std::vector<Closure>* const closures) {
  std::vector<PairPose> pairs;
  for (const Closure& closure : *closures) {
    pairs.push_back(closure.match.pair);
  }
  const std::vector<bool> in_graph =
      AreInGraph(options, nodes, pose_graph, pairs);
  for (size_t k = 0; k < closures->size(); ++k) {
    Closure& closure = (*closures)[k];
    if (in_graph[k] && closure.status == ClosureStatus::kSelected) {
      closure.status = ClosureStatus::kAlreadyInGraph;
    }
  }
}

// Divides closures without constraints into kSelected and kRedundant. Those in
// the graph count as what they are: ties.
void SkipRedundant(const RedundancyOptions& options,
                   const std::map<SubmapId, Tear>& torn_submaps,
                   std::vector<Closure>* const closures) {
  std::vector<size_t> ties;
  std::vector<PairPose> pairs;
  for (size_t k = 0; k < closures->size(); ++k) {
    Closure& closure = (*closures)[k];
    if (closure.status == ClosureStatus::kRedundant) {
      closure.status = ClosureStatus::kSelected;
    }
    if (closure.status != ClosureStatus::kSelected &&
        closure.status != ClosureStatus::kInGraph &&
        closure.status != ClosureStatus::kAlreadyInGraph) {
      continue;
    }
    ties.push_back(k);
    pairs.push_back(WeighedPair(closure, torn_submaps));
  }
  const std::vector<bool> keep = KeepTies(options, pairs);
  for (size_t k = 0; k < ties.size(); ++k) {
    Closure& closure = (*closures)[ties[k]];
    if (!keep[k] && closure.status == ClosureStatus::kSelected) {
      closure.status = ClosureStatus::kRedundant;
    }
  }
}

std::ptrdiff_t CountStatus(const std::vector<Closure>& closures,
                           const ClosureStatus status) {
  return std::count_if(
      closures.begin(), closures.end(),
      [status](const Closure& closure) { return closure.status == status; });
}

}  // namespace

std::string Validate(const ClosingOptions& options) {
  for (const std::string& error :
       {Validate(options.tear), Validate(options.consistency),
        Validate(options.redundancy), Validate(options.constraints),
        Validate(options.optimization), Validate(options.outlier_rejection)}) {
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
    pairs.push_back(WeighedPair(closure, torn_submaps));
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

void GenerateInformativeConstraints(
    const ClosingOptions& options, const PoseGraph& pose_graph,
    const std::map<SubmapId, Place>& places, const ScansByNode& scans,
    const std::map<SubmapId, Tear>& torn_submaps, const Executor& executor,
    std::vector<Closure>* const closures) {
  const std::map<SubmapId, InsertedNodes> nodes = FindInsertedNodes(pose_graph);
  SkipThoseInGraph(options.constraints, nodes, pose_graph, closures);
  std::ptrdiff_t num_disagreeing = 0;
  do {
    SkipRedundant(options.redundancy, torn_submaps, closures);
    num_disagreeing = CountStatus(*closures, ClosureStatus::kScansDisagree);
    GenerateConstraints(options.constraints, nodes, places, scans, executor,
                        closures);
  } while (CountStatus(*closures, ClosureStatus::kScansDisagree) >
               num_disagreeing &&
           CountStatus(*closures, ClosureStatus::kRedundant) > 0);
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
  result.slips =
      FindSlips(options.optimization.min_slip_angle, *graph.pose_graph);
  clock->Begin("select consistent");
  SelectClosures(options.consistency, *graph.odometry, result.torn_submaps,
                 &result.closures);
  clock->Begin("generate constraints");
  GenerateInformativeConstraints(options, *graph.pose_graph, *graph.places,
                                 *graph.point_clouds, result.torn_submaps,
                                 executor, &result.closures);
  OptimizedGraph optimized = OptimizeAndRejectOutliers(
      options.outlier_rejection, options.optimization, frozen_trajectories,
      *graph.pose_graph, &result.closures, clock->Begin("optimise"));
  result.pose_graph = std::move(optimized.pose_graph);
  result.optimizations = std::move(optimized.optimizations);
  return result;
}

}  // namespace cartographer_sdf
