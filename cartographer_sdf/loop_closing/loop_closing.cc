// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/loop_closing/loop_closing.h"

#include <algorithm>
#include <map>
#include <optional>

#include "cartographer_sdf/loop_closing/closure_stages.h"
#include "cartographer_sdf/loop_closing/neighbours.h"
#include "glog/logging.h"

namespace cartographer_sdf {
std::string Validate(const LoopClosingOptions& options) {
  for (const std::string& error :
       {Validate(options.place), Validate(options.match),
        Validate(options.retrieval), Validate(options.neighbourhood),
        Validate(options.tear), Validate(options.consistency),
        Validate(options.lifting), Validate(options.optimization),
        Validate(options.withdrawal)}) {
    if (!error.empty()) return error;
  }
  if (options.min_index_gap < 1) return "min_index_gap must be positive";
  return "";
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

OptimizationOptions OptimizationInForce(const LoopClosingOptions& options,
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
      MatchWithin(options.match,
                  options.use_retrieval ? std::make_optional(options.retrieval)
                                        : std::nullopt,
                  map->places, options.min_index_gap, executor,
                  clock.Begin("match and verify"));
  if (options.ask_neighbours) {
    const std::map<SubmapId, OdometryPose> odometry =
        OdometryPoses(result.state);
    const PlacesAlongTrajectories places{&map->places, &odometry};
    JudgeByNeighbours(options.neighbourhood, options.match, places, places,
                      options.min_index_gap, executor,
                      clock.Begin("ask neighbours"), &matches);
  }
  result.num_matches = matches.size();
  for (Match& match : matches) {
    if (match.verdict != Verdict::kAccepted) continue;
    result.closures.push_back({std::move(match), Fate::kInGraph, {}, {}});
  }

  if (options.silence_torn_submaps) {
    absl::StatusOr<std::map<SubmapId, Tear>> torn =
        FindTornSubmaps(options.tear, path, result.state.pose_graph, executor,
                        clock.Begin("find torn submaps"));
    if (!torn.ok()) return torn.status();
    result.torn_submaps = *std::move(torn);
  }

  clock.Begin("select consistent");
  SelectClosures(options.consistency, result.state, result.torn_submaps,
                 &result.closures);

  const ProgressCallback lift_progress = clock.Begin("lift to constraints");
  const absl::StatusOr<ScansByNode> scans =
      ReadScansToLift(options.lifting, result.state.pose_graph, result.closures,
                      [&](const std::set<NodeId>& nodes) {
                        return ReadPointClouds(path, nodes, lift_progress);
                      });
  if (!scans.ok()) return scans.status();
  LiftClosures(options.lifting, result.state.pose_graph, map->places, *scans,
               executor, &result.closures);

  result.optimization = OptimizationInForce(options, result.state.pose_graph);
  OptimizedGraph optimized = OptimizeAndWithdraw(
      options.withdrawal, result.optimization, frozen_trajectories,
      result.state.pose_graph, &result.closures, clock.Begin("optimise"));
  result.pose_graph = std::move(optimized.pose_graph);
  result.optimizations = std::move(optimized.optimizations);
  clock.End();
  return result;
}

}  // namespace cartographer_sdf
