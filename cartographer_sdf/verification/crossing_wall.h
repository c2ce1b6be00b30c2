// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A wall of one submap across free space of another. Furniture that was moved
// is short, and walls that drift displaced are near those that they repeat; a
// long straight wall far from every wall of the other submap is neither, and
// says that the two show different places, however small its share of all walls
// is.

#ifndef CARTOGRAPHER_SDF_VERIFICATION_CROSSING_WALL_H_
#define CARTOGRAPHER_SDF_VERIFICATION_CROSSING_WALL_H_

#include <cstddef>
#include <string>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/place/surface_model.h"

namespace cartographer_sdf {

struct CrossingOptions {
  // Two submaps cannot show the same place if a longer straight wall of one
  // stands across the free space of the other [m]: longer than furniture.
  double max_wall_meters = 3.;
  // Largest fraction of the pairs of submaps that two maps make overlap that
  // may be crossed by such a wall: local SLAM tears some submaps.
  double max_crossed_fraction = 0.05;
};
[[nodiscard]] std::string Validate(const CrossingOptions& options);

// Pairs that are compared where more overlap, evenly spaced among all.
constexpr size_t kMaxNumCrossingPairs = 200;

// Returns the length [m] of the longest straight and unbroken stretch of wall
// of either submap that lies in the observed free space of the other, at least
// 0.5 m from its walls; 0 if there is none. Takes time proportional to the
// number of wall points; more for those that cross.
[[nodiscard]] double LongestCrossingWall(const SurfaceModel& reference,
                                         const SurfaceModel& query,
                                         const Rigid2& T_reference_query);

// Whether walls cross too many of the pairs of submaps that were compared.
[[nodiscard]] bool IsCrossed(const CrossingOptions& options, size_t num_crossed,
                             size_t num_compared);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_VERIFICATION_CROSSING_WALL_H_
