// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/selection_between.h"

namespace cartographer_sdf {
namespace {

// Trajectory ids as a file has them could be any: they are ranked, from `first`
// on.
std::map<int, int> RankTrajectories(
    const std::map<SubmapId, OdometryPose>& odometry, int first) {
  std::map<int, int> ranks;
  for (const auto& [id, pose] : odometry) {
    if (ranks.emplace(id.trajectory, first).second) ++first;
  }
  return ranks;
}

}  // namespace

std::vector<SelectionResult> SelectConsistentBetween(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& reference_odometry,
    const std::map<SubmapId, OdometryPose>& query_odometry,
    const std::vector<PairPose>& pairs) {
  const std::map<int, int> reference_ranks =
      RankTrajectories(reference_odometry, 0);
  const std::map<int, int> query_ranks = RankTrajectories(
      query_odometry, static_cast<int>(reference_ranks.size()));
  const auto rename = [](const std::map<int, int>& ranks, const SubmapId& id) {
    return SubmapId{ranks.at(id.trajectory), id.index};
  };
  std::map<SubmapId, OdometryPose> odometry;
  for (const auto& [id, pose] : reference_odometry) {
    odometry[rename(reference_ranks, id)] = pose;
  }
  for (const auto& [id, pose] : query_odometry) {
    odometry[rename(query_ranks, id)] = pose;
  }
  std::vector<PairPose> renamed = pairs;
  for (PairPose& pair : renamed) {
    pair.reference = rename(reference_ranks, pair.reference);
    pair.query = rename(query_ranks, pair.query);
  }
  return SelectConsistent(options, odometry, renamed);
}

}  // namespace cartographer_sdf
