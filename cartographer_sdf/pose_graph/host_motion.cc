// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pose_graph/host_motion.h"

#include <algorithm>
#include <cmath>

#include "cartographer_sdf/pose_graph/slips.h"

namespace cartographer_sdf {
namespace {

// Ratio of weights below which they count as the same: inferred weights are
// estimates.
constexpr double kMinWeightRatio = 1.1;

bool AreAlike(const double a, const double b) {
  return std::max(a, b) <= kMinWeightRatio * std::min(a, b);
}

bool AreAlike(const OdometryWeights& a, const OdometryWeights& b) {
  return AreAlike(a.translation, b.translation) &&
         AreAlike(a.rotation, b.rotation);
}

OdometryWeights WeightsOf(const OptimizationOptions& options) {
  return {options.odometry_translation_weight,
          options.odometry_rotation_weight};
}

// Of the trajectories that have odometry; none if there are none.
std::optional<OdometryWeights> SmallestWeights(
    const OptimizationOptions& in_force, const PoseGraph& pose_graph) {
  std::optional<OdometryWeights> smallest;
  std::optional<int> seen;
  for (const auto& [id, node] : pose_graph.nodes) {
    if (!node.T_previous_node_by_odometry || seen == id.trajectory) continue;
    seen = id.trajectory;
    const auto own = pose_graph.odometry_weights.find(id.trajectory);
    const OdometryWeights weights = own == pose_graph.odometry_weights.end()
                                        ? WeightsOf(in_force)
                                        : own->second;
    if (!smallest) smallest = weights;
    smallest->translation =
        std::min(smallest->translation, weights.translation);
    smallest->rotation = std::min(smallest->rotation, weights.rotation);
  }
  return smallest;
}

}  // namespace

std::optional<HostMotion> PredictHostMotion(const OptimizationOptions& host,
                                            const OptimizationOptions& in_force,
                                            const PoseGraph& pose_graph) {
  const std::optional<OdometryWeights> weights =
      SmallestWeights(in_force, pose_graph);
  if (!weights) return std::nullopt;
  const size_t num_slips =
      FindSlips(in_force.min_slip_angle, pose_graph).size();
  if (num_slips == 0 && AreAlike(*weights, WeightsOf(host))) {
    return std::nullopt;
  }
  HostMotion motion{WeightsOf(host), *weights, num_slips, 0.};
  PoseGraph moved = pose_graph;
  moved.odometry_weights.clear();
  OptimizationOptions rigid = host;
  rigid.min_slip_angle = M_PI;  // none
  // The host starts from the poses of the map, too.
  Optimize(rigid, /*frozen_trajectories=*/{}, &moved, kSettlingRun);
  for (const auto& [id, node] : pose_graph.nodes) {
    motion.max_translation = std::max(
        motion.max_translation, (moved.nodes.at(id).T_map_node.translation() -
                                 node.T_map_node.translation())
                                    .norm());
  }
  return motion;
}

}  // namespace cartographer_sdf
