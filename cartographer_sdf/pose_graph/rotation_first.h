// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_POSE_GRAPH_ROTATION_FIRST_H_
#define CARTOGRAPHER_SDF_POSE_GRAPH_ROTATION_FIRST_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cartographer_sdf/pose_graph/spa_graph.h"

namespace cartographer_sdf {

// Poses near a minimum of the graph's cost that hardly depend on the given
// ones: first all rotations, relaxed to 2-vectors of any length ("chordal",
// [Carlone2015]), then all translations with these rotations. Both problems are
// convex, so no start is too far and no angle wraps.
//
// A heuristic: rotations are not told what translations know of them, and of a
// rotation that the measurements spread evenly over half a turn the relaxed
// vectors vanish. False robust edges, of which a few bend the rotations, can
// make it worse than the given poses: compare the costs.
//
// None where the solver fails. Constant poses stay; about ten iterations of a
// third of the price of the full problem's.
[[nodiscard]] std::optional<std::vector<Eigen::Vector3d>> RotationFirstPoses(
    const SpaGraph& graph, double huber_scale);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_POSE_GRAPH_ROTATION_FIRST_H_
