// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Asks for the rivals of a placement before it is believed. In a building of
// equal rooms, what the query shows suits the room next door as well, and
// matching need not have tried it there. The poses in which the submaps of
// either map resemble themselves, periods and half turns, are applied to the
// votes of the placement, and all that are found so are measured alike.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_RIVAL_PLACEMENTS_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_RIVAL_PLACEMENTS_H_

#include <cstddef>
#include <vector>

#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/grid/pair_pose.h"
#include "cartographer_sdf/localization/confirmation.h"
#include "cartographer_sdf/localization/placement.h"

namespace cartographer_sdf {

// A rival with this share of the evidence of the best placement is a reason to
// doubt that. Scores are sums that grow with what was seen of one place, right
// or wrong.
constexpr double kRivalShare = 0.5;

// A placement by what the walls say where it makes the maps overlap.
struct MeasuredPlacement {
  // As MeasurePlacement(); its agreeing pairs are what the placement's votes
  // index. Without any, the placement has the score zero.
  Confirmation confirmation;
  Placement placement;
};

// The placement that `votes` agree on, and those that do as well on what both
// maps show: those that reach kRivalShare of its score, that it leads by less
// than PlacementOptions::min_lead, and that are neither contradicted nor
// crossed by walls (PlacementOptions). Best first, at most three. Verifies at
// most `max_num_pairs` pairs for each, beside those of the votes.
struct Contest {
  MeasuredPlacement placement;  // not measured if it has no rivals
  std::vector<MeasuredPlacement> rivals;
};
[[nodiscard]] Contest FindRivalPlacements(const LocalizationTask& task,
                                          const std::vector<PairPose>& votes,
                                          size_t max_num_pairs,
                                          const Executor& executor);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_RIVAL_PLACEMENTS_H_
