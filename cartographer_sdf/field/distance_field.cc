// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/field/distance_field.h"

#include <algorithm>
#include <cmath>
#include <cstring>
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

BoolArray PadWithFalse(const BoolArray& cells, const Eigen::Index margin) {
  BoolArray padded = BoolArray::Constant(cells.rows() + 2 * margin,
                                         cells.cols() + 2 * margin, false);
  padded.block(margin, margin, cells.rows(), cells.cols()) = cells;
  return padded;
}

// The first true cell, or the end. A search of whole words: few are true.
const bool* NextTrue(const bool* const begin, const bool* const end) {
  static_assert(sizeof(bool) == 1);
  const void* const found =
      std::memchr(begin, true, static_cast<size_t>(end - begin));
  return found == nullptr ? end : static_cast<const bool*>(found);
}

// The cells whose probability shows an obstacle, with `margin` more on each
// side.
BoolArray PaddedObstacles(const FieldOptions& options,
                          const OccupancyGrid& grid,
                          const Eigen::Index margin) {
  BoolArray occupied = BoolArray::Constant(
      grid.known.rows() + 2 * margin, grid.known.cols() + 2 * margin, false);
  const float threshold = static_cast<float>(options.occupied_probability);
  for (Eigen::Index j = 0; j < grid.known.cols(); ++j) {
    const bool* const known = &grid.known(0, j);
    const float* const probability = &grid.probability(0, j);
    bool* const result = &occupied(margin, j + margin);
    for (Eigen::Index i = 0; i < grid.known.rows(); ++i) {
      result[i] = known[i] & (probability[i] > threshold);
    }
  }
  return occupied;
}

// Squared distances [cells^2] from occupied cells to the nearest cell that is
// not. Walls are thin, so most are found nearby, at a fraction of the cost of
// transforming the whole grid. At least one cell must not be occupied.
class SquaredDepths {
 public:
  explicit SquaredDepths(const BoolArray& occupied) : occupied_(occupied) {}

  int At(const Eigen::Index i, const Eigen::Index j) {
    if (HasFreeSide(i, j)) return 1;
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

  // Whether one of the four cells that share a side, none beyond the rim, is
  // not occupied.
  bool HasFreeSide(const Eigen::Index i, const Eigen::Index j) const {
    if (i < 1 || j < 1 || i + 1 >= occupied_.rows() ||
        j + 1 >= occupied_.cols()) {
      return false;
    }
    const bool* const cell = &occupied_(i, j);
    return !(cell[-1] && cell[1] && cell[-occupied_.rows()] &&
             cell[occupied_.rows()]);
  }

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
  const BoolArray occupied = PaddedObstacles(options, grid, margin);
  if (!occupied.any()) return std::nullopt;
  const bool has_depths = !occupied.all();
  SquaredDepths squared_depths(occupied);
  // Between the centres of an occupied cell and its neighbour lies the edge,
  // half a cell from each.
  const float resolution = static_cast<float>(grid.geometry.resolution);
  const Eigen::Index rows = occupied.rows();
  field.distance.resize(rows, occupied.cols());
  VisitSquaredDistances(occupied, [&](const Eigen::Index j,
                                      const int* const squared) {
    float* const distance = &field.distance(0, j);
    for (Eigen::Index i = 0; i < rows; ++i) {
      distance[i] =
          resolution * (std::sqrt(static_cast<float>(squared[i])) - 0.5f);
    }
    if (!has_depths) return;
    const bool* const begin = &occupied(0, j);
    const bool* const end = begin + rows;
    for (const bool* cell = NextTrue(begin, end); cell != end;
         cell = NextTrue(cell + 1, end)) {
      const Eigen::Index i = cell - begin;
      const float squared_depth = static_cast<float>(squared_depths.At(i, j));
      distance[i] = resolution * (0.5f - std::sqrt(squared_depth));
    }
  });
  return field;
}

}  // namespace cartographer_sdf
