// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_PBSTREAM_POSE_GRAPH_UPDATE_H_
#define CARTOGRAPHER_SDF_PBSTREAM_POSE_GRAPH_UPDATE_H_

#include "absl/status/statusor.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/serialized_state.pb.h"

namespace cartographer_sdf {

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

#endif  // CARTOGRAPHER_SDF_PBSTREAM_POSE_GRAPH_UPDATE_H_
