// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The consistent ones among closures between two maps.

#ifndef CARTOGRAPHER_SDF_LOOP_CLOSING_SELECTION_BETWEEN_H_
#define CARTOGRAPHER_SDF_LOOP_CLOSING_SELECTION_BETWEEN_H_

#include <vector>

#include "cartographer_sdf/closure/consistency.h"
#include "cartographer_sdf/pbstream/map_file.h"

namespace cartographer_sdf {

// SelectConsistent for closures whose reference lies in one map and whose query
// in another, joined by the odometry of each. Trajectories of the two maps are
// different ones even where their ids are equal.
[[nodiscard]] std::vector<SelectionResult> SelectConsistentBetween(
    const ConsistencyOptions& options, const MapState& reference_map,
    const MapState& query_map, const std::vector<LoopClosure>& closures);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOOP_CLOSING_SELECTION_BETWEEN_H_
