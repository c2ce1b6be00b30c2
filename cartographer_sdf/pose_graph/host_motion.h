// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What Cartographer does to a map that it loads unfrozen: it optimises it
// again, with the weights of its own configuration. Where these trust odometry
// more than the map does, they bend it; so does a slip, at which it does not
// give way.

#ifndef CARTOGRAPHER_SDF_POSE_GRAPH_HOST_MOTION_H_
#define CARTOGRAPHER_SDF_POSE_GRAPH_HOST_MOTION_H_

#include <cstddef>
#include <optional>

#include "cartographer_sdf/pose_graph/optimization.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

struct HostMotion {
  // Of the odometry: of the host, and those with which the map was optimised;
  // where trajectories have weights of their own, the smallest.
  OdometryWeights host_weights;
  OdometryWeights map_weights;
  // The host holds slips rigidly (slips.h).
  size_t num_slips = 0;
  // The largest motion of a node in the map frame [m].
  double max_translation = 0.;
};

// Predicts it for a graph that was optimised with `in_force` and is optimised
// by the host with `host`, from its poses to a minimum near them. None where
// the graph has no odometry, or where both weigh it the same and local SLAM did
// not slip.
[[nodiscard]] std::optional<HostMotion> PredictHostMotion(
    const OptimizationOptions& host, const OptimizationOptions& in_force,
    const PoseGraph& pose_graph);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_POSE_GRAPH_HOST_MOTION_H_
