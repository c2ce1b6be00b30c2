// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A building as a raster of walls, in the world frame [m]: the origin is the
// lower left corner, x to the right, y up. The world frame takes the role of
// CellGeometry's submap frame and equals the grid frame.

#ifndef CARTOGRAPHER_SDF_SIMULATION_FLOOR_PLAN_H_
#define CARTOGRAPHER_SDF_SIMULATION_FLOOR_PLAN_H_

#include <Eigen/Core>
#include <string>

#include "absl/status/statusor.h"
#include "cartographer_sdf/grid/cell_geometry.h"
#include "cartographer_sdf/grid/occupancy_grid.h"

namespace cartographer_sdf {

struct FloorPlan {
  CellGeometry geometry;
  // Cells that stop light and robots, as does everything outside the raster.
  BoolArray occupied;
  // Occupied cells of glass, which lets most beams through, and occupied cells
  // above or below the beams, such as a table top. Each mask is empty if there
  // are no such cells.
  BoolArray glass;
  BoolArray unseen;
};

// A plan of at least the given size [m] without any walls.
[[nodiscard]] FloorPlan EmptyFloorPlan(const Eigen::Vector2d& size,
                                       double resolution);

// Sets the cells whose centres lie in the shape, clipped to the plan; a disc is
// occupied.
void FillRectangle(const Eigen::Vector2d& centre, const Eigen::Vector2d& size,
                   double yaw, bool occupied, FloorPlan* plan);
void FillDisc(const Eigen::Vector2d& centre, double radius, FloorPlan* plan);

// Marks the occupied cells in the rectangle as glass, or sets whether they are
// unseen.
void MakeGlass(const Eigen::Vector2d& centre, const Eigen::Vector2d& size,
               double yaw, FloorPlan* plan);
void MakeUnseen(const Eigen::Vector2d& centre, const Eigen::Vector2d& size,
                double yaw, bool unseen, FloorPlan* plan);

// Reads a grey PGM image (P2 or P5) whose pixels are squares of `resolution`
// [m]. As in ROS maps, nearly white is free; the grey of the unknown and the
// black of walls are occupied.
[[nodiscard]] absl::StatusOr<FloorPlan> ReadPgm(const std::string& path,
                                                double resolution);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SIMULATION_FLOOR_PLAN_H_
