// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/loop_closing/selection_between.h"

#include <map>

#include "cartographer_sdf/loop_closing/loop_closing.h"

namespace cartographer_sdf {
namespace {

// Trajectories of a map, by rank from `first` on: ids as a file has them could
// be any.
std::map<int, int> RankTrajectories(
    const std::map<SubmapId, OdometryPose>& odometry,
    const std::vector<LoopClosure>& closures, SubmapId LoopClosure::*const end,
    const int first) {
  std::map<int, int> ranks;
  for (const auto& [id, pose] : odometry) ranks[id.trajectory] = 0;
  for (const LoopClosure& closure : closures) {
    ranks[(closure.*end).trajectory] = 0;
  }
  int rank = first;
  for (auto& [trajectory, value] : ranks) value = rank++;
  return ranks;
}

}  // namespace

std::vector<SelectionResult> SelectConsistentBetween(
    const ConsistencyOptions& options, const MapState& reference_map,
    const MapState& query_map, const std::vector<LoopClosure>& closures) {
  const std::map<SubmapId, OdometryPose> reference_odometry =
      OdometryPoses(reference_map);
  const std::map<SubmapId, OdometryPose> query_odometry =
      OdometryPoses(query_map);
  const std::map<int, int> reference_ranks = RankTrajectories(
      reference_odometry, closures, &LoopClosure::reference, 0);
  const std::map<int, int> query_ranks =
      RankTrajectories(query_odometry, closures, &LoopClosure::query,
                       static_cast<int>(reference_ranks.size()));
  std::map<SubmapId, OdometryPose> odometry;
  for (const auto& [id, pose] : reference_odometry) {
    odometry[{reference_ranks.at(id.trajectory), id.index}] = pose;
  }
  for (const auto& [id, pose] : query_odometry) {
    odometry[{query_ranks.at(id.trajectory), id.index}] = pose;
  }
  std::vector<LoopClosure> renamed = closures;
  for (LoopClosure& closure : renamed) {
    closure.reference.trajectory =
        reference_ranks.at(closure.reference.trajectory);
    closure.query.trajectory = query_ranks.at(closure.query.trajectory);
  }
  return SelectConsistent(options, odometry, renamed);
}

}  // namespace cartographer_sdf
