// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/loop_closing/loop_closing.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <optional>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

class StageClock {
 public:
  StageClock(const StageCallback& on_stage,
             std::vector<std::pair<std::string, double>>* const seconds)
      : on_stage_(on_stage), seconds_(seconds) {}

  ProgressCallback Begin(const std::string& stage) {
    End();
    seconds_->emplace_back(stage, 0.);
    begin_ = std::chrono::steady_clock::now();
    return on_stage_ ? on_stage_(stage) : ProgressCallback();
  }
  void End() {
    if (!begin_) return;
    seconds_->back().second = std::chrono::duration<double>(
                                  std::chrono::steady_clock::now() - *begin_)
                                  .count();
    begin_.reset();
  }

 private:
  const StageCallback& on_stage_;
  std::vector<std::pair<std::string, double>>* const seconds_;
  std::optional<std::chrono::steady_clock::time_point> begin_;
};

std::vector<SurfacePoint> ToSurfacePoints(const PointCloud2& cloud) {
  std::vector<SurfacePoint> points;
  points.reserve(cloud.size());
  for (const Eigen::Vector2f& point : cloud) {
    points.push_back({point.cast<double>(), 1.});
  }
  return points;
}

void SelectClosures(const ConsistencyOptions& options, const MapState& state,
                    std::vector<ClosureOutcome>* const outcomes) {
  std::vector<LoopClosure> closures;
  for (const ClosureOutcome& outcome : *outcomes) {
    closures.push_back(outcome.match.closure);
  }
  const std::vector<SelectionResult> results =
      SelectConsistent(options, OdometryPoses(state), closures);
  for (size_t k = 0; k < results.size(); ++k) {
    switch (results[k].selection) {
      case Selection::kSelected:
        (*outcomes)[k].fate = Fate::kInGraph;
        break;
      case Selection::kContradicted:
        (*outcomes)[k].fate = Fate::kContradicted;
        break;
      case Selection::kUnsupported:
        (*outcomes)[k].fate = Fate::kUnsupported;
        break;
    }
  }
}

absl::StatusOr<ScansByNode> ReadScans(
    const LiftingOptions& options, const std::string& path,
    const PoseGraph& pose_graph, const std::vector<ClosureOutcome>& outcomes,
    const ProgressCallback& on_progress) {
  std::set<SubmapId> submaps;
  for (const ClosureOutcome& outcome : outcomes) {
    if (outcome.fate != Fate::kInGraph) continue;
    submaps.insert(outcome.match.closure.reference);
    submaps.insert(outcome.match.closure.query);
  }
  std::set<NodeId> nodes;
  for (const SubmapId& submap : submaps) {
    for (const NodeId& node : NodesToLift(options, pose_graph, submap)) {
      nodes.insert(node);
    }
  }
  ScansByNode scans;
  if (nodes.empty()) return scans;
  const absl::StatusOr<std::map<NodeId, PointCloud2>> clouds =
      ReadPointClouds(path, nodes, on_progress);
  if (!clouds.ok()) return clouds.status();
  for (const auto& [node, cloud] : *clouds) {
    if (!cloud.empty()) scans.emplace(node, ToSurfacePoints(cloud));
  }
  return scans;
}

void LiftClosures(const LiftingOptions& options, const PoseGraph& pose_graph,
                  const std::map<SubmapId, Place>& places,
                  const ScansByNode& scans, const Executor& executor,
                  std::vector<ClosureOutcome>* const outcomes) {
  executor(outcomes->size(), [&](const size_t k) {
    ClosureOutcome& outcome = (*outcomes)[k];
    if (outcome.fate != Fate::kInGraph) return;
    const LoopClosure& closure = outcome.match.closure;
    outcome.constraints = LiftClosure(options, pose_graph, closure,
                                      places.at(closure.reference).surface,
                                      places.at(closure.query).surface, scans);
    if (outcome.constraints.empty()) outcome.fate = Fate::kScansDisagree;
  });
}

ConstraintError MeanError(const PoseGraph& pose_graph,
                          const std::vector<Constraint>& constraints) {
  ConstraintError mean;
  for (const Constraint& constraint : constraints) {
    const ConstraintError error = ConstraintResidual(pose_graph, constraint);
    mean.translation += error.translation;
    mean.rotation += error.rotation;
  }
  mean.translation /= static_cast<double>(constraints.size());
  mean.rotation /= static_cast<double>(constraints.size());
  return mean;
}

// In units of what is allowed.
double Excess(const WithdrawalOptions& options, const ConstraintError& error) {
  return std::max(error.translation / options.max_translation_error_meters,
                  error.rotation / options.max_rotation_error);
}

// Withdraws what the graph contradicts most; false where there is nothing. A
// false closure strains true ones beside it, so that only those at least half
// as bad as the worst go at once.
bool Withdraw(const WithdrawalOptions& options, const PoseGraph& pose_graph,
              std::vector<ClosureOutcome>* const outcomes) {
  double worst = 0.;
  for (ClosureOutcome& outcome : *outcomes) {
    if (outcome.fate != Fate::kInGraph) continue;
    outcome.error = MeanError(pose_graph, outcome.constraints);
    worst = std::max(worst, Excess(options, outcome.error));
  }
  if (worst <= 1.) return false;
  for (ClosureOutcome& outcome : *outcomes) {
    if (outcome.fate == Fate::kInGraph &&
        Excess(options, outcome.error) > std::max(1., 0.5 * worst)) {
      outcome.fate = Fate::kWithdrawn;
      outcome.constraints.clear();
    }
  }
  return true;
}

OptimizationOptions OptionsInForce(const LoopClosingOptions& options,
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

void OptimizeAndWithdraw(const LoopClosingOptions& options,
                         const std::set<int>& frozen_trajectories,
                         const ProgressCallback& on_progress,
                         LoopClosingResult* const result) {
  result->optimization = OptionsInForce(options, result->state.pose_graph);
  for (int round = 0;; ++round) {
    // From the poses of the file each time: a withdrawn closure leaves no
    // trace.
    result->pose_graph = result->state.pose_graph;
    for (const ClosureOutcome& outcome : result->closures) {
      result->pose_graph.constraints.insert(
          result->pose_graph.constraints.end(), outcome.constraints.begin(),
          outcome.constraints.end());
    }
    // Nothing new: the map stays as it is, to the last bit.
    if (result->pose_graph.constraints.size() ==
        result->state.pose_graph.constraints.size()) {
      return;
    }
    result->optimizations.push_back(Optimize(
        result->optimization, frozen_trajectories, &result->pose_graph));
    if (on_progress) {
      on_progress(static_cast<double>(round + 1) /
                  (options.withdrawal.max_num_rounds + 1));
    }
    // The last round's graph has been optimised without what was withdrawn
    // before; nothing may be withdrawn after it.
    if (round >= options.withdrawal.max_num_rounds ||
        !Withdraw(options.withdrawal, result->pose_graph, &result->closures)) {
      return;
    }
  }
}

}  // namespace

std::string Validate(const WithdrawalOptions& options) {
  if (!(options.max_translation_error_meters > 0. &&
        options.max_rotation_error > 0.)) {
    return "max_translation_error_meters and max_rotation_error must be "
           "positive";
  }
  if (options.max_num_rounds < 0 || options.max_num_rounds > 1000) {
    return "max_num_rounds must lie between 0 and 1000";
  }
  return "";
}

std::string Validate(const LoopClosingOptions& options) {
  for (const std::string& error :
       {Validate(options.place), Validate(options.match),
        Validate(options.consistency), Validate(options.lifting),
        Validate(options.optimization), Validate(options.withdrawal)}) {
    if (!error.empty()) return error;
  }
  if (options.min_index_gap < 1) return "min_index_gap must be positive";
  return "";
}

const char* FateName(const Fate fate) {
  switch (fate) {
    case Fate::kInGraph:
      return "in_graph";
    case Fate::kContradicted:
      return "contradicted_by_others";
    case Fate::kUnsupported:
      return "unsupported";
    case Fate::kScansDisagree:
      return "scans_disagree";
    case Fate::kWithdrawn:
      return "withdrawn";
  }
  LOG(FATAL) << "not a fate: " << static_cast<int>(fate);
}

std::map<SubmapId, OdometryPose> OdometryPoses(const MapState& state) {
  // Distance driven up to each node.
  std::map<NodeId, double> driven;
  std::optional<std::pair<NodeId, Rigid2>> previous;
  double distance = 0.;
  for (const auto& [id, node] : state.pose_graph.nodes) {
    const Rigid2& pose =
        node.T_local_node ? *node.T_local_node : node.T_map_node;
    if (previous && previous->first.trajectory == id.trajectory) {
      distance += (pose.translation() - previous->second.translation()).norm();
    }
    driven[id] = distance;
    previous = {id, pose};
  }
  // A submap is where its nodes are in the middle.
  std::map<SubmapId, std::pair<double, int>> sums;
  for (const Constraint& constraint : state.pose_graph.constraints) {
    if (constraint.tag != Constraint::Tag::kIntraSubmap) continue;
    auto& [sum, count] = sums[constraint.submap];
    sum += driven[constraint.node];
    ++count;
  }
  std::map<SubmapId, OdometryPose> poses;
  for (const auto& [id, submap] : state.submaps) {
    const auto sum = sums.find(id);
    poses[id] = {
        submap.T_local_submap,
        sum == sums.end() ? 0. : sum->second.first / sum->second.second};
  }
  return poses;
}

absl::StatusOr<LoopClosingResult> CloseLoops(
    const LoopClosingOptions& options, const std::string& path,
    const std::set<int>& frozen_trajectories, const Executor& executor,
    const StageCallback& on_stage) {
  CHECK_EQ(Validate(options), "");
  CHECK(options.match.method == Method::kSdf)
      << "the paper's method verifies nothing";
  LoopClosingResult result;
  StageClock clock(on_stage, &result.stage_seconds);

  absl::StatusOr<DescribedMap> map =
      DescribeMap(options.place, options.match, path, executor,
                  clock.Begin("read and describe"));
  if (!map.ok()) return map.status();
  result.state = std::move(map->state);
  result.num_places = map->places.size();

  std::vector<Match> matches =
      MatchWithin(options.match, map->places, options.min_index_gap, executor,
                  clock.Begin("match and verify"));
  result.num_matches = matches.size();
  for (Match& match : matches) {
    if (match.verdict != Verdict::kAccepted) continue;
    result.closures.push_back({std::move(match), Fate::kInGraph, {}, {}});
  }

  clock.Begin("select consistent");
  SelectClosures(options.consistency, result.state, &result.closures);

  const ProgressCallback lift_progress = clock.Begin("lift to constraints");
  const absl::StatusOr<ScansByNode> scans =
      ReadScans(options.lifting, path, result.state.pose_graph, result.closures,
                lift_progress);
  if (!scans.ok()) return scans.status();
  LiftClosures(options.lifting, result.state.pose_graph, map->places, *scans,
               executor, &result.closures);

  OptimizeAndWithdraw(options, frozen_trajectories, clock.Begin("optimise"),
                      &result);
  clock.End();
  return result;
}

}  // namespace cartographer_sdf
