// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/place/surface_model.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace cartographer_sdf {
namespace {

// Certainty grows linearly with the probability: a wall seen once (0.55) has a
// weight of 0.28, one at 0.73 or more counts fully; free space seen once (0.49)
// hardly counts, at 0.25 or less fully.
constexpr float kWallOffset = 0.48f;
constexpr float kFreeOffset = 0.5f;
constexpr float kCertaintyRange = 0.25f;

// About one observed point for each square of this side [m].
constexpr double kObservedPointSpacing = 0.25;

// Fisher-Yates with a fixed seed and our own draws, as std::shuffle differs
// between libraries.
template <typename T>
void Mix(std::vector<T>* const items) {
  std::mt19937 generator(42);
  for (size_t k = items->size(); k > 1; --k) {
    const uint64_t other = (static_cast<uint64_t>(generator()) * k) >> 32;
    std::swap((*items)[k - 1], (*items)[other]);
  }
}

// The certainty that a known cell of that probability is free.
inline uint8_t FreeCertainty(const float probability, const float threshold) {
  const float certainty =
      std::clamp((kFreeOffset - probability) / kCertaintyRange, 0.f, 1.f);
  return static_cast<uint8_t>(
      probability > threshold ? 0 : RoundHalfAway(255.f * certainty));
}

// Adds the walls as weighted points, and the certainty of the free cells.
void AddCertainty(const FieldOptions& options, const OccupancyGrid& grid,
                  SurfaceCellArray* const all_cells,
                  SurfaceModel* const model) {
  const CellGeometry& geometry = grid.geometry;
  const Eigen::Array2i margin = (model->geometry.size - geometry.size) / 2;
  const float threshold = static_cast<float>(options.occupied_probability);
  for (int j = 0; j < geometry.size.y(); ++j) {
    const bool* const known = &grid.known(0, j);
    const float* const probability = &grid.probability(0, j);
    SurfaceCell* const cells = &(*all_cells)(margin.x(), j + margin.y());
    for (int i = 0; i < geometry.size.x(); ++i) {
      if (!known[i]) continue;
      cells[i].free = FreeCertainty(probability[i], threshold);
      if (!(probability[i] > threshold)) continue;
      const float weight =
          std::min((probability[i] - kWallOffset) / kCertaintyRange, 1.f);
      if (weight > 0.f) {
        model->walls.push_back({geometry.CellCentre({i, j}), weight});
      }
    }
  }
}

}  // namespace

std::optional<SurfaceModel> MakeSurfaceModel(const FieldOptions& options,
                                             const OccupancyGrid& grid) {
  const std::optional<DistanceField> field = MakeDistanceField(options, grid);
  if (!field) return std::nullopt;
  return MakeSurfaceModel(options, grid, *field);
}

std::optional<SurfaceModel> MakeSurfaceModel(const FieldOptions& options,
                                             const OccupancyGrid& grid,
                                             const DistanceField& field) {
  SurfaceModel model;
  model.geometry = field.geometry;
  const CellGeometry& geometry = model.geometry;
  SurfaceCellArray cells(geometry.size.x(), geometry.size.y());
  const float* const distance = field.distance.data();
  const bool* const observed = field.observed.data();
  for (Eigen::Index k = 0; k < cells.size(); ++k) {
    cells.data()[k] = {DistanceInMillimetres(distance[k]), 0, observed[k]};
  }
  AddCertainty(options, grid, &cells, &model);
  model.cells = SurfaceCells(std::move(cells), geometry.resolution);
  const int stride =
      std::max(1, static_cast<int>(std::lround(kObservedPointSpacing /
                                               geometry.resolution)));
  for (int j = 0; j < grid.geometry.size.y(); j += stride) {
    for (int i = 0; i < grid.geometry.size.x(); i += stride) {
      if (!grid.known(i, j)) continue;
      model.observed_points.push_back(grid.geometry.CellCentre({i, j}));
    }
  }
  if (model.observed_points.empty() || model.walls.empty()) {
    return std::nullopt;
  }
  // They stay as many; growing has left room for up to twice the number.
  model.walls.shrink_to_fit();
  model.observed_points.shrink_to_fit();
  model.area_per_observed_point = std::pow(stride * geometry.resolution, 2);
  Mix(&model.walls);
  Mix(&model.observed_points);
  return model;
}

double ObservedArea(const SurfaceModel& model) {
  return static_cast<double>(model.observed_points.size()) *
         model.area_per_observed_point;
}

Eigen::Vector2d ObservedCentroid(const SurfaceModel& model) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : model.observed_points) sum += point;
  return sum / static_cast<double>(model.observed_points.size());
}

}  // namespace cartographer_sdf
