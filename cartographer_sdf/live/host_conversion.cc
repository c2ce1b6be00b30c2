// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/host_conversion.h"

#include <utility>

#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/transform/transform.h"
#include "cartographer_sdf/pbstream/grid_conversion.h"
#include "cartographer_sdf/serialized_state.pb.h"

namespace cartographer_sdf {

namespace mapping = cartographer::mapping;
namespace transform = cartographer::transform;

namespace {

PointCloud2 Flatten(const cartographer::sensor::PointCloud& cloud,
                    const Eigen::Vector2f& origin) {
  PointCloud2 points;
  points.reserve(cloud.size());
  for (const cartographer::sensor::RangefinderPoint& point : cloud) {
    points.push_back(point.position.head<2>() - origin);
  }
  return points;
}

}  // namespace

Rigid2 FromHost(const transform::Rigid3d& host_pose) {
  const transform::Rigid2d pose = transform::Project2D(host_pose);
  return Rigid2(pose.translation(), pose.rotation().angle());
}

transform::Rigid3d ToHost(const Rigid2& pose) {
  return transform::Embed3D(transform::Rigid2d(
      pose.translation(), Eigen::Rotation2Dd(pose.rotation())));
}

SubmapId FromHost(const mapping::SubmapId& id) {
  return {id.trajectory_id, id.submap_index};
}

NodeId FromHost(const mapping::NodeId& id) {
  return {id.trajectory_id, id.node_index};
}

mapping::SubmapId ToHost(const SubmapId& id) {
  return mapping::SubmapId(id.trajectory, id.index);
}

mapping::NodeId ToHost(const NodeId& id) {
  return mapping::NodeId(id.trajectory, id.index);
}

Rigid2 LocalNodePose(const mapping::TrajectoryNode::Data& node) {
  return FromHost(node.local_pose * transform::Rigid3d::Rotation(
                                        node.gravity_alignment.inverse()));
}

PointCloud2 NodeScan(const mapping::TrajectoryNode::Data& node) {
  return Flatten(node.filtered_gravity_aligned_point_cloud,
                 Eigen::Vector2f::Zero());
}

DrivenScan MakeDrivenScan(const mapping::NodeId& id,
                          const mapping::TrajectoryNode::Data& node,
                          const cartographer::sensor::RangeData& range_data,
                          const double distance_driven) {
  const Eigen::Vector2f origin = range_data.origin.head<2>();
  return DrivenScan{FromHost(id), LocalNodePose(node),
                    Rigid2(origin.cast<double>(), 0.),
                    Scan{Flatten(range_data.returns, origin),
                         Flatten(range_data.misses, origin)},
                    distance_driven};
}

OdometryScan MakeOdometryScan(const mapping::TrajectoryNode::Data& node,
                              const DrivenScan& scan) {
  const Rigid2 T_local_tracking = FromHost(node.local_pose);
  return OdometryScan{
      cartographer::common::ToSeconds(node.time - cartographer::common::Time()),
      T_local_tracking,
      {{T_local_tracking.Inverse() * scan.T_local_sensor, scan.scan}}};
}

HostConstraint ToHost(const Constraint& constraint,
                      const Eigen::Quaterniond& gravity_alignment) {
  // (submap <- tracking frame of the node)
  const transform::Rigid3d zbar_ij =
      ToHost(constraint.T_submap_node) *
      transform::Rigid3d::Rotation(gravity_alignment);
  return HostConstraint{
      ToHost(constraint.submap),
      ToHost(constraint.node),
      {zbar_ij, constraint.translation_weight, constraint.rotation_weight},
      constraint.tag == Constraint::Tag::kInterSubmap
          ? HostConstraint::INTER_SUBMAP
          : HostConstraint::INTRA_SUBMAP};
}

PoseGraph ConstraintsFromHost(const std::vector<HostConstraint>& constraints) {
  PoseGraph graph;
  for (const HostConstraint& constraint : constraints) {
    graph.constraints.push_back(
        {FromHost(constraint.submap_id), FromHost(constraint.node_id),
         FromHost(constraint.pose.zbar_ij), constraint.pose.translation_weight,
         constraint.pose.rotation_weight,
         constraint.tag == HostConstraint::INTER_SUBMAP
             ? Constraint::Tag::kInterSubmap
             : Constraint::Tag::kIntraSubmap});
  }
  return graph;
}

std::optional<OccupancyGrid> CopyGrid(const mapping::Submap& submap) {
  const auto* const planar = dynamic_cast<const mapping::Submap2D*>(&submap);
  if (planar == nullptr || planar->grid() == nullptr) return std::nullopt;
  // Uses the serialized form, whose conversion supports all kinds of grids.
  proto::Grid2D copy;
  if (!copy.ParseFromString(planar->grid()
                                ->ComputeCroppedGrid()
                                ->ToProto()
                                .SerializeAsString())) {
    return std::nullopt;
  }
  absl::StatusOr<OccupancyGrid> converted =
      MakeOccupancyGrid(copy, FromHost(submap.local_pose()));
  if (!converted.ok()) return std::nullopt;
  return *std::move(converted);
}

}  // namespace cartographer_sdf
