// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Groups constraints by the relative pose of two submaps that they imply. A
// constraint relates a node to a submap, but the node's scan was also inserted
// into other submaps. Each inter-submap constraint therefore implies a relative
// pose of two submaps, which can be verified, and many imply the same one.

#ifndef CARTOGRAPHER_SDF_CLOSING_CONSTRAINT_GROUPS_H_
#define CARTOGRAPHER_SDF_CLOSING_CONSTRAINT_GROUPS_H_

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

struct GroupingOptions {
  // Constraints of one pair of submaps belong together if their poses differ by
  // less than this at the centroid of the query [m], [rad]: the amount by which
  // submaps bend.
  double max_distance_meters = 0.5;
  double max_rotation = 0.15;
};
[[nodiscard]] std::string Validate(const GroupingOptions& options);

struct ConstraintGroup {
  SubmapId reference;
  SubmapId query;  // reference < query
  // Implied by the constraint that is near most others.
  Rigid2 T_reference_query;
  // Indices into PoseGraph::constraints, ascending; at least one.
  std::vector<size_t> constraints;
};

struct GroupedConstraints {
  // Ordered by reference, query and first constraint.
  std::vector<ConstraintGroup> groups;
  // Inter-submap constraints that relate no two of the known submaps: their
  // submap is unknown, or no other known submap contains their node's scan.
  std::vector<size_t> unrelated;
};

// Groups the inter-submap constraints. `centroids` has the centroids of the
// known submaps, in their own frames. Of the submaps into which a node was
// inserted, except that of the constraint, the one counts in which the node is
// nearest to the middle of the scans, as it contains most of the surroundings.
// Quadratic in the number of constraints of one pair.
[[nodiscard]] GroupedConstraints GroupConstraints(
    const GroupingOptions& options, const PoseGraph& pose_graph,
    const std::map<SubmapId, Eigen::Vector2d>& centroids);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CLOSING_CONSTRAINT_GROUPS_H_
