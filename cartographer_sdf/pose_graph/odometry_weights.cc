// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pose_graph/odometry_weights.h"

#include <algorithm>
#include <cmath>

namespace cartographer_sdf {
namespace {

constexpr int kMinNumSteps = 20;
// Odometry that on average differs less from local SLAM is uninformative [m],
// [rad].
constexpr double kMinTranslationDifference = 1e-5;
constexpr double kMinRotationDifference = 1e-6;
// Weights that differ more than this act as if the lesser were zero.
constexpr double kMinLambda = 1e-6;

// Least squares of y = lambda * x.
struct Regression {
  double xy = 0.;
  double xx = 0.;

  void Add(const double x, const double y) {
    xy += x * y;
    xx += x * x;
  }
  // The weight beside one of `other` that explains the slope.
  [[nodiscard]] double Weight(const double other) const {
    const double lambda = std::min(xy / xx, 1. - kMinLambda);
    if (lambda < kMinLambda) return 0.;
    return other * std::sqrt(lambda / (1. - lambda));
  }
};

}  // namespace

std::optional<OdometryWeights> InferOdometryWeights(
    const OptimizationOptions& options, const PoseGraph& pose_graph) {
  if (!(options.local_slam_pose_translation_weight > 0. &&
        options.local_slam_pose_rotation_weight > 0.)) {
    return std::nullopt;
  }
  Regression translation, rotation;
  int num_steps = 0;
  auto previous = pose_graph.nodes.begin();
  for (auto it = pose_graph.nodes.begin(); it != pose_graph.nodes.end();
       previous = it++) {
    const auto& [from_id, from] = *previous;
    const auto& [id, to] = *it;
    if (from_id.trajectory != id.trajectory || id.index != from_id.index + 1 ||
        !from.T_local_node || !to.T_local_node ||
        !to.T_previous_node_by_odometry) {
      continue;
    }
    const Rigid2 optimized = from.T_map_node.Inverse() * to.T_map_node;
    const Rigid2 local = from.T_local_node->Inverse() * *to.T_local_node;
    const Rigid2& odometry = *to.T_previous_node_by_odometry;
    const Eigen::Vector2d x = odometry.translation() - local.translation();
    const Eigen::Vector2d y = optimized.translation() - local.translation();
    translation.Add(x.x(), y.x());
    translation.Add(x.y(), y.y());
    rotation.Add(NormalizeAngle(odometry.rotation() - local.rotation()),
                 NormalizeAngle(optimized.rotation() - local.rotation()));
    ++num_steps;
  }
  if (num_steps < kMinNumSteps ||
      translation.xx < num_steps * std::pow(kMinTranslationDifference, 2) ||
      rotation.xx < num_steps * std::pow(kMinRotationDifference, 2)) {
    return std::nullopt;
  }
  return OdometryWeights{
      translation.Weight(options.local_slam_pose_translation_weight),
      rotation.Weight(options.local_slam_pose_rotation_weight)};
}

}  // namespace cartographer_sdf
