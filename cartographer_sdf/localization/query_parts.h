// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The parts of a query that lie in the map at poses of their own: a long drive
// that drifted, or a robot that was carried away in the middle of its
// trajectory, which odometry does not notice.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_QUERY_PARTS_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_QUERY_PARTS_H_

#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/closing/consistency.h"
#include "cartographer_sdf/localization/placement.h"

namespace cartographer_sdf {

struct QueryPart {
  Placement placement;
  // Its first and last place in the order of ids; places between them may
  // belong to other parts.
  SubmapId first;
  SubmapId last;
};

// Between two parts of one trajectory, one behind the other.
struct Jump {
  SubmapId before;  // the last place of the first part
  SubmapId after;   // the first place of the second
  // Motion of `after` from where the first part puts it to where the second
  // does [m].
  double distance = 0.;
};

struct QueryParts {
  // In the order of their first places; the best placement is one of them.
  std::vector<QueryPart> parts;
  // Beyond what both maps can have drifted between the two.
  std::vector<Jump> jumps;
};

// Of placements, best first, takes the first, and each other one that is
// certain by itself and has votes of places that none so far has.
[[nodiscard]] QueryParts FindQueryParts(
    const PlacementOptions& options, const ConsistencyOptions& consistency,
    const MapPair& maps, const std::vector<PairPose>& votes,
    const std::vector<Placement>& placements);

// Returns a clause for people that names the jumps; empty if there are none.
[[nodiscard]] std::string DescribeJumps(const std::vector<Jump>& jumps);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_QUERY_PARTS_H_
