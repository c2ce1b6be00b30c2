// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Ways for a round robot through a floor plan that keep their distance to
// walls.

#ifndef CARTOGRAPHER_SDF_SIMULATION_PATH_PLANNER_H_
#define CARTOGRAPHER_SDF_SIMULATION_PATH_PLANNER_H_

#include <Eigen/Core>
#include <vector>

#include "cartographer_sdf/simulation/floor_plan.h"

namespace cartographer_sdf {

// World frame as in FloorPlan; cells of about 0.1 m.
struct NavigationGrid {
  CellGeometry geometry;
  // Distance of the cell's centre to the nearest centre of an occupied cell of
  // the plan, outside of which all are [m]; exact up to half a cell of the plan
  // below kMaxClearance, and cut off there.
  Eigen::ArrayXXf clearance;
  // The largest connected set of cells with sufficient clearance.
  BoolArray reachable;

  static constexpr double kMaxClearance = 0.9;
};

[[nodiscard]] NavigationGrid MakeNavigationGrid(const FloorPlan& plan,
                                                double min_clearance);

// Cheapest ways from one cell to every reachable one [Dijkstra1959]: over the
// eight neighbours, metres in the open and up to thrice that along walls.
// Cells are numbered i + size.x() * j.
struct ShortestPaths {
  // Infinite where there is no way.
  std::vector<float> cost;
  // The next cell on the way back; itself at the source, -1 without a way.
  std::vector<int> parent;
};

[[nodiscard]] ShortestPaths FindShortestPaths(const NavigationGrid& grid,
                                              int source);

// The way from the source to a reachable target in the world frame [m],
// smoothed as far as the clearance allows.
[[nodiscard]] std::vector<Eigen::Vector2d> SmoothPath(
    const NavigationGrid& grid, const ShortestPaths& paths, int target,
    double min_clearance);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SIMULATION_PATH_PLANNER_H_
