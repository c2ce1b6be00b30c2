// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The main job: finds the loop closures of a saved map by what its submaps look
// like, keeps a mutually consistent set, and optimises the pose graph with it.

#ifndef CARTOGRAPHER_SDF_LOOP_CLOSING_LOOP_CLOSING_H_
#define CARTOGRAPHER_SDF_LOOP_CLOSING_LOOP_CLOSING_H_

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/closure/consistency.h"
#include "cartographer_sdf/loop_closing/described_map.h"
#include "cartographer_sdf/loop_closing/stage_clock.h"
#include "cartographer_sdf/loop_closing/torn_submaps.h"
#include "cartographer_sdf/loop_closing/withdrawal.h"
#include "cartographer_sdf/pose_graph/lifting.h"
#include "cartographer_sdf/pose_graph/odometry_weights.h"
#include "cartographer_sdf/pose_graph/optimization.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/neighbourhood.h"

namespace cartographer_sdf {

struct LoopClosingOptions {
  PlaceOptions place;
  MatchOptions match;  // method kSdf
  // Submaps of one trajectory are matched from this difference of their
  // indices on; nearer ones share scans.
  int min_index_gap = 3;
  // Whether only those pairs are matched that an index proposes; else all.
  bool use_retrieval = false;
  RetrievalOptions retrieval;
  // Whether matches are judged again by the neighbours of both submaps.
  bool ask_neighbours = true;
  NeighbourhoodOptions neighbourhood;
  // Whether submaps that their own scans show to be torn are kept from voting:
  // their closures neither support nor contradict others, and enter the graph
  // only where others support them.
  bool silence_torn_submaps = true;
  TearOptions tear;
  ConsistencyOptions consistency;
  LiftingOptions lifting;
  OptimizationOptions optimization;
  // Whether odometry weights that the map itself shows (odometry_weights.h)
  // take the place of those of `optimization`.
  bool infer_odometry_weights = true;
  WithdrawalOptions withdrawal;
};
[[nodiscard]] std::string Validate(const LoopClosingOptions& options);

struct LoopClosingResult {
  MapState state;        // as read
  PoseGraph pose_graph;  // optimised, with the new constraints at the end
  std::vector<ClosureOutcome> closures;  // all accepted matches, by ids
  size_t num_places = 0;
  // Empty where nobody asked.
  std::map<SubmapId, Tear> torn_submaps;
  size_t num_matches = 0;  // poses that were verified, accepted or not
  // The options in force, odometry weights as inferred.
  OptimizationOptions optimization;
  std::vector<OptimizationSummary> optimizations;
  std::vector<std::pair<std::string, double>> stage_seconds;
};

// Fails where the file can't be read. Frozen trajectories stay where they are.
[[nodiscard]] absl::StatusOr<LoopClosingResult> CloseLoops(
    const LoopClosingOptions& options, const std::string& path,
    const std::set<int>& frozen_trajectories, const Executor& executor,
    const StageCallback& on_stage = {});

// `options.optimization`, with the odometry weights that the map shows where
// they are to be inferred and it shows any.
[[nodiscard]] OptimizationOptions OptimizationInForce(
    const LoopClosingOptions& options, const PoseGraph& pose_graph);

// Where local SLAM says that the submaps are, and how far the robot had driven.
[[nodiscard]] std::map<SubmapId, OdometryPose> OdometryPoses(
    const MapState& state);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOOP_CLOSING_LOOP_CLOSING_H_
