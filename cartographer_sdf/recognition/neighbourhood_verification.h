// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Verifies matches together with the neighbourhoods of their submaps
// (neighbourhood.h), and finds matches that only neighbours propose.

#ifndef CARTOGRAPHER_SDF_RECOGNITION_NEIGHBOURHOOD_VERIFICATION_H_
#define CARTOGRAPHER_SDF_RECOGNITION_NEIGHBOURHOOD_VERIFICATION_H_

#include <vector>

#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/execution/progress.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/neighbourhood.h"

namespace cartographer_sdf {

// `matches` are of method kSdf, found by each pair of submaps by itself, in the
// order of their ids; the lower id first within one map. They take the place of
// maps.own_matches. Returns for each pair the pose that its neighbourhood
// makes most likely, with score and verdict based on the neighbourhood,
// including pairs that had no pose before. In the order of the ids.
[[nodiscard]] std::vector<Match> VerifyNeighbourhoods(
    const NeighbourhoodOptions& options, const MatchOptions& match_options,
    NeighbourhoodMaps maps, std::vector<Match> matches,
    const Executor& executor, const ProgressCallback& on_progress = {});

// Does the same for one match at its given pose: sets its score, verdict and
// neighbourhood evidence. Ignores its rivals and its proposals to other pairs.
void VerifyNeighbourhood(const NeighbourhoodOptions& options,
                         const MatchOptions& match_options,
                         const NeighbourhoodMaps& maps, Match* match);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECOGNITION_NEIGHBOURHOOD_VERIFICATION_H_
