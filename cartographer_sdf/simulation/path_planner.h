// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Paths for a round robot through a floor plan that keep clear of walls.

#ifndef CARTOGRAPHER_SDF_SIMULATION_PATH_PLANNER_H_
#define CARTOGRAPHER_SDF_SIMULATION_PATH_PLANNER_H_

#include <Eigen/Core>
#include <vector>

#include "cartographer_sdf/simulation/floor_plan.h"

namespace cartographer_sdf {

// World frame as in FloorPlan; cells of about 0.1 m.
struct NavigationGrid {
  CellGeometry geometry;
  // Distance from the cell's centre to the nearest centre of an occupied cell
  // of the plan [m]; cells outside the plan are occupied. Accurate to half a
  // cell of the plan, and cut off at kMaxClearance.
  Eigen::ArrayXXf clearance;
  // The largest connected set of cells with sufficient clearance.
  BoolArray reachable;

  static constexpr double kMaxClearance = 0.9;
};

[[nodiscard]] NavigationGrid MakeNavigationGrid(const FloorPlan& plan,
                                                double min_clearance);

// Cheapest paths from one cell to every reachable cell [Dijkstra1959], over the
// eight neighbours. The cost is the length [m], up to tripled along walls.
// Cells are numbered i + size.x() * j.
struct ShortestPaths {
  // Infinite if there is no path.
  std::vector<float> cost;
  // The next cell on the path back to the source; the source itself at the
  // source, -1 without a path.
  std::vector<int> parent;
};

[[nodiscard]] ShortestPaths FindShortestPaths(const NavigationGrid& grid,
                                              int source);

// The path from the source to a reachable target in the world frame [m],
// smoothed as far as the clearance allows.
[[nodiscard]] std::vector<Eigen::Vector2d> SmoothPath(
    const NavigationGrid& grid, const ShortestPaths& paths, int target,
    double min_clearance);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SIMULATION_PATH_PLANNER_H_
