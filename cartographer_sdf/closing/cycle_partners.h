// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Finds the pairs of closures whose cycle can say something, without looking at
// all pairs. Odometry joins their ends; its uncertainty grows with the distance
// driven, so both ends of one closure must lie near those of the other along
// the trajectories.

#ifndef CARTOGRAPHER_SDF_CLOSING_CYCLE_PARTNERS_H_
#define CARTOGRAPHER_SDF_CLOSING_CYCLE_PARTNERS_H_

#include <cstddef>
#include <map>
#include <vector>

#include "cartographer_sdf/closing/consistency.h"

namespace cartographer_sdf {

// Closures with ends on the same two stretches of trajectory, of the length of
// DrivenReach, that others are compared with: the weightiest. Where a robot
// drives, a stretch holds fewer submaps than would make so many.
constexpr size_t kMaxNumClosuresPerCell = 100;

// Returns the longest drive between two closures, at either pair of ends, after
// which their cycle can still be informative [m]; infinite where odometry has
// no error. Zero if no cycle is.
[[nodiscard]] double DrivenReach(const ConsistencyOptions& options);

// Returns for each closure the indices of its partners, ascending: all others
// with which CheckCycle does not return kUninformative, and some with which it
// does. Symmetric. Where more than kMaxNumClosuresPerCell closures join two
// stretches, they and those near them only have the weightiest of them as
// partners, and those that have them. `odometry` must contain all ends.
//
// Linear in the number of closures, up to a logarithm, as no closure has more
// than 18 cells around it.
[[nodiscard]] std::vector<std::vector<size_t>> FindCyclePartners(
    const ConsistencyOptions& options,
    const std::map<SubmapId, OdometryPose>& odometry,
    const std::vector<PairPose>& closures);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CLOSING_CYCLE_PARTNERS_H_
