// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Slips of local SLAM: steps between consecutive nodes at which the scan
// matcher turned the robot by an angle that odometry contradicts. A pose graph
// that holds a slip rigidly bends everything around it, and contradicts right
// closures. Angles tell where it slipped, and translations do not: on fr079,
// whose front end tore it, odometry and local SLAM differ by up to 0.35 rad
// there, as the truth says, but by no more than elsewhere in translation.

#ifndef CARTOGRAPHER_SDF_POSE_GRAPH_SLIPS_H_
#define CARTOGRAPHER_SDF_POSE_GRAPH_SLIPS_H_

#include <map>
#include <optional>
#include <set>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

// Motion between two consecutive nodes of a trajectory.
struct Step {
  Rigid2 T_previous_node_by_local_slam;
  Rigid2 T_previous_node_by_odometry;
};

// Returns the step that ends at the node at `it`. None where the previous node
// of its trajectory is not in the graph, or local SLAM or odometry is missing.
[[nodiscard]] std::optional<Step> StepTo(
    const PoseGraph& pose_graph, std::map<NodeId, Node>::const_iterator it);

// Returns whether both turn by angles that differ by more than `min_angle`
// [rad].
[[nodiscard]] bool IsSlip(double min_angle, const Step& step);

// Slips, each by the node at its end, with the angle by which local SLAM turned
// further than odometry [rad], in (-pi, pi].
using Slips = std::map<NodeId, double>;

[[nodiscard]] Slips FindSlips(double min_angle, const PoseGraph& pose_graph);

// Returns the submaps that hold scans from both sides of a slip.
[[nodiscard]] std::set<SubmapId> SubmapsWithSlips(const Slips& slips,
                                                  const PoseGraph& pose_graph);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_POSE_GRAPH_SLIPS_H_
