// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Which of many hypotheses are worth refining: by how well walls and free space
// agree under each, on few wall points first and on more for the survivors.

#ifndef CARTOGRAPHER_SDF_VERIFICATION_RANKING_H_
#define CARTOGRAPHER_SDF_VERIFICATION_RANKING_H_

#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/verification/surface_model.h"

namespace cartographer_sdf {

// Coarse to fine: all hypotheses on few points, the survivors on more.
struct RankingOptions {
  int num_coarse_points = 40;
  int num_fine_points = 200;
  // Hypotheses that reach the fine ranking, and those that are refined.
  int num_coarse_survivors = 25;
  int num_refined = 8;
  // The tolerance of both: hypotheses are this wrong [m].
  double hit_distance_meters = 0.3;
  double contradiction_distance_meters = 0.5;
  // Contradictions count so many times as much as hits.
  double contradiction_weight = 2.;
  // A hypothesis with a lower (hits - weight * contradictions) / points is
  // dropped. Larger: faster, less recall.
  double min_coarse_score = 0.2;
  double min_fine_score = 0.45;
  // Hypotheses that score worse than the best one by more than this are not
  // refined: they can be neither right nor rivals.
  double max_fine_score_gap = 0.25;
};
[[nodiscard]] std::string Validate(const RankingOptions& options);

// The best hypotheses, polished in rotation; best first, and no two of them
// nearly the same at `middle` [m, query frame]. Independent of the order of the
// hypotheses. Heuristic.
[[nodiscard]] std::vector<Rigid2> RankHypotheses(
    const RankingOptions& options, const SurfaceModel& reference,
    const SurfaceModel& query,
    const std::vector<Rigid2>& hypotheses_T_reference_query,
    const Eigen::Vector2d& middle);

// Whether two poses take a point less than `distance` [m] apart and differ by
// less than `rotation` [rad].
[[nodiscard]] bool AreNear(const Rigid2& T_reference_query,
                           const Rigid2& other_T_reference_query,
                           const Eigen::Vector2d& p_query, double distance,
                           double rotation);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_VERIFICATION_RANKING_H_
