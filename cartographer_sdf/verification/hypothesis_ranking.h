// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Ranks many pose hypotheses by the agreement of walls and free space; the best
// are worth registering.

#ifndef CARTOGRAPHER_SDF_VERIFICATION_HYPOTHESIS_RANKING_H_
#define CARTOGRAPHER_SDF_VERIFICATION_HYPOTHESIS_RANKING_H_

#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/place/surface_model.h"

namespace cartographer_sdf {

// Coarse to fine: all hypotheses on few points, the survivors on more.
struct RankingOptions {
  int num_coarse_points = 40;
  int num_fine_points = 200;
  // Hypotheses that reach the fine ranking, and those that are refined.
  int num_coarse_survivors = 25;
  int num_refined = 8;
  // Tolerance of both rankings: hypotheses are this inaccurate [m].
  double hit_distance_meters = 0.3;
  double contradiction_distance_meters = 0.5;
  // Weight of a contradiction relative to a hit.
  double contradiction_weight = 2.;
  // A hypothesis with a lower (hits - weight * contradictions) / points is
  // dropped. Larger: faster, less recall.
  double min_coarse_score = 0.2;
  double min_fine_score = 0.45;
  // Hypotheses that score worse than the best one by more than this are not
  // refined: they can be neither correct nor rivals.
  double max_fine_score_gap = 0.25;
};
[[nodiscard]] std::string Validate(const RankingOptions& options);

// Returns the best hypotheses, polished in rotation; best first, and no two
// nearly the same at `centroid`, the centroid of the query's observed area [m,
// query frame]. Independent of the order of the hypotheses. Heuristic.
[[nodiscard]] std::vector<Rigid2> RankHypotheses(
    const RankingOptions& options, const SurfaceModel& reference,
    const SurfaceModel& query,
    const std::vector<Rigid2>& hypotheses_T_reference_query,
    const Eigen::Vector2d& centroid);

// Returns the pose, or the pose turned by a few degrees about `centroid` [m,
// query frame], whichever agrees best: guesses are off by some degrees, beyond
// the reach of registration at the far ends of a submap.
[[nodiscard]] Rigid2 PolishRotation(const RankingOptions& options,
                                    const SurfaceModel& reference,
                                    const SurfaceModel& query,
                                    const Rigid2& T_reference_query,
                                    const Eigen::Vector2d& centroid);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_VERIFICATION_HYPOTHESIS_RANKING_H_
