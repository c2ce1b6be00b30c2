// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/field/distance_field.h"

#include <cmath>

#include "cartographer_sdf/field/distance_transform.h"
#include "glog/logging.h"

namespace cartographer_sdf {

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

OccupancyGrid Pad(const OccupancyGrid& grid, const int margin) {
  CellGeometry geometry = grid.geometry;
  geometry.size += 2 * margin;
  const double shift = -margin * geometry.resolution;
  geometry.T_submap_grid = geometry.T_submap_grid * Rigid2(shift, shift, 0.);
  OccupancyGrid padded = UnknownGrid(geometry);
  padded.probability.block(margin, margin, grid.geometry.size.x(),
                           grid.geometry.size.y()) = grid.probability;
  padded.known.block(margin, margin, grid.geometry.size.x(),
                     grid.geometry.size.y()) = grid.known;
  return padded;
}

std::optional<DistanceField> MakeDistanceField(const FieldOptions& options,
                                               const OccupancyGrid& grid) {
  CHECK_EQ(Validate(options), "");
  const int margin = static_cast<int>(
      std::lround(options.padding_meters / grid.geometry.resolution));
  OccupancyGrid padded = Pad(grid, margin);
  const BoolArray occupied =
      padded.known &&
      (padded.probability > static_cast<float>(options.occupied_probability));
  if (!occupied.any()) return std::nullopt;
  const float resolution = static_cast<float>(padded.geometry.resolution);
  // Between the centres of an occupied cell and its neighbour lies the edge,
  // half a cell from each.
  Eigen::ArrayXXf distance =
      SquaredDistanceTransform(occupied).cast<float>().sqrt() - 0.5f;
  if (!occupied.all()) {
    const Eigen::ArrayXXf depth =
        SquaredDistanceTransform(!occupied).cast<float>().sqrt() - 0.5f;
    distance = occupied.select(-depth, distance);
  }
  return DistanceField{padded.geometry, resolution * distance,
                       std::move(padded.known)};
}

}  // namespace cartographer_sdf
