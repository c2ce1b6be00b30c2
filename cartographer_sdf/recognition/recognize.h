// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// All matches within a map or between two maps: which pairs of submaps are
// compared, how each is matched, and the verification of their neighbourhoods.

#ifndef CARTOGRAPHER_SDF_RECOGNITION_RECOGNIZE_H_
#define CARTOGRAPHER_SDF_RECOGNITION_RECOGNIZE_H_

#include <map>
#include <string>
#include <vector>

#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/execution/stage_clock.h"
#include "cartographer_sdf/matching/place_index.h"
#include "cartographer_sdf/place/trajectory_places.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/neighbourhood.h"

namespace cartographer_sdf {

struct RecognitionOptions {
  MatchOptions match;
  // Submaps of one trajectory are matched from this difference of their indices
  // on; nearer ones share scans.
  int min_index_gap = 3;
  // Whether only pairs that an index of all features proposes are matched; else
  // all are, and time grows with the square of the number of submaps.
  bool use_retrieval = false;
  RetrievalOptions retrieval;
  // Whether matches are verified together with the neighbours of both submaps.
  // Localization verifies whole placements instead (localization/).
  bool verify_neighbourhoods = true;
  NeighbourhoodOptions neighbourhood;
};
[[nodiscard]] std::string Validate(const RecognitionOptions& options);

// Matches of unordered pairs of one map, the lower id as the reference, without
// pairs that share scans. Pairs without a pose worth reporting yield none; the
// order is that of the ids.
[[nodiscard]] std::vector<Match> RecognizeWithin(
    const RecognitionOptions& options, const TrajectoryPlaces& map,
    const Executor& executor, StageClock* clock);

// Matches of a reference of one map and a query of another, in the same way.
[[nodiscard]] std::vector<Match> RecognizeBetween(
    const RecognitionOptions& options, const TrajectoryPlaces& references,
    const TrajectoryPlaces& queries, const Executor& executor,
    StageClock* clock);

// The same without their neighbourhoods.
[[nodiscard]] std::vector<Match> MatchBetween(
    const RecognitionOptions& options,
    const std::map<SubmapId, Place>& references,
    const std::map<SubmapId, Place>& queries, const Executor& executor,
    const ProgressCallback& on_progress = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECOGNITION_RECOGNIZE_H_
