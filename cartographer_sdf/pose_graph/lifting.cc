// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pose_graph/lifting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// (submap <- node) of the nodes whose scans the submap holds.
std::map<NodeId, Rigid2> InsertedNodes(const PoseGraph& pose_graph,
                                       const SubmapId& submap) {
  std::map<NodeId, Rigid2> nodes;
  for (const Constraint& constraint : pose_graph.constraints) {
    if (constraint.tag == Constraint::Tag::kIntraSubmap &&
        constraint.submap == submap) {
      nodes.emplace(constraint.node, constraint.T_submap_node);
    }
  }
  return nodes;
}

std::vector<NodeId> EvenlySpaced(const LiftingOptions& options,
                                 const std::map<NodeId, Rigid2>& nodes) {
  const size_t size = nodes.size();
  const size_t count =
      std::min(size, static_cast<size_t>(options.num_nodes_per_submap));
  std::vector<NodeId> all, chosen;
  for (const auto& entry : nodes) all.push_back(entry.first);
  for (size_t k = 0; k < count; ++k) {
    // The middles of `count` equal parts.
    chosen.push_back(all[(2 * k + 1) * size / (2 * count)]);
  }
  return chosen;
}

// The node's pose in the submap by its own scan; none where that can't be
// believed.
std::optional<Rigid2> RegisterNode(const LiftingOptions& options,
                                   const SurfaceModel& submap,
                                   const std::vector<SurfacePoint>& scan,
                                   const Rigid2& guess_T_submap_node) {
  const PosePrior prior{options.translation_sigma_meters,
                        options.rotation_sigma};
  const std::optional<Registration> registration = RegisterPoints(
      RegistrationOptions(), submap, scan, guess_T_submap_node, prior);
  if (!registration) return std::nullopt;
  const Rigid2& T_submap_node = registration->T_reference_query;
  const Rigid2 moved = guess_T_submap_node.Inverse() * T_submap_node;
  if (moved.translation().norm() >
          options.max_num_sigmas * options.translation_sigma_meters ||
      std::abs(moved.rotation()) >
          options.max_num_sigmas * options.rotation_sigma) {
    return std::nullopt;
  }
  const DirectedAgreement agreement =
      MeasureAgreement(AgreementOptions(), submap, scan, T_submap_node,
                       std::numeric_limits<size_t>::max());
  if (agreement.HitRatio() < options.min_hit_ratio) return std::nullopt;
  return T_submap_node;
}

// Constraints of nodes of `other` against `submap`.
std::vector<Constraint> LiftOneWay(
    const LiftingOptions& options, const PoseGraph& pose_graph,
    const SubmapId& submap, const SurfaceModel& surface, const SubmapId& other,
    const Rigid2& T_submap_other, const ScansByNode& scans) {
  const std::map<NodeId, Rigid2> nodes = InsertedNodes(pose_graph, other);
  std::vector<Constraint> constraints;
  for (const NodeId& node : EvenlySpaced(options, nodes)) {
    std::optional<Rigid2> T_submap_node = T_submap_other * nodes.at(node);
    const auto scan = scans.find(node);
    if (scan != scans.end()) {
      T_submap_node =
          RegisterNode(options, surface, scan->second, *T_submap_node);
    }
    if (!T_submap_node) continue;
    constraints.push_back(
        Constraint{submap, node, *T_submap_node, options.translation_weight,
                   options.rotation_weight, Constraint::Tag::kInterSubmap});
  }
  return constraints;
}

}  // namespace

std::string Validate(const LiftingOptions& options) {
  if (options.num_nodes_per_submap < 1) {
    return "num_nodes_per_submap must be positive";
  }
  if (!(options.translation_weight > 0. && options.rotation_weight > 0.)) {
    return "translation_weight and rotation_weight must be positive";
  }
  if (!(options.translation_sigma_meters > 0. && options.rotation_sigma > 0. &&
        options.max_num_sigmas > 0.)) {
    return "translation_sigma_meters, rotation_sigma and max_num_sigmas must "
           "be positive";
  }
  if (!(options.min_hit_ratio >= 0. && options.min_hit_ratio <= 1.)) {
    return "min_hit_ratio must lie between 0 and 1";
  }
  return "";
}

std::vector<NodeId> NodesToLift(const LiftingOptions& options,
                                const PoseGraph& pose_graph,
                                const SubmapId& submap) {
  CHECK_EQ(Validate(options), "");
  return EvenlySpaced(options, InsertedNodes(pose_graph, submap));
}

std::vector<Constraint> LiftClosure(const LiftingOptions& options,
                                    const PoseGraph& pose_graph,
                                    const LoopClosure& closure,
                                    const SurfaceModel& reference,
                                    const SurfaceModel& query,
                                    const ScansByNode& scans) {
  CHECK_EQ(Validate(options), "");
  std::vector<Constraint> constraints =
      LiftOneWay(options, pose_graph, closure.reference, reference,
                 closure.query, closure.T_reference_query, scans);
  const std::vector<Constraint> backward =
      LiftOneWay(options, pose_graph, closure.query, query, closure.reference,
                 closure.T_reference_query.Inverse(), scans);
  constraints.insert(constraints.end(), backward.begin(), backward.end());
  return constraints;
}

}  // namespace cartographer_sdf
