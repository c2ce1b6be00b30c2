// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Where in a map a robot can stand, and the panorama from there: the ranges to
// what a lidar would meet all round.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_VIEWPOINTS_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_VIEWPOINTS_H_

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cartographer_sdf/localization/ray_map.h"

namespace cartographer_sdf {

struct ViewpointOptions {
  // [m] Distance between neighbouring viewpoints.
  double step_meters = 0.3;
  // In a map with room for more, they are farther apart.
  int max_num_viewpoints = 60000;
  // [m] Least distance from a sensor to a wall.
  double min_clearance_meters = 0.15;
};
[[nodiscard]] std::string Validate(const ViewpointOptions& options);

// Directions of a panorama, the first along the x axis of the grid.
constexpr int kNumDirections = 128;
// Ranges of a panorama as they are kept: twice in a row.
constexpr size_t kPanoramaSize = size_t{2} * kNumDirections;
// Ranges of a panorama are kept in this unit [m], up to 255 of it.
constexpr double kPanoramaUnit = 0.1;

// All panoramas, one after the other. Each has its ranges twice in a row, so
// that a panorama turned by any number of directions is contiguous; so do the
// masks: 255 where a wall was met, 0 where the map is unknown.
struct Viewpoints {
  std::vector<Eigen::Vector2d> positions;  // cells, see CastRay()
  double step = 0.;                        // between neighbours [m]
  std::vector<uint8_t> ranges;
  std::vector<uint8_t> masks;

  [[nodiscard]] const uint8_t* RangesOf(const size_t viewpoint) const {
    return ranges.data() + kPanoramaSize * viewpoint;
  }
  [[nodiscard]] const uint8_t* MasksOf(const size_t viewpoint) const {
    return masks.data() + kPanoramaSize * viewpoint;
  }
};

// Returns the cells that a robot can reach: free, with the clearance, and
// connected with a place near one of the positions [m, map frame]; without
// positions, all that are free with the clearance.
[[nodiscard]] BoolArray ReachableCells(
    const RayMap& map, double min_clearance,
    const std::vector<Eigen::Vector2d>& driven_positions);

// Of each square with a reachable cell, has the viewpoint nearest to its
// middle.
[[nodiscard]] Viewpoints MakeViewpoints(const ViewpointOptions& options,
                                        const RayMap& map,
                                        const BoolArray& reachable);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_VIEWPOINTS_H_
