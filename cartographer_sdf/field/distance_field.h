// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Signed distance field of a submap: metres to the nearest wall, positive
// outside obstacles and negative inside, zero on the edges between occupied
// and other cells ([Millane2019], Sec. IV-A). Exact for the thresholded grid
// (at centres of cells; interpolated between them). Defined in unknown space
// too, as the distance to the walls that are known, but `observed` tells that
// nothing is known there.

#ifndef CARTOGRAPHER_SDF_FIELD_DISTANCE_FIELD_H_
#define CARTOGRAPHER_SDF_FIELD_DISTANCE_FIELD_H_

#include <Eigen/Core>
#include <optional>
#include <string>

#include "cartographer_sdf/grid/occupancy_grid.h"

namespace cartographer_sdf {

struct FieldOptions {
  // A known cell with a higher probability is an obstacle. Cartographer's hits
  // start at 0.55 and its misses at 0.49.
  double occupied_probability = 0.5;
  // The field reaches this far beyond the grid, so that keypoints and walls at
  // its rim have surroundings [m].
  double padding_meters = 0.6;
};
[[nodiscard]] std::string Validate(const FieldOptions& options);

struct DistanceField {
  // The grid's, larger by the padding.
  CellGeometry geometry;
  Eigen::ArrayXXf distance;  // [m]
  BoolArray observed;
};

// None where no cell is occupied: such a submap is at no distance to anything.
[[nodiscard]] std::optional<DistanceField> MakeDistanceField(
    const FieldOptions& options, const OccupancyGrid& grid);

struct FieldSample {
  double distance;           // [m]
  Eigen::Vector2d gradient;  // in the grid frame, dimensionless
};

// Bilinear interpolation at a point in continuous cell coordinates
// (CellGeometry::GridToCells) and its gradient, of a field whose cells are
// distance(i, j) [m]; none outside the centres of the outermost cells. Inline:
// the inner loop of verification.
template <typename Distance>
[[nodiscard]] inline std::optional<FieldSample> InterpolateField(
    const CellGeometry& geometry, const Eigen::Vector2d& cells,
    const Distance& distance) {
  if (!(cells.x() >= 0. && cells.y() >= 0. &&
        cells.x() < geometry.size.x() - 1 &&
        cells.y() < geometry.size.y() - 1)) {
    return std::nullopt;
  }
  const Eigen::Index i = static_cast<Eigen::Index>(cells.x());
  const Eigen::Index j = static_cast<Eigen::Index>(cells.y());
  const double u = cells.x() - static_cast<double>(i);
  const double v = cells.y() - static_cast<double>(j);
  const double f00 = distance(i, j), f10 = distance(i + 1, j);
  const double f01 = distance(i, j + 1), f11 = distance(i + 1, j + 1);
  const double bottom = f00 + u * (f10 - f00), top = f01 + u * (f11 - f01);
  const double along_x = (1. - v) * (f10 - f00) + v * (f11 - f01);
  return FieldSample{
      bottom + v * (top - bottom),
      Eigen::Vector2d(along_x, top - bottom) / geometry.resolution};
}

// At a point of the *grid* frame.
[[nodiscard]] inline std::optional<FieldSample> SampleField(
    const DistanceField& field, const Eigen::Vector2d& p_grid) {
  return InterpolateField(field.geometry, field.geometry.GridToCells(p_grid),
                          [&field](const Eigen::Index i, const Eigen::Index j) {
                            return static_cast<double>(field.distance(i, j));
                          });
}

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_FIELD_DISTANCE_FIELD_H_
