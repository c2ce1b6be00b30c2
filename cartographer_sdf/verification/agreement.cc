// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/agreement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "cartographer_sdf/place/surface_cell_lookup.h"

namespace cartographer_sdf {
namespace {

constexpr size_t kChunkSize = 64;

// Side of a tile, and the length of wall with which it counts whole [m].
constexpr double kTileSize = 2.;
constexpr double kFullTileWallLength = 0.4;

// Least overlap by which two submaps are judged, as a fraction of the smaller
// observed area.
constexpr double kMinOverlap = 0.4;

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
    Adder(Tiles* const tiles, const Rigid2& T_submap_points)
        : tiles_(tiles), last_(tiles->size_ - 1) {
      const Rigid2 T_grid_points = tiles->T_grid_submap_ * T_submap_points;
      rotation_ = T_grid_points.RotationMatrix() / kTileSize;
      translation_ = T_grid_points.translation() / kTileSize;
    }
    void operator()(const Eigen::Vector2d& point, const double weight,
                    const bool is_hit) const {
      const Eigen::Vector2d at = rotation_ * point + translation_;
      // Towards zero is downwards, where it is not below the first.
      const int i = std::clamp(static_cast<int>(at.x()), 0, last_.x());
      const int j = std::clamp(static_cast<int>(at.y()), 0, last_.y());
      Tile& tile = tiles_->tiles_[i * (last_.y() + 1) + j];
      tile.weight += weight;
      tile.hits += is_hit * weight;
    }

   private:
    Tiles* const tiles_;
    const Eigen::Array2i last_;
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

// Certainties as fractions.
const std::array<double, 256>& Fractions() {
  static const std::array<double, 256> kFractions = [] {
    std::array<double, 256> result = {};
    for (size_t k = 0; k < result.size(); ++k) {
      result[k] = static_cast<double>(k) / 255.;
    }
    return result;
  }();
  return kFractions;
}

// Adds up the points and calls visit(point, weight, is_hit) for each in the
// model; the weight is zero outside of what the model has observed. Without
// branches, as nobody could tell which points hit.
template <typename Visitor>
DirectedAgreement Measure(const AgreementOptions& options,
                          const SurfaceModel& model,
                          const std::vector<SurfacePoint>& points,
                          const Rigid2& T_model_points, const Visitor& visit) {
  const double hit = 1e3 * options.hit_distance_meters;
  const double contradiction = 1e3 * options.contradiction_distance_meters;
  const std::array<double, 256>& fractions = Fractions();
  const bool weighs = options.weigh_by_certainty;
  DirectedAgreement result;
  VisitCells(model, points, T_model_points, options.max_num_points,
             [&](const SurfacePoint& point, const SurfaceCell& cell) {
               const double distance = std::abs(cell.distance);
               // Walls border on the unknown, so a hit may well lie in it.
               const bool is_hit = distance <= hit;
               const double weight =
                   (weighs ? point.weight : 1.) * (is_hit | cell.observed);
               const double hit_weight = weight * is_hit;
               result.num_points += weight;
               result.hits += hit_weight;
               result.squared_distance += hit_weight * distance * distance;
               result.contradictions += weight *
                                        (weighs ? fractions[cell.free] : 1.) *
                                        (!is_hit & (distance > contradiction));
               visit(point, weight, is_hit);
             });
  result.squared_distance *= 1e-6;
  return result;
}

size_t NumOverlapPoints(const SurfaceModel& query, const int max_num_points) {
  return std::min(query.observed_points.size(),
                  static_cast<size_t>(max_num_points));
}

// Calls visit(point, is_observed) for the first observed points of the query,
// with whether the reference has observed them, too, until it returns false.
template <typename Visitor>
void VisitObserved(const SurfaceModel& reference, const SurfaceModel& query,
                   const Rigid2& T_reference_query, const size_t num_points,
                   const Visitor& visit) {
  const SurfaceCellLookup lookup(reference, T_reference_query);
  std::array<const SurfaceCell*, kChunkSize> cells;
  for (size_t begin = 0; begin < num_points; begin += kChunkSize) {
    const size_t size = std::min(kChunkSize, num_points - begin);
    for (size_t k = 0; k < size; ++k) {
      cells[k] = lookup.Find(query.observed_points[begin + k]);
      __builtin_prefetch(cells[k]);
    }
    for (size_t k = 0; k < size; ++k) {
      const bool is_observed = cells[k] != nullptr && cells[k]->observed;
      if (!visit(query.observed_points[begin + k], is_observed)) return;
    }
  }
}

// Keys are in the order of the tiles.
constexpr uint32_t kSign = 1u << 31;
uint64_t KeyOfTile(const int x, const int y) {
  return static_cast<uint64_t>(static_cast<uint32_t>(x) ^ kSign) << 32 |
         (static_cast<uint32_t>(y) ^ kSign);
}
TileIndex TileOfKey(const uint64_t key) {
  return {static_cast<int>(static_cast<uint32_t>(key >> 32) ^ kSign),
          static_cast<int>(static_cast<uint32_t>(key) ^ kSign)};
}

// That `count` of the first `num_points` observed points stand for [m^2].
double AreaOfPoints(const SurfaceModel& query, const int count,
                    const size_t num_points) {
  return count * query.area_per_observed_point *
         static_cast<double>(query.observed_points.size()) /
         static_cast<double>(num_points);
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
  const size_t num_points = NumOverlapPoints(query, max_num_points);
  int count = 0;
  VisitObserved(reference, query, T_reference_query, num_points,
                [&count](const Eigen::Vector2d&, const bool is_observed) {
                  count += is_observed;
                  return true;
                });
  return AreaOfPoints(query, count, num_points);
}

bool OverlapsEnough(const SurfaceModel& reference, const SurfaceModel& query,
                    const Rigid2& T_reference_query) {
  return OverlapArea(reference, query, T_reference_query) >=
         kMinOverlap * std::min(ObservedArea(reference), ObservedArea(query));
}

bool OverlapsBy(const double min_area, const SurfaceModel& reference,
                const SurfaceModel& query, const Rigid2& T_reference_query,
                const int max_num_points) {
  const size_t num_points = NumOverlapPoints(query, max_num_points);
  const int size = static_cast<int>(num_points);
  // As many as the area takes; to the point, whatever the rounding.
  int needed = static_cast<int>(
      std::clamp(min_area / AreaOfPoints(query, 1, num_points) - 1., 0.,
                 static_cast<double>(size)));
  while (needed <= size && AreaOfPoints(query, needed, num_points) < min_area) {
    ++needed;
  }
  // Not observed, of as many as may be missing.
  int num_missing = 0;
  int count = 0;
  VisitObserved(reference, query, T_reference_query, num_points,
                [&](const Eigen::Vector2d&, const bool is_observed) {
                  count += is_observed;
                  num_missing += !is_observed;
                  return count < needed && num_missing <= size - needed;
                });
  return count >= needed;
}

std::optional<Eigen::Vector2d> OverlapCentroid(
    const SurfaceModel& reference, const SurfaceModel& query,
    const Rigid2& T_reference_query) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  VisitObserved(reference, query, T_reference_query,
                query.observed_points.size(),
                [&](const Eigen::Vector2d& point, const bool is_observed) {
                  if (is_observed) sum += point;
                  count += is_observed;
                  return true;
                });
  if (count == 0) return std::nullopt;
  return Eigen::Vector2d(sum / count);
}

std::set<TileIndex> OverlapTiles(const SurfaceModel& reference,
                                 const SurfaceModel& query,
                                 const Rigid2& T_reference_query,
                                 const Rigid2& T_frame_reference,
                                 const double tile_size) {
  const Rigid2 T_frame_query = T_frame_reference * T_reference_query;
  const Eigen::Matrix2d R_frame_query = T_frame_query.RotationMatrix();
  std::vector<uint64_t> keys;
  VisitObserved(
      reference, query, T_reference_query,
      NumOverlapPoints(query, kMaxNumOverlapPoints),
      [&](const Eigen::Vector2d& point, const bool is_observed) {
        if (!is_observed) return true;
        const Eigen::Vector2d tile =
            (R_frame_query * point + T_frame_query.translation()) / tile_size;
        keys.push_back(KeyOfTile(static_cast<int>(std::floor(tile.x())),
                                 static_cast<int>(std::floor(tile.y()))));
        return true;
      });
  // Cheaper than a set that most points are in already.
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  std::set<TileIndex> tiles;
  for (const uint64_t key : keys) tiles.insert(tiles.end(), TileOfKey(key));
  return tiles;
}

}  // namespace cartographer_sdf
