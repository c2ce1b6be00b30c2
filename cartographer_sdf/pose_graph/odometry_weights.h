// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// With which odometry weights was a map optimised? The file does not say, and
// others than the user's bend the whole map. But it shows: between consecutive
// nodes local SLAM and odometry pull in proportion to their squared weights,
// and everything else is soft or far away. So an optimised step lies at
//   local + lambda * (odometry - local),  lambda = w_o^2 / (w_o^2 + w_l^2),
// and lambda is found by linear regression over all steps.

#ifndef CARTOGRAPHER_SDF_POSE_GRAPH_ODOMETRY_WEIGHTS_H_
#define CARTOGRAPHER_SDF_POSE_GRAPH_ODOMETRY_WEIGHTS_H_

#include <optional>

#include "cartographer_sdf/pose_graph/optimization.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

// The odometry weights that fit the map's poses, given the local SLAM weights
// of the options. Zero where odometry had no part, as in a map that was never
// optimised. None where there is too little odometry, or it agrees with local
// SLAM so well that its weight does not matter.
[[nodiscard]] std::optional<OdometryWeights> InferOdometryWeights(
    const OptimizationOptions& options, const PoseGraph& pose_graph);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_POSE_GRAPH_ODOMETRY_WEIGHTS_H_
