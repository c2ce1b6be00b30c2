// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// From the stored pose graph, in space, to ours, in the plane, and back. The
// message of an error is a predicate ("has node 0,5 twice").
//
// The node frame of PoseGraph is the gravity-aligned one, so poses of nodes and
// constraints are multiplied by the inverse of the node's gravity alignment,
// which only the node's own record has, before they are projected.

#ifndef CARTOGRAPHER_SDF_PBSTREAM_POSE_GRAPH_CODEC_H_
#define CARTOGRAPHER_SDF_PBSTREAM_POSE_GRAPH_CODEC_H_

#include <Eigen/Geometry>
#include <map>
#include <optional>

#include "absl/status/statusor.h"
#include "cartographer_sdf/geometry/rigid3.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/serialized_state.pb.h"

namespace cartographer_sdf {

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

// Nodes without attitude get an identity gravity alignment. Odometry is left
// absent. An error unless ids are unique, non-negative and known where they are
// referred to, poses valid, weights finite and not negative; the attitudes make
// no difference to that.
[[nodiscard]] absl::StatusOr<PoseGraph> ToPoseGraph(
    const proto::PoseGraph& stored, const Attitudes& attitudes);

// Writes to `stored`, of which ToPoseGraph() made `before`, what differs in
// `after`, as the host writes an optimised graph: poses in the plane times the
// gravity alignment of `before`. What `after` lacks of nodes, submaps and
// landmarks stays as it is; for constraints see WriteMap(). Returns whether
// anything differed.
//
// An error if `after` has something that `before` has not, or numbers that are
// not finite; its message is a predicate, and `stored` is then half written.
[[nodiscard]] absl::StatusOr<bool> UpdatePoseGraph(const PoseGraph& before,
                                                   const PoseGraph& after,
                                                   proto::PoseGraph* stored);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_POSE_GRAPH_CODEC_H_
