// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Converts the stored 3D pose graph to our planar one and back. The message of
// an error is a predicate ("has node 0,5 twice").
//
// The node frame of PoseGraph is gravity-aligned, so poses of nodes and
// constraints are multiplied by the inverse of the node's gravity alignment,
// which only the node's own record has, before they are projected.

#ifndef CARTOGRAPHER_SDF_PBSTREAM_POSE_GRAPH_CODEC_H_
#define CARTOGRAPHER_SDF_PBSTREAM_POSE_GRAPH_CODEC_H_

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <set>

#include "absl/status/statusor.h"
#include "cartographer_sdf/geometry/rigid3.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/serialized_state.pb.h"

namespace cartographer_sdf {

// Content of a node's own record.
struct NodeAttitude {
  Eigen::Quaterniond gravity_alignment = Eigen::Quaterniond::Identity();
  // (local <- tracking frame)
  std::optional<Rigid3> local_pose;
};

// Absent nodes have no record of their own.
using Attitudes = std::map<NodeId, NodeAttitude>;

// The elements of a stored pose graph that have a record of their own.
struct RecordedElements {
  Attitudes attitudes;  // of the nodes
  std::set<SubmapId> submaps;
};

// Removes the submaps and nodes that have no record of their own, and their
// constraints: the host aborts on a constraint of what it has no data of.
// Returns whether there were any.
bool DropUnrecorded(const RecordedElements& recorded, proto::PoseGraph* stored);
bool DropUnrecorded(const RecordedElements& recorded, PoseGraph* graph);

// An absent gravity alignment means the identity.
[[nodiscard]] absl::StatusOr<NodeAttitude> ReadNodeAttitude(
    const proto::NodeData& data);

// Nodes without attitude get an identity gravity alignment. Odometry is left
// absent. Fails unless ids are unique, non-negative and known where they are
// referenced, poses valid, weights finite and non-negative, and intra-submap
// constraints unique; the attitudes do not affect these checks.
[[nodiscard]] absl::StatusOr<PoseGraph> ToPoseGraph(
    const proto::PoseGraph& stored, const Attitudes& attitudes);

// Writes the differences between `before`, which ToPoseGraph() made from
// `stored`, and `after` to `stored`, as the host writes an optimised graph:
// planar poses times the gravity alignment of `before`. Nodes, submaps and
// landmarks that `after` lacks stay unchanged; for constraints see WriteMap().
// Returns whether anything differed.
//
// Fails if `after` has an element that `before` lacks, or non-finite numbers;
// the message is a predicate, and `stored` is then partly written.
[[nodiscard]] absl::StatusOr<bool> UpdatePoseGraph(const PoseGraph& before,
                                                   const PoseGraph& after,
                                                   proto::PoseGraph* stored);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_POSE_GRAPH_CODEC_H_
