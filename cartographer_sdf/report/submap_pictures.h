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

// The query laid over the reference. Walls are dark blue (reference) or red
// (query), and orange where they lie deep in the free space of the other. Free
// space is bluish (reference only), reddish (query only) or white (both). Green
// lines join the correspondences. In the grid frame of the reference; the
// longer side has `max_pixels` pixels. The pose must be finite and its
// translation less than 1000 km.
[[nodiscard]] Picture DrawMatchedPair(
    const OccupancyGrid& reference, const OccupancyGrid& query,
    const Rigid2& T_reference_query,
    const std::vector<PointPair>& correspondences, int max_pixels);

// The centres of wall cells of `walls` whose surroundings in `space` are known
// to be free, in the submap frame of `space`. For display only; verification
// has its own measure.
[[nodiscard]] std::vector<Eigen::Vector2d> ContradictedWalls(
    const OccupancyGrid& walls, const OccupancyGrid& space,
    const Rigid2& T_space_walls);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_SUBMAP_PICTURES_H_
