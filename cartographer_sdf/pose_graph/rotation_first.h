// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_POSE_GRAPH_ROTATION_FIRST_H_
#define CARTOGRAPHER_SDF_POSE_GRAPH_ROTATION_FIRST_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cartographer_sdf/pose_graph/spa_graph.h"

namespace cartographer_sdf {

// Computes poses near a minimum of the graph's cost, almost independently of
// the given ones: first all rotations, relaxed to 2-vectors of any length
// ("chordal", [Carlone2015]), then all translations with these rotations. Both
// problems are convex, so any start will do and no angle wraps.
//
// A heuristic: the rotations ignore the information in the translations, and
// where the measurements of a rotation spread evenly over half a turn, the
// relaxed vectors vanish. A few false robust edges bend the rotations and can
// make the result worse than the given poses: compare the costs.
//
// None if the solver fails. Constant poses stay fixed. Takes about ten
// iterations, each at a third of the cost of one of the full problem.
[[nodiscard]] std::optional<std::vector<Eigen::Vector3d>> RotationFirstPoses(
    const SpaGraph& graph, double huber_scale);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_POSE_GRAPH_ROTATION_FIRST_H_
