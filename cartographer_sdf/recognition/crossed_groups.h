// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Groups of matches between two trajectories that walls refute. Matches that
// support each other say how the two lie. Where that puts long straight walls
// of one across free space of the other, in the matched pairs and in those
// around them, they show different places that look alike: two halls may share
// a corner and two walls to the centimetre, and no pair of submaps tells.
//
// Within one trajectory, submaps that local SLAM tore cross those that they
// match rightly, and closures are compared with each other instead.

#ifndef CARTOGRAPHER_SDF_RECOGNITION_CROSSED_GROUPS_H_
#define CARTOGRAPHER_SDF_RECOGNITION_CROSSED_GROUPS_H_

#include <vector>

#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/match_support.h"
#include "cartographer_sdf/recognition/neighbourhood.h"
#include "cartographer_sdf/verification/verification.h"

namespace cartographer_sdf {

// Sets the verdict of accepted matches between two maps, or two trajectories of
// one, to kContradicted where their group is crossed (see IsCrossed).
// NeighbourhoodMaps::own_matches is not used. Takes as long as registering
// kMaxNumCrossingPairs pairs, for each group.
void RefuseCrossedGroups(const VerificationOptions& verification,
                         const NeighbourhoodOptions& neighbourhood,
                         const MatchSupportOptions& support,
                         const NeighbourhoodMaps& maps,
                         const Executor& executor, std::vector<Match>* matches);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECOGNITION_CROSSED_GROUPS_H_
