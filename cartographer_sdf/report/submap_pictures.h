// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_REPORT_SUBMAP_PICTURES_H_
#define CARTOGRAPHER_SDF_REPORT_SUBMAP_PICTURES_H_

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/report/picture.h"

namespace cartographer_sdf {

// A point seen in both submaps (reference, query), each in its own frame [m].
using PointPair = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

// The query laid over the reference. Walls: reference dark blue, query red,
// orange those of either that lie deep in the free space of the other. Free
// space: of the reference alone bluish, of the query alone reddish, of both
// white. Green lines join the correspondences. In the grid frame of the
// reference, the longer side at `max_pixels`. The pose must be finite, and of
// less than 1000 km.
[[nodiscard]] Picture DrawMatchedPair(
    const OccupancyGrid& reference, const OccupancyGrid& query,
    const Rigid2& T_reference_query,
    const std::vector<PointPair>& correspondences, int max_pixels);

// The centres of the walls of `walls` whose surroundings in `space` are known
// to be free, in the submap frame of `space`. For showing; the verification
// has its own measure.
[[nodiscard]] std::vector<Eigen::Vector2d> ContradictedWalls(
    const OccupancyGrid& walls, const OccupancyGrid& space,
    const Rigid2& T_space_walls);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_SUBMAP_PICTURES_H_
