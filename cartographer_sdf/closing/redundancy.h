// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Which closures would add nothing to a pose graph: those that its constraints
// say already, and those between submaps that better closures tie together
// often enough.

#ifndef CARTOGRAPHER_SDF_CLOSING_REDUNDANCY_H_
#define CARTOGRAPHER_SDF_CLOSING_REDUNDANCY_H_

#include <map>
#include <string>
#include <vector>

#include "cartographer_sdf/closing/constraint_generation.h"
#include "cartographer_sdf/grid/pair_pose.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

struct RedundancyOptions {
  // However the submaps are divided in two, at least so many closures between
  // the two parts stay, if there are so many. Larger: a stiffer graph and a
  // slower optimisation.
  int min_num_ties = 10;
};
[[nodiscard]] std::string Validate(const RedundancyOptions& options);

// Returns for each pair whether inter-submap constraints of the graph already
// tie its submaps at its pose: at least `min_num_constraints` of them place a
// node of one submap in the other as the pair does, to `max_num_sigmas`. So do
// the constraints that were generated of the same pair. `nodes` has the
// inserted nodes of the graph. Linear in constraints and pairs.
[[nodiscard]] std::vector<bool> AreInGraph(
    const ConstraintOptions& options,
    const std::map<SubmapId, InsertedNodes>& nodes, const PoseGraph& pose_graph,
    const std::vector<PairPose>& pairs);

// Returns for each pair whether to keep it: it belongs to one of `min_num_ties`
// disjoint spanning forests of the submaps, each of the pairs with the highest
// scores that the forests before it have left. At most min_num_ties pairs per
// submap are kept, and of the pairs between any two parts of the submaps
// min_num_ties at least, the one with the highest score among them
// [NagamochiIbaraki1992]. Independent of the order of the pairs.
[[nodiscard]] std::vector<bool> KeepTies(const RedundancyOptions& options,
                                         const std::vector<PairPose>& pairs);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CLOSING_REDUNDANCY_H_
