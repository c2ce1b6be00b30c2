// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Where in the map do several matches put one query? Matches that agree on a
// pose are added up, and held against those that agree on another one. A young
// query sees too little for most of them to be certain by themselves; what is
// likely counts, too, where it agrees with one that is certain.

#ifndef CARTOGRAPHER_SDF_LIVE_LOCATION_H_
#define CARTOGRAPHER_SDF_LIVE_LOCATION_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/live/live_options.h"

namespace cartographer_sdf {

// A match of the query with one submap of the map.
struct PoseVote {
  Rigid2 T_map_query;
  double score = 0.;         // log-odds
  bool is_accepted = false;  // by verification
  // Not refused for what it shows; that it shows too little is no reason.
  bool is_likely = false;
};

struct Location {
  Rigid2 T_map_query;  // of the best of the supporters
  // Of the accepted and the likely votes for the pose.
  double score = 0.;
  // Of all votes for the best pose that is clearly another one; 0 where there
  // is none.
  double runner_up_score = 0.;
  // Indices of these votes, best first.
  std::vector<size_t> supporters;
};

// Whether two poses count as the same.
[[nodiscard]] bool IsSamePose(const LocalizationOptions& options,
                              const Rigid2& T_map_a, const Rigid2& T_map_b);

// The pose with the largest sum; none where no vote is accepted. Votes with a
// negative score count for nothing.
[[nodiscard]] std::optional<Location> FindLocation(
    const LocalizationOptions& options, const std::vector<PoseVote>& votes);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_LOCATION_H_
