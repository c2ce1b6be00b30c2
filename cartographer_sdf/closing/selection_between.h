// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The consistent ones among closures between two maps.

#ifndef CARTOGRAPHER_SDF_CLOSING_SELECTION_BETWEEN_H_
#define CARTOGRAPHER_SDF_CLOSING_SELECTION_BETWEEN_H_

#include <map>
#include <vector>

#include "cartographer_sdf/closing/consistency.h"
#include "cartographer_sdf/grid/pair_pose.h"
#include "cartographer_sdf/place/trajectory_places.h"

namespace cartographer_sdf {

// SelectConsistent for pairs whose reference lies in one map and whose query in
// another, joined by the odometry of each. Trajectories of the two maps are
// different ones even where their ids are equal.
[[nodiscard]] std::vector<SelectionResult> SelectConsistentBetween(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& reference_odometry,
    const std::map<SubmapId, OdometryPose>& query_odometry,
    const std::vector<PairPose>& pairs);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CLOSING_SELECTION_BETWEEN_H_
