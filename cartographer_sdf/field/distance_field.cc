// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/field/distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

// Squared distances [cells^2] from occupied cells to the nearest cell that is
// not. Walls are thin, so most are found nearby, at a fraction of the cost of
// transforming the whole grid. At least one cell must not be occupied.
class SquaredDepths {
 public:
  explicit SquaredDepths(const BoolArray& occupied) : occupied_(occupied) {}

  int At(const Eigen::Index i, const Eigen::Index j) {
    for (int reach = 1; reach <= kMaxReach; ++reach) {
      const int nearest = NearestWithin(i, j, reach);
      // No cell farther out is nearer.
      if (nearest <= (reach + 1) * (reach + 1)) return nearest;
    }
    if (transform_.size() == 0) {
      transform_ = SquaredDistanceTransform(!occupied_);
    }
    return transform_(i, j);
  }

 private:
  // Enough for walls of twice this many cells: 40 cm at the usual 5 cm a cell.
  static constexpr int kMaxReach = 4;

  // Searches the cells up to `reach` away along each axis.
  int NearestWithin(const Eigen::Index i, const Eigen::Index j,
                    const int reach) const {
    int nearest = std::numeric_limits<int>::max();
    for (int b = -reach; b <= reach; ++b) {
      const Eigen::Index column = j + b;
      if (column < 0 || column >= occupied_.cols()) continue;
      for (int a = -reach; a <= reach; ++a) {
        const Eigen::Index row = i + a;
        if (row < 0 || row >= occupied_.rows() || occupied_(row, column)) {
          continue;
        }
        nearest = std::min(nearest, a * a + b * b);
      }
    }
    return nearest;
  }

  const BoolArray& occupied_;
  Eigen::ArrayXXi transform_;
};

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
  SquaredDepths squared_depths(occupied);
  for (Eigen::Index j = 0; j < occupied.cols(); ++j) {
    for (Eigen::Index i = 0; i < occupied.rows(); ++i) {
      if (!occupied(i, j)) continue;
      const float squared_depth = static_cast<float>(squared_depths.At(i, j));
      field.distance(i, j) = resolution * (0.5f - std::sqrt(squared_depth));
    }
  }
  return field;
}

}  // namespace cartographer_sdf
