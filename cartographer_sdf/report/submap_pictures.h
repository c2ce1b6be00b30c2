// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Pictures of what is computed on submaps, with their longer side at about
// `max_pixels`.

#ifndef CARTOGRAPHER_SDF_REPORT_SUBMAP_PICTURES_H_
#define CARTOGRAPHER_SDF_REPORT_SUBMAP_PICTURES_H_

#include <Eigen/Core>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/report/picture.h"

namespace cartographer_sdf {

enum class KeypointMark { kMaximum, kSaddle, kMinimum };

struct MarkedKeypoint {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // submap frame [m]
  KeypointMark mark = KeypointMark::kMaximum;
};

// The signed distance [m] at the centres of cells: white at the wall, blue in
// free space, brown inside of obstacles, with a contour line every half metre;
// hatched where it was not observed. Maxima are red, saddles green, minima
// yellow. In the grid frame, x to the right, y up.
[[nodiscard]] Picture DrawDistanceField(
    const CellGeometry& geometry, const Eigen::ArrayXXf& distance,
    const BoolArray& observed, const std::vector<MarkedKeypoint>& keypoints,
    int max_pixels);

// A point seen in both submaps, each in its own submap frame [m].
struct Correspondence {
  Eigen::Vector2d p_reference = Eigen::Vector2d::Zero();
  Eigen::Vector2d p_query = Eigen::Vector2d::Zero();
};

// The query laid over the reference. Walls: reference dark blue, query red,
// orange those of either that lie deep in the free space of the other. Free
// space: of the reference alone bluish, of the query alone reddish, of both
// white. Green lines join the correspondences. In the grid frame of the
// reference. The pose must be finite, and of less than 1000 km.
[[nodiscard]] Picture DrawMatchedPair(
    const OccupancyGrid& reference, const OccupancyGrid& query,
    const Rigid2& T_reference_query,
    const std::vector<Correspondence>& correspondences, int max_pixels);

// Free space white, walls black, unknown grey; in the grid frame.
[[nodiscard]] Picture DrawOccupancyGrid(const OccupancyGrid& grid,
                                        int max_pixels);

// The centres of the walls of `walls` whose surroundings in `space` are known
// to be free, in the submap frame of `space`. For showing; the verification
// has its own measure.
[[nodiscard]] std::vector<Eigen::Vector2d> ContradictedWalls(
    const OccupancyGrid& walls, const OccupancyGrid& space,
    const Rigid2& T_space_walls);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_SUBMAP_PICTURES_H_
