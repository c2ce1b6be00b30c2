// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Checks a placement where it should hold: every pair of submaps that it lays
// over each other, starting from the vote nearest to both, is verified at the
// predicted pose alone. Pairs that agree become votes themselves, and the check
// spreads as far as the two maps meet.

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

// A map or a query: its places and where they are. Neither is owned. Places of
// a map that are not in its layout take no part.
struct PlacedMap {
  const std::map<SubmapId, Place>* places;
  const MapLayout* layout;
};

// Whether the pose lays enough of the two over each other to tell whether they
// agree: a fraction of the smaller observed area.
[[nodiscard]] bool OverlapsEnough(const SurfaceModel& reference,
                                  const SurfaceModel& query,
                                  const Rigid2& T_reference_query);

// The pair at the pose, registered where the walls allow, with the verdict
// contradicted; none where no more than `max_contradiction_ratio` of the walls
// (mean of both directions) stand in the other's free space.
[[nodiscard]] std::optional<Match> FindContradiction(
    const VerificationOptions& options, double max_contradiction_ratio,
    const Place& reference, const Place& query,
    const Rigid2& T_reference_query);

struct Confirmation {
  // Accepted at the predicted pose; pairs that have voted already are skipped.
  std::vector<Match> agreeing;
  // Walls of one stand in the free space of the other.
  std::vector<Match> contradicting;
};

// What is to be localized in what, and how. Nothing is owned.
struct LocalizationTask {
  const PlacementOptions& placement;
  const ConsistencyOptions& consistency;
  const MatchOptions& match;
  PlacedMap map;
  PlacedMap query;

  [[nodiscard]] MapPair layouts() const { return {map.layout, query.layout}; }
};

// `votes` are those of the placement. Pairs near votes come first; at most
// `max_num_pairs` are verified.
[[nodiscard]] Confirmation ConfirmPlacement(const LocalizationTask& task,
                                            std::vector<PairPose> votes,
                                            size_t max_num_pairs,
                                            const Executor& executor);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_CONFIRMATION_H_
