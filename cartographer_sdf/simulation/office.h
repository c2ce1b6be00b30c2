// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A random office floor: a corridor around a core of rooms and one across it,
// with rooms of varied width on both sides. Some rooms are locked, and no two
// are furnished alike.

#ifndef CARTOGRAPHER_SDF_SIMULATION_OFFICE_H_
#define CARTOGRAPHER_SDF_SIMULATION_OFFICE_H_

#include <cstdint>
#include <string>

#include "cartographer_sdf/simulation/floor_plan.h"

namespace cartographer_sdf {

struct OfficeOptions {
  // Outer size of the building [m].
  double width = 40.;
  double height = 30.;
  double wall_thickness = 0.15;
  // Fraction of the doors that are closed and count as wall.
  double closed_doors = 0.12;
  // Pieces of furniture per square metre of room.
  double furniture_density = 0.14;
  // Fraction of the rooms whose wall to the corridor is glass, and of the
  // tables of which the lidar sees only the four legs.
  double glass_fronts = 0.;
  double open_tables = 0.;
  // Finer than that of maps, so that walls do not align with their grids [m].
  double resolution = 0.025;
};

// The first reason why the options are invalid, or nothing.
[[nodiscard]] std::string Validate(const OfficeOptions& options);

// Deterministic for a given seed.
[[nodiscard]] FloorPlan MakeOffice(const OfficeOptions& options, uint32_t seed);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SIMULATION_OFFICE_H_
