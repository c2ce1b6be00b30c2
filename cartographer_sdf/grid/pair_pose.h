// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_GRID_PAIR_POSE_H_
#define CARTOGRAPHER_SDF_GRID_PAIR_POSE_H_

#include <utility>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/submap_id.h"

namespace cartographer_sdf {

using IdPair = std::pair<SubmapId, SubmapId>;  // reference, query

// The pose of a query submap in the frame of a reference submap, and how
// certain it is.
struct PairPose {
  SubmapId reference;
  SubmapId query;
  Rigid2 T_reference_query;
  // Log-odds of being right; comparable across pairs and maps.
  double score = 0.;
};

// The order of all lists of pairs.
[[nodiscard]] inline bool IsBeforeByIds(const PairPose& a, const PairPose& b) {
  return a.reference != b.reference ? a.reference < b.reference
                                    : a.query < b.query;
}

// Order by score, the highest first; equal ones by ids.
[[nodiscard]] inline bool IsBeforeByScore(const PairPose& a,
                                          const PairPose& b) {
  return a.score != b.score ? a.score > b.score : IsBeforeByIds(a, b);
}

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_GRID_PAIR_POSE_H_
