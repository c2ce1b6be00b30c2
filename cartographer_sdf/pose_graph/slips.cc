// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pose_graph/slips.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace cartographer_sdf {
namespace {

double SlipAngle(const Step& step) {
  return NormalizeAngle(step.T_previous_node_by_local_slam.rotation() -
                        step.T_previous_node_by_odometry.rotation());
}

}  // namespace

std::optional<Step> StepTo(const PoseGraph& pose_graph,
                           const std::map<NodeId, Node>::const_iterator it) {
  if (it == pose_graph.nodes.begin()) return std::nullopt;
  const auto& [from_id, from] = *std::prev(it);
  const auto& [id, to] = *it;
  if (from_id.trajectory != id.trajectory || from_id.index + 1 != id.index ||
      !from.T_local_node || !to.T_local_node ||
      !to.T_previous_node_by_odometry) {
    return std::nullopt;
  }
  return Step{from.T_local_node->Inverse() * *to.T_local_node,
              *to.T_previous_node_by_odometry};
}

bool IsSlip(const double min_angle, const Step& step) {
  return std::abs(SlipAngle(step)) > min_angle;
}

Slips FindSlips(const double min_angle, const PoseGraph& pose_graph) {
  Slips slips;
  for (auto it = pose_graph.nodes.begin(); it != pose_graph.nodes.end(); ++it) {
    const std::optional<Step> step = StepTo(pose_graph, it);
    if (step && IsSlip(min_angle, *step)) {
      slips.emplace(it->first, SlipAngle(*step));
    }
  }
  return slips;
}

std::set<SubmapId> SubmapsWithSlips(const Slips& slips,
                                    const PoseGraph& pose_graph) {
  std::set<SubmapId> submaps;
  if (slips.empty()) return submaps;
  // First and last node that each submap was built from.
  std::map<SubmapId, std::pair<NodeId, NodeId>> extents;
  for (const Constraint& constraint : pose_graph.constraints) {
    if (constraint.tag != Constraint::Tag::kIntraSubmap) continue;
    auto& [first, last] =
        extents
            .emplace(constraint.submap,
                     std::pair(constraint.node, constraint.node))
            .first->second;
    first = std::min(first, constraint.node);
    last = std::max(last, constraint.node);
  }
  for (const auto& [id, extent] : extents) {
    const auto slip = slips.upper_bound(extent.first);
    if (slip != slips.end() && !(extent.second < slip->first)) {
      submaps.insert(id);
    }
  }
  return submaps;
}

}  // namespace cartographer_sdf
