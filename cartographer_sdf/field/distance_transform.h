// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Exact Euclidean distance transform in time linear in the number of cells,
// as the lower envelope of parabolas, one axis after the other
// ([Felzenszwalb2012], after [Maurer2003]); integers only, hence exact. Two
// to three times as fast as OpenCV's precise one (field_benchmark).

#ifndef CARTOGRAPHER_SDF_FIELD_DISTANCE_TRANSFORM_H_
#define CARTOGRAPHER_SDF_FIELD_DISTANCE_TRANSFORM_H_

#include <Eigen/Core>
#include <functional>

#include "cartographer_sdf/grid/occupancy_grid.h"

namespace cartographer_sdf {

// Returns the squared distance from each cell's centre to the nearest centre of
// a cell that is true in `sites` [cells^2]. At least one cell must be true; at
// most 32767 cells a side.
[[nodiscard]] Eigen::ArrayXXi SquaredDistanceTransform(const BoolArray& sites);

// The same column by column, in order, for callers that keep something else:
// column j has `squared[i]` in row i, valid during the call.
using SquaredDistancesVisitor =
    std::function<void(Eigen::Index j, const int* squared)>;
void VisitSquaredDistances(const BoolArray& sites,
                           const SquaredDistancesVisitor& visit);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_FIELD_DISTANCE_TRANSFORM_H_
