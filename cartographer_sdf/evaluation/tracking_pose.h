// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_EVALUATION_TRACKING_POSE_H_
#define CARTOGRAPHER_SDF_EVALUATION_TRACKING_POSE_H_

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/geometry/rigid3.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

// Where the robot was and looked (map <- tracking frame): with IMU or odometry,
// the node frame of the pose graph is turned against it by any yaw.
[[nodiscard]] inline Rigid2 TrackingPose(const Node& node) {
  return Project2D(Embed3D(node.T_map_node) *
                   Rigid3::Rotation(node.gravity_alignment));
}

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_TRACKING_POSE_H_
