// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/viewpoints.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

using GridCell = Eigen::Array2i;

// How far a driven position may lie from free space [m]: maps bend, and what
// was free may have been blocked later.
constexpr double kMaxSeedDistance = 0.5;

// Adds the cells around the position to the reached ones.
void AddSeeds(const CellGeometry& geometry, const BoolArray& free,
              const Eigen::Vector2d& p_map, BoolArray* const reached,
              std::vector<GridCell>* const front) {
  const int reach = static_cast<int>(kMaxSeedDistance / geometry.resolution);
  const GridCell middle = geometry.CellAt(p_map);
  const GridCell first = (middle - reach).max(0);
  const GridCell last = (middle + reach).min(geometry.size - 1);
  for (int j = first.y(); j <= last.y(); ++j) {
    for (int i = first.x(); i <= last.x(); ++i) {
      if (!free(i, j) || (*reached)(i, j)) continue;
      (*reached)(i, j) = true;
      front->push_back({i, j});
    }
  }
}

// The reachable cell of a square that is nearest to its middle.
std::optional<GridCell> NearestToMiddle(const BoolArray& reachable,
                                        const GridCell& first, const int side) {
  std::optional<GridCell> nearest;
  int least = std::numeric_limits<int>::max();
  const GridCell last = (first + side)
                            .min(GridCell(static_cast<int>(reachable.rows()),
                                          static_cast<int>(reachable.cols())));
  for (int j = first.y(); j < last.y(); ++j) {
    for (int i = first.x(); i < last.x(); ++i) {
      if (!reachable(i, j)) continue;
      const GridCell offset = 2 * (GridCell(i, j) - first) - (side - 1);
      const int distance = (offset * offset).sum();
      if (distance >= least) continue;
      least = distance;
      nearest = GridCell(i, j);
    }
  }
  return nearest;
}

std::vector<Eigen::Vector2d> PlaceViewpoints(const BoolArray& reachable,
                                             const int side) {
  std::vector<Eigen::Vector2d> positions;
  for (int j = 0; j < reachable.cols(); j += side) {
    for (int i = 0; i < reachable.rows(); i += side) {
      const std::optional<GridCell> cell =
          NearestToMiddle(reachable, {i, j}, side);
      if (cell)
        positions.push_back(cell->matrix().cast<double>().array() + 0.5);
    }
  }
  return positions;
}

// Writes a panorama to the arrays, which have room for it.
void TakePanorama(const RayMap& map,
                  const std::vector<Eigen::Vector2d>& directions,
                  const Eigen::Vector2d& position, uint8_t* const ranges,
                  uint8_t* const masks) {
  constexpr double kMaxUnits = 255.;
  const double units_per_cell = map.geometry().resolution / kPanoramaUnit;
  for (int k = 0; k < kNumDirections; ++k) {
    const Ray ray =
        CastRay(map, position, directions[k], kMaxUnits / units_per_cell,
                /*stops_at_grazed=*/true);
    const uint8_t range =
        static_cast<uint8_t>(std::min(kMaxUnits, ray.range * units_per_cell));
    const uint8_t mask = ray.end == RayEnd::kUnknown ? 0 : 255;
    ranges[k] = ranges[k + kNumDirections] = range;
    masks[k] = masks[k + kNumDirections] = mask;
  }
}

}  // namespace

std::string Validate(const ViewpointOptions& options) {
  if (!(options.step_meters >= 0.05 && options.step_meters <= 5.)) {
    return "step_meters must lie between 0.05 and 5";
  }
  if (options.max_num_viewpoints < 1 ||
      options.max_num_viewpoints > 10'000'000) {
    return "max_num_viewpoints must lie between 1 and 10000000";
  }
  if (!(options.min_clearance_meters >= 0. &&
        options.min_clearance_meters <= 5.)) {
    return "min_clearance_meters must lie between 0 and 5";
  }
  return "";
}

BoolArray ReachableCells(const RayMap& map, const double min_clearance,
                         const std::vector<Eigen::Vector2d>& driven_positions) {
  const CellGeometry& geometry = map.geometry();
  const BoolArray free =
      map.field.observed &&
      map.field.distance > static_cast<float>(std::max(0., min_clearance));
  if (driven_positions.empty()) return free;
  BoolArray reached = BoolArray::Constant(free.rows(), free.cols(), false);
  std::vector<GridCell> front;
  for (const Eigen::Vector2d& position : driven_positions) {
    AddSeeds(geometry, free, position, &reached, &front);
  }
  while (!front.empty()) {
    const GridCell cell = front.back();
    front.pop_back();
    for (const GridCell& step :
         {GridCell(1, 0), GridCell(-1, 0), GridCell(0, 1), GridCell(0, -1)}) {
      const GridCell next = cell + step;
      if (!geometry.Contains(next) || !free(next.x(), next.y()) ||
          reached(next.x(), next.y())) {
        continue;
      }
      reached(next.x(), next.y()) = true;
      front.push_back(next);
    }
  }
  return reached;
}

Viewpoints MakeViewpoints(const ViewpointOptions& options, const RayMap& map,
                          const BoolArray& reachable) {
  CHECK_EQ(Validate(options), "");
  const double resolution = map.geometry().resolution;
  int side = std::max(
      1, static_cast<int>(std::lround(options.step_meters / resolution)));
  Viewpoints viewpoints;
  viewpoints.positions = PlaceViewpoints(reachable, side);
  while (viewpoints.positions.size() >
         static_cast<size_t>(options.max_num_viewpoints)) {
    side += 1 + side / 8;
    viewpoints.positions = PlaceViewpoints(reachable, side);
  }
  viewpoints.step = side * resolution;
  std::vector<Eigen::Vector2d> directions;
  for (int k = 0; k < kNumDirections; ++k) {
    const double angle = 2. * M_PI * (k + 0.5) / kNumDirections;
    directions.emplace_back(std::cos(angle), std::sin(angle));
  }
  const size_t size = kPanoramaSize * viewpoints.positions.size();
  viewpoints.ranges.resize(size);
  viewpoints.masks.resize(size);
  for (size_t n = 0; n < viewpoints.positions.size(); ++n) {
    TakePanorama(map, directions, viewpoints.positions[n],
                 viewpoints.ranges.data() + kPanoramaSize * n,
                 viewpoints.masks.data() + kPanoramaSize * n);
  }
  return viewpoints;
}

}  // namespace cartographer_sdf
