// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A map as rays and points meet it. Rays are cast by sphere tracing: what is
// not free is at least as far as the distance field says, so that a ray crosses
// open space in few steps.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_RAY_MAP_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_RAY_MAP_H_

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "cartographer_sdf/field/distance_field.h"
#include "cartographer_sdf/grid/occupancy_grid.h"

namespace cartographer_sdf {

using StepArray = Eigen::Array<uint8_t, Eigen::Dynamic, Eigen::Dynamic>;

struct RayMap {
  // Of the walls; the map frame is its submap frame.
  DistanceField field;
  // For each cell of the field one of the constants below, or the number of
  // cells that a ray from anywhere in the cell crosses at least before it meets
  // a cell that is not free.
  StepArray steps;

  static constexpr uint8_t kWall = 255;
  static constexpr uint8_t kUnknown = 254;

  [[nodiscard]] const CellGeometry& geometry() const { return field.geometry; }
};

// None where the grid has no wall or no free cell. The grid's submap frame is
// the map frame.
[[nodiscard]] std::optional<RayMap> MakeRayMap(const OccupancyGrid& grid);

enum class RayEnd {
  kWall,
  kUnknown,  // where the map is unknown, or ends
  kOpen,     // nothing is met up to the greatest range
};
struct Ray {
  double range;  // [cells]
  RayEnd end;
};

// Follows a ray from a point in cell coordinates whose floor is the cell
// (CellGeometry::GridToCells plus one half), in the grid frame, with a unit
// direction. Crosses unknown space that is thinner than 0.3 m, and, unless
// `stops_at_grazed` is set, walls that it only grazes: a pose that is off by a
// few centimetres makes rays along a wall meet it.
[[nodiscard]] Ray CastRay(const RayMap& map, const Eigen::Vector2d& begin,
                          const Eigen::Vector2d& direction, double max_range,
                          bool stops_at_grazed);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_RAY_MAP_H_
