// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Where the cells of a grid lie in its submap: the only place that converts
// between cells and metres.
//
// Cell (i, j) is stored at (row i, column j) of Eigen arrays (i runs fastest in
// memory). In the grid frame its centre is resolution * (i + 0.5, j + 0.5), so
// x grows with i, y with j, and the corner of cell (0, 0) is the origin.

#ifndef CARTOGRAPHER_SDF_GRID_CELL_GEOMETRY_H_
#define CARTOGRAPHER_SDF_GRID_CELL_GEOMETRY_H_

#include <Eigen/Core>

#include "cartographer_sdf/geometry/rigid2.h"

namespace cartographer_sdf {

struct CellGeometry {
  // Number of cells along x and y.
  Eigen::Array2i size = Eigen::Array2i::Zero();
  // Side of a cell [m].
  double resolution = 0.05;
  // (submap <- grid)
  Rigid2 T_submap_grid;

  [[nodiscard]] bool Contains(const Eigen::Array2i& cell) const {
    return (cell >= 0).all() && (cell < size).all();
  }
  // Returns the continuous cell coordinates of a point in the grid frame;
  // integers are cell centres.
  [[nodiscard]] Eigen::Vector2d GridToCells(
      const Eigen::Vector2d& p_grid) const {
    return p_grid / resolution - Eigen::Vector2d::Constant(0.5);
  }
  [[nodiscard]] Eigen::Vector2d CellsToGrid(
      const Eigen::Vector2d& cells) const {
    return resolution * (cells + Eigen::Vector2d::Constant(0.5));
  }
  // Returns the centre of a cell in the submap frame [m].
  [[nodiscard]] Eigen::Vector2d CellCentre(const Eigen::Array2i& cell) const {
    return T_submap_grid * CellsToGrid(cell.matrix().cast<double>());
  }
  // Returns the cell that contains a point in the submap frame; it may lie
  // outside the grid.
  [[nodiscard]] Eigen::Array2i CellAt(const Eigen::Vector2d& p_submap) const {
    const Eigen::Vector2d p_grid = T_submap_grid.Inverse() * p_submap;
    return (p_grid.array() / resolution).floor().cast<int>();
  }
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_GRID_CELL_GEOMETRY_H_
