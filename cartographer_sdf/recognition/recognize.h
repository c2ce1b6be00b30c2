// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Finds all matches within a map or between two maps: selects pairs of submaps,
// matches each, and verifies their neighbourhoods.

#ifndef CARTOGRAPHER_SDF_RECOGNITION_RECOGNIZE_H_
#define CARTOGRAPHER_SDF_RECOGNITION_RECOGNIZE_H_

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/execution/stage_clock.h"
#include "cartographer_sdf/matching/place_index.h"
#include "cartographer_sdf/place/trajectory_places.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/match_support.h"
#include "cartographer_sdf/recognition/neighbourhood.h"
#include "cartographer_sdf/recognition/rival_matches.h"
#include "cartographer_sdf/recognition/trajectory_links.h"

namespace cartographer_sdf {

struct RecognitionOptions {
  MatchOptions match;
  // Submaps of one trajectory are matched if their indices differ by at least
  // this; nearer ones share scans.
  int min_index_gap = 3;
  // Whether to match only pairs that an index of all submaps proposes;
  // otherwise all are matched, and time grows with the square of the number of
  // submaps.
  bool use_retrieval = true;
  RetrievalOptions retrieval;
  // Whether to verify matches together with the neighbours of both submaps.
  // Localization verifies whole placements instead (localization/).
  bool verify_neighbourhoods = true;
  TrajectoryLinkOptions links;
  NeighbourhoodOptions neighbourhood;
  // Both are applied together with the verification of neighbourhoods, as is
  // match.verification.crossing.
  RivalMatchOptions rivals;
  MatchSupportOptions support;
};
[[nodiscard]] std::string Validate(const RecognitionOptions& options);

// Matches the unordered pairs of submaps of one map, the lower id as the
// reference, without pairs that share scans. Pairs without a pose worth
// reporting yield no match. Returns matches in the order of the ids.
[[nodiscard]] std::vector<Match> RecognizeWithin(
    const RecognitionOptions& options, const TrajectoryPlaces& map,
    const Executor& executor, StageClock* clock);

// Matches references of one map with queries of another, in the same way.
[[nodiscard]] std::vector<Match> RecognizeBetween(
    const RecognitionOptions& options, const TrajectoryPlaces& references,
    const TrajectoryPlaces& queries, const Executor& executor,
    StageClock* clock);

// Does the same for queries that come one after the other. The references, all
// queries and the executor must outlive it. Thread-compatible.
class IncrementalRecognition {
 public:
  IncrementalRecognition(const RecognitionOptions& options,
                         const TrajectoryPlaces& references,
                         const TrajectoryPlaces& queries,
                         const Executor& executor);

  // Matches `queries`, some of those given to the constructor that were not
  // matched before. Returns the matches of all so far, verified together.
  [[nodiscard]] std::vector<Match> Add(const std::map<SubmapId, Place>& queries,
                                       const ProgressCallback& on_progress);

 private:
  const RecognitionOptions options_;
  NeighbourhoodMaps maps_;
  const Executor& executor_;
  std::optional<TrajectoryLinks> reference_links_, query_links_;
  std::vector<Match> matches_;  // of each pair by itself
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECOGNITION_RECOGNIZE_H_
