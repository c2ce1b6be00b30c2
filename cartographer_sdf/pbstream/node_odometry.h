// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_PBSTREAM_NODE_ODOMETRY_H_
#define CARTOGRAPHER_SDF_PBSTREAM_NODE_ODOMETRY_H_

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_sdf/geometry/rigid3.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

// Interpolates an odometry stream at the times of nodes, as the host does when
// it optimises: translation linearly, rotation along the shortest arc, nothing
// before the first or after the last measurement. Memory is one pose per node,
// regardless of the length of the stream. Times are as in the file [100 ns].
class NodeOdometry {
 public:
  explicit NodeOdometry(const std::map<NodeId, Node>& nodes);

  // Measurements of a trajectory must come in strictly increasing time order,
  // as the host requires too; those of trajectories without nodes are ignored.
  // The message of an error is a predicate.
  [[nodiscard]] absl::Status Add(int trajectory, int64_t time,
                                 const Rigid3& pose);

  // (odometry frame <- tracking frame) at the nodes' times.
  [[nodiscard]] const std::map<NodeId, Rigid3>& poses() const { return poses_; }

 private:
  struct Measurement {
    int64_t time;
    Rigid3 pose;
  };
  struct TrajectoryState {
    // In time order; nodes before `next` are done.
    std::vector<std::pair<int64_t, NodeId>> nodes;
    size_t next = 0;
    std::optional<Measurement> last;
  };

  std::map<int, TrajectoryState> trajectories_;
  std::map<NodeId, Rigid3> poses_;
};

// Sets T_previous_node_by_odometry of each node for which both the node and its
// predecessor by index have odometry. Gravity alignments must be set.
void SetRelativeOdometry(const std::map<NodeId, Rigid3>& odometry,
                         std::map<NodeId, Node>* nodes);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_NODE_ODOMETRY_H_
