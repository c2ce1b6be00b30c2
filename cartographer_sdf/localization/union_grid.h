// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// One grid of a whole map: what its submaps say of each cell, together.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_UNION_GRID_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_UNION_GRID_H_

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"

namespace cartographer_sdf {

// Where a submap lies in the map, and what cells it has.
struct GridFootprint {
  CellGeometry geometry;
  Rigid2 T_map_submap;
};

// Thread-compatible.
class UnionGrid {
 public:
  // A quarter of a gigabyte while it is built.
  static constexpr int kMaxNumCells = 1 << 25;

  // Has the cells of the finest grid, or as much larger ones as it takes to
  // stay below kMaxNumCells. Grids without cells or with an absurd pose (beyond
  // 10 000 km, NaN) are left out, here and in Add().
  explicit UnionGrid(const std::vector<GridFootprint>& grids);

  // Takes time proportional to the number of cells of the submap.
  void Add(const OccupancyGrid& grid, const Rigid2& T_map_submap);

  // Returns the grid in the map frame; nullopt if nothing is known. A cell is a
  // wall where at least half of what is known of it says so, or less where it
  // is larger than those of the submaps, so that thin walls stay closed.
  [[nodiscard]] std::optional<OccupancyGrid> Finish() const;

 private:
  // One sample for each cell of this grid, or for each of the submap's where
  // they are smaller.
  void AddSampled(const OccupancyGrid& grid, const Rigid2& T_map_submap);
  void AddScattered(const OccupancyGrid& grid, const Rigid2& T_map_submap);
  void AddCell(const Eigen::Array2i& cell, float probability);

  CellGeometry geometry_;
  float min_occupied_fraction_ = 0.f;
  // Sums over the submaps: of how surely a cell is a wall, and known.
  Eigen::ArrayXXf occupied_;
  Eigen::ArrayXXf known_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_UNION_GRID_H_
