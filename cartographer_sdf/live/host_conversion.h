// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Converts the host's types to ours and back. Only this code knows how the host
// frames poses and constraints.

#ifndef CARTOGRAPHER_SDF_LIVE_HOST_CONVERSION_H_
#define CARTOGRAPHER_SDF_LIVE_HOST_CONVERSION_H_

#include <optional>
#include <vector>

#include "Eigen/Geometry"
#include "cartographer/mapping/id.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer/mapping/submaps.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/sensor/range_data.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/grid/scan.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/localization/growing_grid.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

using HostConstraint = cartographer::mapping::PoseGraphInterface::Constraint;

// Drops z, roll and pitch.
[[nodiscard]] Rigid2 FromHost(
    const cartographer::transform::Rigid3d& host_pose);
[[nodiscard]] cartographer::transform::Rigid3d ToHost(const Rigid2& pose);
[[nodiscard]] SubmapId FromHost(const cartographer::mapping::SubmapId& id);
[[nodiscard]] NodeId FromHost(const cartographer::mapping::NodeId& id);
[[nodiscard]] cartographer::mapping::SubmapId ToHost(const SubmapId& id);
[[nodiscard]] cartographer::mapping::NodeId ToHost(const NodeId& id);

// Pose of the gravity-aligned node: (local <- node).
[[nodiscard]] Rigid2 LocalNodePose(
    const cartographer::mapping::TrajectoryNode::Data& node);
// The scan that the host matches, in the gravity-aligned node frame.
[[nodiscard]] PointCloud2 NodeScan(
    const cartographer::mapping::TrajectoryNode::Data& node);

// `range_data` lies in the trajectory's local frame; its points may be at any
// height.
[[nodiscard]] DrivenScan MakeDrivenScan(
    const cartographer::mapping::NodeId& id,
    const cartographer::mapping::TrajectoryNode::Data& node,
    const cartographer::sensor::RangeData& range_data, double distance_driven);

// The same scan, with the pose of the tracking frame by local SLAM as odometry.
[[nodiscard]] OdometryScan MakeOdometryScan(
    const cartographer::mapping::TrajectoryNode::Data& node,
    const DrivenScan& scan);

// Converts a constraint for AddSerializedConstraints: the host expects the pose
// of the tracking frame, and removes the gravity alignment again.
[[nodiscard]] HostConstraint ToHost(
    const Constraint& constraint, const Eigen::Quaterniond& gravity_alignment);

// Returns a pose graph that contains only the host's constraints. Their poses
// are those of the tracking frames, without z, roll and pitch: sufficient to
// tell which submap contains which node, not for optimisation.
[[nodiscard]] PoseGraph ConstraintsFromHost(
    const std::vector<HostConstraint>& constraints);

// Copies the submap's grid, cropped to the known cells. The submap must not
// change meanwhile. None if it is not planar, or its grid is missing or
// invalid.
[[nodiscard]] std::optional<OccupancyGrid> CopyGrid(
    const cartographer::mapping::Submap& submap);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_HOST_CONVERSION_H_
