// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// From the stored pose graph, in space, to ours, in the plane. The message of
// an error is a predicate ("has node 0,5 twice").
//
// The node frame of PoseGraph is the gravity-aligned one, so poses of nodes and
// constraints are multiplied by the inverse of the node's gravity alignment,
// which only the node's own record has, before they are projected.

#ifndef CARTOGRAPHER_SDF_PBSTREAM_POSE_GRAPH_CODEC_H_
#define CARTOGRAPHER_SDF_PBSTREAM_POSE_GRAPH_CODEC_H_

#include <Eigen/Geometry>
#include <map>
#include <optional>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_sdf/geometry/rigid3.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/serialized_state.pb.h"

namespace cartographer_sdf {

// Values of Constraint.tag in the file.
constexpr int kIntraSubmapTag = 0;
constexpr int kInterSubmapTag = 1;

// Of a node's own record.
struct NodeAttitude {
  Eigen::Quaterniond gravity_alignment = Eigen::Quaterniond::Identity();
  // (local <- tracking frame)
  std::optional<Rigid3> local_pose;
};

// Nodes that are absent have no record of their own.
using Attitudes = std::map<NodeId, NodeAttitude>;

// An absent gravity alignment is none.
[[nodiscard]] absl::StatusOr<NodeAttitude> ReadNodeAttitude(
    const proto::NodeData& data);

// Whether ToPoseGraph can take it: ids unique, non-negative and known where
// they are referred to, poses valid, weights finite and not negative.
[[nodiscard]] absl::Status CheckPoseGraph(const proto::PoseGraph& stored);

// `stored` must have passed the check. Nodes without attitude get an identity
// gravity alignment. Odometry is left absent.
[[nodiscard]] PoseGraph ToPoseGraph(const proto::PoseGraph& stored,
                                    const Attitudes& attitudes);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_POSE_GRAPH_CODEC_H_
