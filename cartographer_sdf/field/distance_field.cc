// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/field/distance_field.h"

#include <cmath>

#include "cartographer_sdf/field/distance_transform.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// The same cells with `margin` more on each side.
CellGeometry PadGeometry(const CellGeometry& geometry, const int margin) {
  CellGeometry padded = geometry;
  padded.size += 2 * margin;
  const double shift = -margin * geometry.resolution;
  padded.T_submap_grid = geometry.T_submap_grid * Rigid2(shift, shift, 0.);
  return padded;
}

BoolArray PadWithFalse(const BoolArray& cells, const int margin) {
  BoolArray padded = BoolArray::Constant(cells.rows() + 2 * margin,
                                         cells.cols() + 2 * margin, false);
  padded.block(margin, margin, cells.rows(), cells.cols()) = cells;
  return padded;
}

}  // namespace

std::string Validate(const FieldOptions& options) {
  if (!(options.occupied_probability > 0. &&
        options.occupied_probability < 1.)) {
    return "occupied_probability must lie between 0 and 1";
  }
  if (!(options.padding_meters >= 0. && options.padding_meters <= 10.)) {
    return "padding_meters must lie between 0 and 10";
  }
  return "";
}

std::optional<DistanceField> MakeDistanceField(const FieldOptions& options,
                                               const OccupancyGrid& grid) {
  CHECK_EQ(Validate(options), "");
  const int margin = static_cast<int>(
      std::lround(options.padding_meters / grid.geometry.resolution));
  DistanceField field;
  field.geometry = PadGeometry(grid.geometry, margin);
  field.observed = PadWithFalse(grid.known, margin);
  const BoolArray occupied = PadWithFalse(
      grid.known &&
          (grid.probability > static_cast<float>(options.occupied_probability)),
      margin);
  if (!occupied.any()) return std::nullopt;
  // Between the centres of an occupied cell and its neighbour lies the edge,
  // half a cell from each.
  const float resolution = static_cast<float>(grid.geometry.resolution);
  field.distance =
      resolution *
      (SquaredDistanceTransform(occupied).cast<float>().sqrt() - 0.5f);
  if (occupied.all()) return field;
  const Eigen::ArrayXXi squared_depth = SquaredDistanceTransform(!occupied);
  for (Eigen::Index k = 0; k < occupied.size(); ++k) {
    if (!occupied(k)) continue;
    field.distance(k) =
        resolution * (0.5f - std::sqrt(static_cast<float>(squared_depth(k))));
  }
  return field;
}

}  // namespace cartographer_sdf
