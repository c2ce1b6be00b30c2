// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Matches that exclude each other. A submap that matches two others, which
// local SLAM puts far apart, lies in one place at most: in a building of equal
// rooms it resembles both, and nothing in either pair of submaps tells which.
// A rival takes from the score, and where the two are about as likely, neither
// is accepted.
//
// Local SLAM drifts, and the map of a loop that is not closed yet shows one
// place twice. Only what drift cannot explain is a rival, and nothing is one
// across a broken link (trajectory_links.h).

#ifndef CARTOGRAPHER_SDF_RECOGNITION_RIVAL_MATCHES_H_
#define CARTOGRAPHER_SDF_RECOGNITION_RIVAL_MATCHES_H_

#include <string>
#include <vector>

#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/neighbourhood.h"

namespace cartographer_sdf {

struct RivalMatchOptions {
  // Least lead of a match over each match that excludes it; log-odds.
  double min_lead = 1.5;
  // A match loses this fraction of ln(1 + odds) of its best rival: the
  // logarithm of how much likelier it becomes that it is wrong. Below one, as
  // the scores have learned from rivals within a pair already.
  double rival_weight = 0.5;
  // Two matches exclude each other if the poses that they give to the submap
  // that they share differ by more than this [m], [rad] ...
  double min_distance_meters = 1.5;
  double min_rotation = 0.3;
  // ... and more than local SLAM may have drifted between the other two: in
  // translation, as a fraction of the way, and in rotation [rad / sqrt(m)].
  double max_drift_per_meter = 0.04;
  double max_rotation_drift_per_sqrt_meter = 0.04;
};
[[nodiscard]] std::string Validate(const RivalMatchOptions& options);

// Lowers the scores of matches that others exclude, sets Match::has_rival, and
// sets verdicts to kAmbiguous if they were accepted and their leads or scores
// no longer suffice. `maps.own_matches` is not used. Independent of the order
// of the matches. For each submap, quadratic in the number of its matches.
void RefuseRivalMatches(const RivalMatchOptions& options,
                        const JudgementOptions& judgement,
                        const NeighbourhoodMaps& maps,
                        std::vector<Match>* matches);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECOGNITION_RIVAL_MATCHES_H_
