// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What a submap shows, in three classes: small enough for a page that shows
// hundreds, and enough to lay one over another.

#ifndef CARTOGRAPHER_SDF_REPORT_SUBMAP_RASTER_H_
#define CARTOGRAPHER_SDF_REPORT_SUBMAP_RASTER_H_

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"

namespace cartographer_sdf {

// Between these, a cell is too uncertain to be drawn as either.
constexpr float kMinDrawnWallProbability = 0.55f;
constexpr float kMaxDrawnFreeProbability = 0.48f;

enum class CellClass : uint8_t { kUnknown, kFree, kWall };

[[nodiscard]] CellClass ClassOf(const OccupancyGrid& grid, int i, int j);

struct SubmapRaster {
  // Of the known part of the grid; 0 if nothing is known.
  int width = 0;
  int height = 0;
  double resolution = 0.;  // [m]
  // The raster's x runs along its rows, its y from row to row; its origin is
  // the outer corner of cell (0, 0).
  Rigid2 T_submap_raster;
  std::vector<CellClass> cells;  // row by row

  [[nodiscard]] CellClass At(int x, int y) const;  // kUnknown outside
  [[nodiscard]] CellClass AtPoint(const Eigen::Vector2d& p_submap) const;
  [[nodiscard]] Eigen::Vector2d CentreOf(int x, int y) const;  // submap frame
};

// The longer side has at most `max_pixels` cells: several cells of the grid
// become one, a wall if there is any in it, else free if any is.
[[nodiscard]] SubmapRaster RasterizeSubmap(const OccupancyGrid& grid,
                                           int max_pixels);

// Unknown cells are transparent, free ones white, walls black. Empty if
// nothing is known.
[[nodiscard]] std::string EncodePng(const SubmapRaster& raster);

// A point of the reference's walls, in its submap frame, where a wall of the
// query lies, too, in the middle of all such points; without any, in the middle
// of what both know. None if the two do not overlap.
[[nodiscard]] std::optional<Eigen::Vector2d> WhereWallsOverlap(
    const SubmapRaster& reference, const SubmapRaster& query,
    const Rigid2& T_reference_query);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_SUBMAP_RASTER_H_
