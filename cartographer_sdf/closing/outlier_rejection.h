// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Outlier rejection after optimisation, the last guard against false closures:
// removes the closures that the optimised graph contradicts, and optimises the
// rest again.

#ifndef CARTOGRAPHER_SDF_CLOSING_OUTLIER_REJECTION_H_
#define CARTOGRAPHER_SDF_CLOSING_OUTLIER_REJECTION_H_

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cartographer_sdf/closing/closure.h"
#include "cartographer_sdf/execution/progress.h"
#include "cartographer_sdf/pose_graph/optimization.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

struct OutlierRejectionOptions {
  // Largest mean error of a closure's constraints [m], [rad].
  double max_translation_error_meters = 0.3;
  double max_rotation_error = 0.052;
  int max_num_rounds = 10;
};
[[nodiscard]] std::string Validate(const OutlierRejectionOptions& options);

// Returns the indices of the errors to reject before optimising again: those
// that exceed the limits and, relative to them, half of the worst error, as a
// false constraint also strains true ones nearby. Empty if none exceeds the
// limits; skips entries without an error.
[[nodiscard]] std::vector<size_t> FindOutliers(
    const OutlierRejectionOptions& options,
    const std::vector<std::optional<ConstraintError>>& errors);

struct OptimizedGraph {
  // With the constraints of the remaining closures; unchanged if none remains.
  PoseGraph pose_graph;
  std::vector<OptimizationSummary> optimizations;  // one per round
};

// Sets status, constraints and graph error of the closures that are in the
// graph. In each round, the worst of each connected part of the graph go.
[[nodiscard]] OptimizedGraph OptimizeAndRejectOutliers(
    const OutlierRejectionOptions& options,
    const OptimizationOptions& optimization,
    const std::set<int>& frozen_trajectories, const PoseGraph& pose_graph,
    std::vector<Closure>* closures, const ProgressCallback& on_progress = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CLOSING_OUTLIER_REJECTION_H_
