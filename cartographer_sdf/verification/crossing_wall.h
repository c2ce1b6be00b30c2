// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A wall of one submap across free space of another. Furniture that was moved
// is short, and walls that drift displaced are near those that they repeat; a
// long straight wall far from every wall of the other submap is neither, and
// says that the two show different places, however small its share of all walls
// is. So does a shorter one where the robot drove: nobody drives through walls.

#ifndef CARTOGRAPHER_SDF_VERIFICATION_CROSSING_WALL_H_
#define CARTOGRAPHER_SDF_VERIFICATION_CROSSING_WALL_H_

#include <Eigen/Core>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/place/surface_model.h"

namespace cartographer_sdf {

// Positions of the robot while it made a submap, in the order of time, in the
// submap frame [m].
using DrivenWay = std::vector<Eigen::Vector2d>;

// Straight and unbroken stretches of wall of either of two submaps that lie in
// the observed free space of the other, at least 0.5 m from its walls; zero if
// there is none.
struct CrossingWalls {
  double longest = 0.;  // [m]
  // The longest through which the robot drove that made the other submap [m].
  double longest_driven_through = 0.;
};

// Takes time proportional to the number of wall points; more for those that
// cross. A way may be empty.
[[nodiscard]] CrossingWalls FindCrossingWalls(const SurfaceModel& reference,
                                              const DrivenWay& reference_way,
                                              const SurfaceModel& query,
                                              const DrivenWay& query_way,
                                              const Rigid2& T_reference_query);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_VERIFICATION_CROSSING_WALL_H_
