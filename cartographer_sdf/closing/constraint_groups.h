// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A constraint holds a node against a submap; but the node's scan stands in
// submaps of its own. So each inter-submap constraint says where two submaps
// lie, which can be checked, and many of them say the same.

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
  // Constraints of one pair of submaps belong together where they put the
  // centroid of the query less than this apart [m], [rad]: what submaps bend.
  double max_distance_meters = 0.5;
  double max_rotation = 0.15;
};
[[nodiscard]] std::string Validate(const GroupingOptions& options);

struct ConstraintGroup {
  SubmapId reference;
  SubmapId query;  // reference < query
  // Of the constraint that most others are near to.
  Rigid2 T_reference_query;
  // Indices into PoseGraph::constraints, ascending; at least one.
  std::vector<size_t> constraints;
};

struct GroupedConstraints {
  // By reference, query and first constraint.
  std::vector<ConstraintGroup> groups;
  // Inter-submap constraints that relate no two of the known submaps: their
  // submap is not known, or no other known submap holds their node's scan.
  std::vector<size_t> unrelated;
};

// Groups the inter-submap constraints. `centroids` are points of the known
// submaps around which they extend, in their own frames. Of the submaps into
// which a node was inserted, that of the constraint aside, the one counts in
// which it is nearest to the middle of the scans: it saw most of the
// surroundings. Quadratic in the number of constraints of one pair.
[[nodiscard]] GroupedConstraints GroupConstraints(
    const GroupingOptions& options, const PoseGraph& pose_graph,
    const std::map<SubmapId, Eigen::Vector2d>& centroids);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CLOSING_CONSTRAINT_GROUPS_H_
