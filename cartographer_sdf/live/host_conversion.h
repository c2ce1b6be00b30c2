// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The host's types to ours and back: the only place that knows how the host
// frames poses and constraints.

#ifndef CARTOGRAPHER_SDF_LIVE_HOST_CONVERSION_H_
#define CARTOGRAPHER_SDF_LIVE_HOST_CONVERSION_H_

#include <optional>
#include <vector>

#include "Eigen/Geometry"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/mapping/id.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer/mapping/submaps.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/verification/surface_model.h"

namespace cartographer_sdf {

using HostConstraint = cartographer::mapping::PoseGraphInterface::Constraint;

// Drops z, roll and pitch.
[[nodiscard]] Rigid2 FromHost(
    const cartographer::transform::Rigid3d& host_pose);
[[nodiscard]] SubmapId FromHost(const cartographer::mapping::SubmapId& id);
[[nodiscard]] NodeId FromHost(const cartographer::mapping::NodeId& id);
[[nodiscard]] cartographer::mapping::SubmapId ToHost(const SubmapId& id);
[[nodiscard]] cartographer::mapping::NodeId ToHost(const NodeId& id);

// Of the gravity-aligned node: (local <- node).
[[nodiscard]] Rigid2 LocalNodePose(
    const cartographer::mapping::TrajectoryNode::Data& node);
// The scan that the host matches, in the gravity-aligned node frame.
[[nodiscard]] std::vector<SurfacePoint> NodeScan(
    const cartographer::mapping::TrajectoryNode::Data& node);

// As AddSerializedConstraints takes it: the host wants the pose of the tracking
// frame, and takes the gravity alignment off again.
[[nodiscard]] HostConstraint ToHost(
    const Constraint& constraint, const Eigen::Quaterniond& gravity_alignment);

// A copy, cropped to what is known. The grid must not change meanwhile. None
// where there is no grid, or one that is broken.
[[nodiscard]] std::optional<OccupancyGrid> CopyGrid(
    const cartographer::mapping::Grid2D& grid, const Rigid2& T_local_submap);
// None where the submap is not a planar one, too.
[[nodiscard]] std::optional<OccupancyGrid> CopyGrid(
    const cartographer::mapping::Submap& submap);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_HOST_CONVERSION_H_
