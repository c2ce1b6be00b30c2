// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_GEOMETRY_ALIGNMENT_H_
#define CARTOGRAPHER_SDF_GEOMETRY_ALIGNMENT_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"

namespace cartographer_sdf {

// Returns the T_reference_query that minimises the weighted sum of
// |p_reference[k] - T_reference_query * p_query[k]|^2: exact, closed form,
// linear in the number of pairs; the planar case of [Umeyama1991] without
// scale. Weights must not be negative; an empty vector means equal weights.
//
// Returns nullopt if the rotation is undetermined: fewer than two pairs, or
// pairs of positive weight that coincide (in either frame) to within rounding,
// or point sets that every rotation aligns equally well.
[[nodiscard]] std::optional<Rigid2> AlignPointPairs(
    const std::vector<Eigen::Vector2d>& p_reference,
    const std::vector<Eigen::Vector2d>& p_query,
    const std::vector<double>& weights = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_GEOMETRY_ALIGNMENT_H_
