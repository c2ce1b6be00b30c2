// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/trajectory_error.h"

#include <cmath>
#include <utility>
#include <vector>

#include "cartographer_sdf/evaluation/tracking_pose.h"
#include "cartographer_sdf/geometry/alignment.h"

namespace cartographer_sdf {

std::optional<TrajectoryError> EvaluateTrajectory(const PoseGraph& pose_graph,
                                                  const Truth& truth) {
  std::vector<std::pair<Rigid2, Rigid2>> poses;  // in the world, in the map
  std::vector<Eigen::Vector2d> p_world;
  std::vector<Eigen::Vector2d> p_map;
  TrajectoryError result;
  for (const auto& [id, node] : pose_graph.nodes) {
    const auto T_world_tracking = truth.T_world_tracking.find(id);
    if (T_world_tracking == truth.T_world_tracking.end()) {
      ++result.num_skipped;
      continue;
    }
    poses.emplace_back(T_world_tracking->second, TrackingPose(node));
    p_world.push_back(poses.back().first.translation());
    p_map.push_back(poses.back().second.translation());
  }
  const std::optional<Rigid2> T_world_map = AlignPointPairs(p_world, p_map);
  if (!T_world_map.has_value()) return std::nullopt;
  result.T_world_map = *T_world_map;
  std::vector<double> translations;
  std::vector<double> rotations;
  for (const auto& [T_world_tracking, T_map_tracking] : poses) {
    const Rigid2 T_tracking_estimate =
        T_world_tracking.Inverse() * *T_world_map * T_map_tracking;
    translations.push_back(T_tracking_estimate.translation().norm());
    rotations.push_back(std::abs(T_tracking_estimate.rotation()));
  }
  result.errors = PoseErrorStatistics{*Summarize(std::move(translations)),
                                      *Summarize(std::move(rotations))};
  return result;
}

}  // namespace cartographer_sdf
