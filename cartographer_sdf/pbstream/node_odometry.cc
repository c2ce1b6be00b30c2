// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/node_odometry.h"

#include <algorithm>

namespace cartographer_sdf {
namespace {

Rigid3 Interpolate(const Rigid3& start, const Rigid3& end,
                   const double fraction) {
  return Rigid3{
      start.translation + fraction * (end.translation - start.translation),
      start.rotation.slerp(fraction, end.rotation).normalized()};
}

// For ordered times; their difference may exceed int64_t.
double Duration(const int64_t start, const int64_t end) {
  return static_cast<double>(static_cast<uint64_t>(end) -
                             static_cast<uint64_t>(start));
}

}  // namespace

NodeOdometry::NodeOdometry(const std::map<NodeId, Node>& nodes) {
  for (const auto& [id, node] : nodes) {
    trajectories_[id.trajectory].nodes.emplace_back(node.time, id);
  }
  for (auto& [trajectory, state] : trajectories_) {
    std::sort(state.nodes.begin(), state.nodes.end());
  }
}

absl::Status NodeOdometry::Add(const int trajectory, const int64_t time,
                               const Rigid3& pose) {
  const auto it = trajectories_.find(trajectory);
  if (it == trajectories_.end()) return absl::OkStatus();
  TrajectoryState& state = it->second;
  if (state.last.has_value() && time <= state.last->time) {
    return absl::DataLossError("has odometry that is not in time order");
  }
  for (; state.next < state.nodes.size(); ++state.next) {
    const auto& [node_time, id] = state.nodes[state.next];
    if (node_time > time) break;
    if (node_time == time) {
      poses_.emplace(id, pose);
    } else if (state.last.has_value()) {
      const double fraction = Duration(state.last->time, node_time) /
                              Duration(state.last->time, time);
      poses_.emplace(id, Interpolate(state.last->pose, pose, fraction));
    }
  }
  state.last = Measurement{time, pose};
  return absl::OkStatus();
}

void SetRelativeOdometry(const std::map<NodeId, Rigid3>& odometry,
                         std::map<NodeId, Node>* const nodes) {
  for (auto& [id, node] : *nodes) {
    const NodeId previous_id{id.trajectory, id.index - 1};
    const auto previous = nodes->find(previous_id);
    const auto first = odometry.find(previous_id);
    const auto second = odometry.find(id);
    if (previous == nodes->end() || first == odometry.end() ||
        second == odometry.end()) {
      continue;
    }
    node.T_previous_node_by_odometry =
        Project2D(Rigid3::Rotation(previous->second.gravity_alignment) *
                  first->second.Inverse() * second->second *
                  Rigid3::Rotation(node.gravity_alignment.conjugate()));
  }
}

}  // namespace cartographer_sdf
