// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/agreement.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cartographer_sdf {
namespace {

// A sample of this size gives a half overlap to 2 %.
constexpr size_t kMaxNumOverlapPoints = 1000;

constexpr size_t kChunkSize = 64;

// Side of a tile, and the length of wall with which it counts whole [m].
constexpr double kTileSize = 2.;
constexpr double kFullTileWallLength = 0.4;

// Cells of a model under points of another frame.
class CellLookup {
 public:
  CellLookup(const SurfaceModel& model, const Rigid2& T_model_points)
      : model_(model) {
    const Rigid2 T_grid_points =
        model.geometry.T_submap_grid.Inverse() * T_model_points;
    const double cells_per_meter = 1. / model.geometry.resolution;
    rotation_ = cells_per_meter * T_grid_points.RotationMatrix();
    translation_ = cells_per_meter * T_grid_points.translation();
  }

  // Null outside of the model.
  [[nodiscard]] const SurfaceCell* Find(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d cell = rotation_ * point + translation_;
    if (!(cell.x() >= 0. && cell.y() >= 0. &&
          cell.x() < model_.geometry.size.x() &&
          cell.y() < model_.geometry.size.y())) {
      return nullptr;
    }
    return &model_.cells(static_cast<Eigen::Index>(cell.x()),
                         static_cast<Eigen::Index>(cell.y()));
  }

 private:
  const SurfaceModel& model_;
  Eigen::Matrix2d rotation_;
  Eigen::Vector2d translation_;
};

// Calls visit(point, cell) for the first points that fall into the model.
template <typename Visitor>
void VisitCells(const SurfaceModel& model,
                const std::vector<SurfacePoint>& points,
                const Rigid2& T_model_points, const int max_num_points,
                const Visitor& visit) {
  const CellLookup lookup(model, T_model_points);
  const size_t count =
      std::min(static_cast<size_t>(max_num_points), points.size());
  std::array<const SurfaceCell*, kChunkSize> cells;
  for (size_t begin = 0; begin < count; begin += kChunkSize) {
    const size_t size = std::min(kChunkSize, count - begin);
    // The cells lie far apart in memory: all are on their way before the first
    // is looked at.
    for (size_t k = 0; k < size; ++k) {
      cells[k] = lookup.Find(points[begin + k].position);
      __builtin_prefetch(cells[k]);
    }
    for (size_t k = 0; k < size; ++k) {
      if (cells[k] != nullptr) visit(points[begin + k], *cells[k]);
    }
  }
}

double Weight(const AgreementOptions& options, const SurfacePoint& point) {
  return options.weigh_by_certainty ? point.weight : 1.;
}

// Squares that cover a submap, and what surrounds it within reach of a hit.
class Tiles {
 public:
  explicit Tiles(const SurfaceModel& model)
      : T_grid_submap_(model.geometry.T_submap_grid.Inverse()),
        size_((model.geometry.size.cast<double>() * model.geometry.resolution /
               kTileSize)
                  .ceil()
                  .cast<int>() +
              1),
        tiles_(size_.prod()) {}

  // Points beyond the grid have no cell there and hence no tile.
  void Add(const Eigen::Vector2d& p_submap, const double weight,
           const bool is_hit) {
    const Eigen::Vector2d p = (T_grid_submap_ * p_submap) / kTileSize;
    const Eigen::Array2i index =
        p.array().floor().cast<int>().max(0).min(size_ - 1);
    Tile& tile = tiles_[index.x() * size_.y() + index.y()];
    tile.weight += weight;
    if (is_hit) tile.hits += weight;
  }

  // `full_weight`: of a tile that counts whole.
  [[nodiscard]] TileAgreement Summarize(const double full_weight) const {
    TileAgreement result;
    for (const Tile& tile : tiles_) {
      if (tile.weight <= 0.) continue;
      const double part = std::min(1., tile.weight / full_weight);
      result.num_tiles += part;
      result.mean_hit_ratio += part * tile.hits / tile.weight;
    }
    if (result.num_tiles > 0.) result.mean_hit_ratio /= result.num_tiles;
    return result;
  }

 private:
  struct Tile {
    double weight = 0.;
    double hits = 0.;
  };
  const Rigid2 T_grid_submap_;
  const Eigen::Array2i size_;
  std::vector<Tile> tiles_;
};

}  // namespace

std::string Validate(const AgreementOptions& options) {
  if (!(options.hit_distance_meters > 0. &&
        options.contradiction_distance_meters >= options.hit_distance_meters)) {
    return "hit_distance_meters must be positive and not above "
           "contradiction_distance_meters";
  }
  if (options.max_num_points < 1) return "max_num_points must be positive";
  return "";
}

DirectedAgreement MeasureAgreement(const AgreementOptions& options,
                                   const SurfaceModel& model,
                                   const std::vector<SurfacePoint>& points,
                                   const Rigid2& T_model_points) {
  const double hit = options.hit_distance_meters;
  const double contradiction = options.contradiction_distance_meters;
  DirectedAgreement result;
  VisitCells(model, points, T_model_points, options.max_num_points,
             [&](const SurfacePoint& point, const SurfaceCell& cell) {
               const double weight = Weight(options, point);
               const double distance = 1e-3 * std::abs(cell.distance);
               // Walls border on the unknown, so a hit may well lie in it.
               if (distance <= hit) {
                 result.num_points += weight;
                 result.hits += weight;
                 result.squared_distance += weight * distance * distance;
               } else if (cell.observed) {
                 result.num_points += weight;
                 if (distance > contradiction) {
                   result.contradictions +=
                       weight *
                       (options.weigh_by_certainty ? cell.free / 255. : 1.);
                 }
               }
             });
  return result;
}

TileAgreement MeasureTileAgreement(const AgreementOptions& options,
                                   const SurfaceModel& reference,
                                   const SurfaceModel& query,
                                   const Rigid2& T_reference_query) {
  const size_t max_num_points = static_cast<size_t>(options.max_num_points);
  Tiles tiles(reference);
  const auto add_all =
      [&](const SurfaceModel& model, const SurfaceModel& points,
          const Rigid2& T_model_points, const Rigid2& T_reference_points) {
        const size_t count = std::min(max_num_points, points.walls.size());
        // Each point stands for those that are not looked at.
        const double stands_for = static_cast<double>(points.walls.size()) /
                                  static_cast<double>(count) *
                                  points.geometry.resolution;
        VisitCells(model, points.walls, T_model_points, options.max_num_points,
                   [&](const SurfacePoint& point, const SurfaceCell& cell) {
                     const bool is_hit = 1e-3 * std::abs(cell.distance) <=
                                         options.hit_distance_meters;
                     if (!is_hit && !cell.observed) return;
                     tiles.Add(T_reference_points * point.position,
                               stands_for * Weight(options, point), is_hit);
                   });
      };
  add_all(reference, query, T_reference_query, T_reference_query);
  add_all(query, reference, T_reference_query.Inverse(), Rigid2());
  return tiles.Summarize(kFullTileWallLength);
}

double OverlapArea(const SurfaceModel& reference, const SurfaceModel& query,
                   const Rigid2& T_reference_query) {
  const CellLookup lookup(reference, T_reference_query);
  const size_t num_points =
      std::min(query.observed_points.size(), kMaxNumOverlapPoints);
  int count = 0;
  for (size_t k = 0; k < num_points; ++k) {
    const SurfaceCell* const cell = lookup.Find(query.observed_points[k]);
    count += cell != nullptr && cell->observed;
  }
  return count * query.area_per_observed_point *
         static_cast<double>(query.observed_points.size()) /
         static_cast<double>(num_points);
}

std::optional<Eigen::Vector2d> OverlapCentroid(
    const SurfaceModel& reference, const SurfaceModel& query,
    const Rigid2& T_reference_query) {
  const CellLookup lookup(reference, T_reference_query);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (const Eigen::Vector2d& point : query.observed_points) {
    const SurfaceCell* const cell = lookup.Find(point);
    if (cell == nullptr || !cell->observed) continue;
    sum += point;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return Eigen::Vector2d(sum / count);
}

}  // namespace cartographer_sdf
