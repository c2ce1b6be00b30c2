// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// An invented office floor: a corridor around a core of rooms and one across
// it, rooms of varied width on both sides, some of them locked, furnished so
// that no two are alike.

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
  // Fraction of the doors that are closed, and so are wall.
  double closed_doors = 0.12;
  // Pieces per square metre of room.
  double furniture_density = 0.14;
  // Fraction of the rooms whose wall to the corridor is of glass, and of the
  // tables of which a lidar sees the four legs only.
  double glass_fronts = 0.;
  double open_tables = 0.;
  // Finer than any map's, so that walls have no grid in common with it [m].
  double resolution = 0.025;
};

// The first reason why the options make no sense, or nothing.
[[nodiscard]] std::string Validate(const OfficeOptions& options);

// The same building for the same seed.
[[nodiscard]] FloorPlan MakeOffice(const OfficeOptions& options, uint32_t seed);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SIMULATION_OFFICE_H_
