// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/grid/turned_grid.h"

namespace cartographer_sdf {

OccupancyGrid TurnedGrid(const OccupancyGrid& source, const double angle) {
  const Rigid2 T_turned_source(0., 0., angle);
  const Rigid2 T_grid_submap = source.geometry.T_submap_grid.Inverse();
  const Eigen::Vector2d extent =
      source.geometry.resolution * source.geometry.size.cast<double>().matrix();
  Eigen::AlignedBox2d bounds;  // in the grid frame
  for (const double x : {0., 1.}) {
    for (const double y : {0., 1.}) {
      const Eigen::Vector2d corner(x * extent.x(), y * extent.y());
      bounds.extend(T_grid_submap * (T_turned_source *
                                     (source.geometry.T_submap_grid * corner)));
    }
  }
  CellGeometry geometry = source.geometry;
  geometry.size =
      (bounds.sizes().array() / geometry.resolution).ceil().cast<int>();
  geometry.T_submap_grid = geometry.T_submap_grid * Rigid2(bounds.min(), 0.);
  OccupancyGrid turned = UnknownGrid(geometry);
  // (cells of the source <- cells of the turned grid), computed once: applying
  // a pose to each of a million cells takes a quarter of a second.
  const Rigid2 T_source_turned = source.geometry.T_submap_grid.Inverse() *
                                 T_turned_source.Inverse() *
                                 geometry.T_submap_grid;
  const Eigen::Matrix2d R = T_source_turned.RotationMatrix();
  const Eigen::Vector2d corner =
      T_source_turned.translation() / geometry.resolution;
  for (int j = 0; j < geometry.size.y(); ++j) {
    for (int i = 0; i < geometry.size.x(); ++i) {
      const Eigen::Array2i cell =
          (R * Eigen::Vector2d(i + 0.5, j + 0.5) + corner)
              .array()
              .floor()
              .cast<int>();
      if (!source.geometry.Contains(cell)) continue;
      turned.known(i, j) = source.known(cell.x(), cell.y());
      turned.probability(i, j) = source.probability(cell.x(), cell.y());
    }
  }
  return turned;
}

}  // namespace cartographer_sdf
