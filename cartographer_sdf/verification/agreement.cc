// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/agreement.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cartographer_sdf/place/surface_cell_lookup.h"

namespace cartographer_sdf {
namespace {

constexpr size_t kChunkSize = 64;

// Side of a tile, and the length of wall with which it counts whole [m].
constexpr double kTileSize = 2.;
constexpr double kFullTileWallLength = 0.4;

// Calls visit(point, cell) for the first points that fall into the model.
template <typename Visitor>
void VisitCells(const SurfaceModel& model,
                const std::vector<SurfacePoint>& points,
                const Rigid2& T_model_points, const int max_num_points,
                const Visitor& visit) {
  const SurfaceCellLookup lookup(model, T_model_points);
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

  // Of points in a frame that T_submap_points takes to the submap's. Points
  // beyond the grid have no cell there and hence no tile.
  class Adder {
   public:
    Adder(Tiles* const tiles, const Rigid2& T_submap_points) : tiles_(tiles) {
      const Rigid2 T_grid_points = tiles->T_grid_submap_ * T_submap_points;
      rotation_ = T_grid_points.RotationMatrix() / kTileSize;
      translation_ = T_grid_points.translation() / kTileSize;
    }
    void operator()(const Eigen::Vector2d& point, const double weight,
                    const bool is_hit) const {
      const Eigen::Array2i index = (rotation_ * point + translation_)
                                       .array()
                                       .floor()
                                       .cast<int>()
                                       .max(0)
                                       .min(tiles_->size_ - 1);
      Tile& tile = tiles_->tiles_[index.x() * tiles_->size_.y() + index.y()];
      tile.weight += weight;
      if (is_hit) tile.hits += weight;
    }

   private:
    Tiles* const tiles_;
    Eigen::Matrix2d rotation_;
    Eigen::Vector2d translation_;
  };

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

// Adds up the points and calls visit(point, weight, is_hit) for each that lies
// within what the model has observed.
template <typename Visitor>
DirectedAgreement Measure(const AgreementOptions& options,
                          const SurfaceModel& model,
                          const std::vector<SurfacePoint>& points,
                          const Rigid2& T_model_points, const Visitor& visit) {
  const double hit = 1e3 * options.hit_distance_meters;
  const double contradiction = 1e3 * options.contradiction_distance_meters;
  DirectedAgreement result;
  VisitCells(
      model, points, T_model_points, options.max_num_points,
      [&](const SurfacePoint& point, const SurfaceCell& cell) {
        const double distance = std::abs(cell.distance);
        // Walls border on the unknown, so a hit may well lie in it.
        const bool is_hit = distance <= hit;
        if (!is_hit && !cell.observed) return;
        const double weight = options.weigh_by_certainty ? point.weight : 1.;
        result.num_points += weight;
        if (is_hit) {
          result.hits += weight;
          result.squared_distance += weight * distance * distance;
        } else if (distance > contradiction) {
          result.contradictions +=
              weight * (options.weigh_by_certainty ? cell.free / 255. : 1.);
        }
        visit(point, weight, is_hit);
      });
  result.squared_distance *= 1e-6;
  return result;
}

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
  return Measure(options, model, points, T_model_points,
                 [](const SurfacePoint& /*point*/, const double /*weight*/,
                    const bool /*is_hit*/) {});
}

PairAgreement MeasurePairAgreement(const AgreementOptions& options,
                                   const SurfaceModel& reference,
                                   const SurfaceModel& query,
                                   const Rigid2& T_reference_query) {
  Tiles tiles(reference);
  const auto measure = [&](const SurfaceModel& model,
                           const SurfaceModel& points,
                           const Rigid2& T_model_points,
                           const Rigid2& T_reference_points) {
    // Each point stands for those that are not looked at.
    const double stands_for =
        std::max(1., static_cast<double>(points.walls.size()) /
                         static_cast<double>(options.max_num_points)) *
        points.geometry.resolution;
    const Tiles::Adder add(&tiles, T_reference_points);
    return Measure(
        options, model, points.walls, T_model_points,
        [&](const SurfacePoint& point, const double weight, const bool is_hit) {
          add(point.position, stands_for * weight, is_hit);
        });
  };
  PairAgreement result;
  result.query_in_reference =
      measure(reference, query, T_reference_query, T_reference_query);
  result.reference_in_query =
      measure(query, reference, T_reference_query.Inverse(), Rigid2());
  result.tiles = tiles.Summarize(kFullTileWallLength);
  return result;
}

double OverlapArea(const SurfaceModel& reference, const SurfaceModel& query,
                   const Rigid2& T_reference_query, const int max_num_points) {
  const SurfaceCellLookup lookup(reference, T_reference_query);
  const size_t num_points = std::min(query.observed_points.size(),
                                     static_cast<size_t>(max_num_points));
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
  const SurfaceCellLookup lookup(reference, T_reference_query);
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

std::set<TileIndex> OverlapTiles(const SurfaceModel& reference,
                                 const SurfaceModel& query,
                                 const Rigid2& T_reference_query,
                                 const Rigid2& T_frame_reference,
                                 const double tile_size) {
  const SurfaceCellLookup lookup(reference, T_reference_query);
  const Rigid2 T_frame_query = T_frame_reference * T_reference_query;
  const size_t num_points = std::min(query.observed_points.size(),
                                     static_cast<size_t>(kMaxNumOverlapPoints));
  std::set<TileIndex> tiles;
  for (size_t k = 0; k < num_points; ++k) {
    const SurfaceCell* const cell = lookup.Find(query.observed_points[k]);
    if (cell == nullptr || !cell->observed) continue;
    const Eigen::Vector2d tile =
        (T_frame_query * query.observed_points[k]) / tile_size;
    tiles.emplace(static_cast<int>(std::floor(tile.x())),
                  static_cast<int>(std::floor(tile.y())));
  }
  return tiles;
}

}  // namespace cartographer_sdf
