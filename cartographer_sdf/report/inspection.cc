// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/inspection.h"

#include <algorithm>

#include "cartographer_sdf/pose_graph/optimization.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// The first submap that both have; null if none.
const SubmapId* FirstCommonSubmap(const PoseGraph& a, const PoseGraph& b) {
  for (const auto& [id, pose] : a.submap_poses) {
    if (b.submap_poses.count(id) > 0) return &id;
  }
  return nullptr;
}

}  // namespace

const char* ToneName(const Tone tone) {
  switch (tone) {
    case Tone::kGood:
      return "good";
    case Tone::kNeutral:
      return "neutral";
    case Tone::kCaution:
      return "caution";
    case Tone::kBad:
      return "bad";
  }
  LOG(FATAL) << "no tone";
}

std::vector<Rigid2> AlignStates(const std::vector<InspectedState>& states) {
  std::vector<Rigid2> T_map_states;
  for (const InspectedState& state : states) {
    const PoseGraph& last = *states.back().pose_graph;
    const SubmapId* const id = FirstCommonSubmap(last, *state.pose_graph);
    T_map_states.push_back(
        id == nullptr || &state == &states.back()
            ? Rigid2()
            : last.submap_poses.at(*id) *
                  state.pose_graph->submap_poses.at(*id).Inverse());
  }
  return T_map_states;
}

std::optional<Displacement> DisplacementOf(
    const std::vector<InspectedState>& states) {
  if (states.size() < 2) return std::nullopt;
  const Rigid2 T_map_first = AlignStates(states).front();
  const std::map<NodeId, Node>& last = states.back().pose_graph->nodes;
  Displacement displacement;
  size_t num_nodes = 0;
  for (const auto& [id, node] : states.front().pose_graph->nodes) {
    const auto moved = last.find(id);
    if (moved == last.end()) continue;
    const double distance = (T_map_first * node.T_map_node.translation() -
                             moved->second.T_map_node.translation())
                                .norm();
    displacement.largest = std::max(displacement.largest, distance);
    displacement.mean += distance;
    ++num_nodes;
  }
  if (num_nodes == 0) return std::nullopt;
  displacement.mean /= static_cast<double>(num_nodes);
  return displacement;
}

std::map<SubmapId, double> SubmapErrors(const PoseGraph& constraints_of,
                                        const PoseGraph& poses) {
  std::map<SubmapId, std::pair<double, int>> sums;
  for (const Constraint& constraint : constraints_of.constraints) {
    if (constraint.tag != Constraint::Tag::kInterSubmap ||
        poses.submap_poses.count(constraint.submap) == 0 ||
        poses.nodes.count(constraint.node) == 0) {
      continue;
    }
    auto& [sum, count] = sums[constraint.submap];
    sum += ConstraintResidual(poses, constraint).translation;
    ++count;
  }
  std::map<SubmapId, double> errors;
  for (const auto& [id, sum] : sums) errors[id] = sum.first / sum.second;
  return errors;
}

}  // namespace cartographer_sdf
