// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_EVALUATION_TRAJECTORY_ERROR_H_
#define CARTOGRAPHER_SDF_EVALUATION_TRAJECTORY_ERROR_H_

#include <optional>

#include "cartographer_sdf/evaluation/error_statistics.h"
#include "cartographer_sdf/evaluation/truth.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

// Absolute errors of the tracking frame at the nodes after the rigid motion
// that brings their positions nearest to the true ones (least squares).
struct TrajectoryError {
  Rigid2 T_world_map;
  PoseErrorStatistics errors;
  // Nodes of the map that the truth does not know.
  int num_skipped = 0;
};

// None where the nodes in common do not determine the motion: fewer than two,
// or all at one place.
[[nodiscard]] std::optional<TrajectoryError> EvaluateTrajectory(
    const PoseGraph& pose_graph, const Truth& truth);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_TRAJECTORY_ERROR_H_
