// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Confirms a placement where it should hold: verifies the pairs of submaps that
// it makes overlap, only at the pose that the vote nearest to both predicts.
// Pairs that agree become votes themselves, so that the check spreads as far as
// the two maps overlap.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_CONFIRMATION_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_CONFIRMATION_H_

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "cartographer_sdf/closing/consistency.h"
#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/localization/placement.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/recognition/match.h"

namespace cartographer_sdf {

// A map or a query: its places and their layout. Neither is owned. Places of a
// map that are not in its layout are ignored.
struct PlacedMap {
  const std::map<SubmapId, Place>* places;
  const MapLayout* layout;
};

// Returns the pair at the pose, registered if the walls allow, with the verdict
// kContradicted; nullopt if no more than `max_contradiction_ratio` of the walls
// (mean of both directions) lie in the other's free space.
[[nodiscard]] std::optional<Match> FindContradiction(
    const VerificationOptions& options, double max_contradiction_ratio,
    const Place& reference, const Place& query,
    const Rigid2& T_reference_query);

// A pair of submaps that the placement makes overlap, a wall of one of which
// stands across the free space of the other.
struct CrossingWall {
  SubmapId reference;
  SubmapId query;
  double length = 0.;  // [m]
};

struct Confirmation {
  // Accepted at the predicted pose; without pairs that have voted already.
  std::vector<Match> agreeing;
  // Walls of one lie in the free space of the other.
  std::vector<Match> contradicting;
  // Of so many pairs, votes or not, those that are crossed by a wall longer
  // than CrossingOptions::max_wall_meters.
  size_t num_compared = 0;
  std::vector<CrossingWall> crossing_walls;
};

// Returns the fraction that contradict, of all places of the query with a match
// that agrees or contradicts; zero if there are none.
[[nodiscard]] double ContradictingFraction(
    const std::vector<Match>& agreeing,
    const std::vector<Match>& contradicting);

// The query to localise, the map, and the options. Nothing is owned.
struct LocalizationTask {
  const PlacementOptions& placement;
  const ConsistencyOptions& consistency;
  const MatchOptions& match;
  PlacedMap map;
  PlacedMap query;

  [[nodiscard]] MapPair layouts() const { return {map.layout, query.layout}; }
};

// Verifies at most `max_num_pairs` pairs, those near votes first. `votes` are
// those of the placement.
[[nodiscard]] Confirmation ConfirmPlacement(const LocalizationTask& task,
                                            std::vector<PairPose> votes,
                                            size_t max_num_pairs,
                                            const Executor& executor);

// The same, for comparing a placement with its rivals: a pair agrees if its
// walls make the pose more likely right than not, whatever other poses they
// suit as well. Scores are those of the pair alone, without a margin. The votes
// are measured like the pairs that they predict.
[[nodiscard]] Confirmation MeasurePlacement(const LocalizationTask& task,
                                            std::vector<PairPose> votes,
                                            size_t max_num_pairs,
                                            const Executor& executor);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_CONFIRMATION_H_
