// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/constraint_generation.h"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "cartographer_sdf/geometry/evenly_spaced.h"
#include "cartographer_sdf/verification/agreement.h"
#include "cartographer_sdf/verification/registration.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Gives every point the same certainty.
std::vector<SurfacePoint> ToSurfacePoints(const PointCloud2& point_cloud) {
  std::vector<SurfacePoint> points;
  points.reserve(point_cloud.size());
  for (const Eigen::Vector2f& point : point_cloud) {
    points.push_back({point.cast<double>(), 1.});
  }
  return points;
}

// Registers the node's own scan to the submap; returns nullopt if the result is
// implausible.
std::optional<Rigid2> RegisterNode(const ConstraintOptions& options,
                                   const SurfaceModel& submap,
                                   const std::vector<SurfacePoint>& scan,
                                   const Rigid2& guess_T_submap_node) {
  const PosePrior prior{options.translation_sigma_meters,
                        options.rotation_sigma};
  const std::optional<Rigid2> T_submap_node = RegisterPoints(
      RegistrationOptions(), submap, scan, guess_T_submap_node, prior);
  if (!T_submap_node) return std::nullopt;
  const Rigid2 moved = guess_T_submap_node.Inverse() * *T_submap_node;
  if (moved.translation().norm() >
          options.max_num_sigmas * options.translation_sigma_meters ||
      std::abs(moved.rotation()) >
          options.max_num_sigmas * options.rotation_sigma) {
    return std::nullopt;
  }
  AgreementOptions agreement;
  agreement.max_num_points = std::numeric_limits<int>::max();
  if (MeasureAgreement(agreement, submap, scan, *T_submap_node).HitRatio() <
      options.min_hit_ratio) {
    return std::nullopt;
  }
  return T_submap_node;
}

// Appends constraints between nodes of another submap and `submap`.
void AppendConstraints(const ConstraintOptions& options, const SubmapId& submap,
                       const SurfaceModel& surface, const InsertedNodes& nodes,
                       const Rigid2& T_submap_other, const ScansByNode& scans,
                       std::vector<Constraint>* const constraints) {
  for (const auto& [node, T_other_node] : ChooseNodes(options, nodes)) {
    std::optional<Rigid2> T_submap_node = T_submap_other * T_other_node;
    const auto scan = scans.find(node);
    if (scan != scans.end() && !scan->second.empty()) {
      T_submap_node = RegisterNode(
          options, surface, ToSurfacePoints(scan->second), *T_submap_node);
    }
    if (!T_submap_node) continue;
    constraints->push_back(
        Constraint{submap, node, *T_submap_node, options.translation_weight,
                   options.rotation_weight, Constraint::Tag::kInterSubmap});
  }
}

}  // namespace

std::string Validate(const ConstraintOptions& options) {
  if (options.num_nodes_per_submap < 1) {
    return "num_nodes_per_submap must be positive";
  }
  if (options.min_num_constraints < 1 ||
      options.min_num_constraints > 2 * options.num_nodes_per_submap) {
    return "min_num_constraints must be positive and at most twice "
           "num_nodes_per_submap";
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

std::map<SubmapId, InsertedNodes> FindInsertedNodes(
    const PoseGraph& pose_graph) {
  std::map<SubmapId, InsertedNodes> nodes;
  for (const Constraint& constraint : pose_graph.constraints) {
    if (constraint.tag != Constraint::Tag::kIntraSubmap) continue;
    nodes[constraint.submap].emplace(constraint.node, constraint.T_submap_node);
  }
  return nodes;
}

InsertedNodes ChooseNodes(const ConstraintOptions& options,
                          const InsertedNodes& nodes) {
  const std::vector<std::pair<NodeId, Rigid2>> all(nodes.begin(), nodes.end());
  InsertedNodes chosen;
  for (const size_t k : EvenlySpacedIndices(
           all.size(), static_cast<size_t>(options.num_nodes_per_submap))) {
    chosen.insert(all[k]);
  }
  return chosen;
}

std::vector<Constraint> GenerateConstraints(
    const ConstraintOptions& options, const PairPose& pair,
    const std::map<SubmapId, InsertedNodes>& nodes,
    const SurfaceModel& reference, const SurfaceModel& query,
    const ScansByNode& scans) {
  CHECK_EQ(Validate(options), "");
  std::vector<Constraint> constraints;
  if (const auto of_query = nodes.find(pair.query); of_query != nodes.end()) {
    AppendConstraints(options, pair.reference, reference, of_query->second,
                      pair.T_reference_query, scans, &constraints);
  }
  if (const auto of_reference = nodes.find(pair.reference);
      of_reference != nodes.end()) {
    AppendConstraints(options, pair.query, query, of_reference->second,
                      pair.T_reference_query.Inverse(), scans, &constraints);
  }
  return constraints;
}

}  // namespace cartographer_sdf
