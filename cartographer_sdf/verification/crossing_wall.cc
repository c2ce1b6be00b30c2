// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/crossing_wall.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "cartographer_sdf/place/surface_cell_lookup.h"

namespace cartographer_sdf {
namespace {

// Twice what counts as a contradiction: beyond what drift within a submap and
// registration leave.
constexpr double kMinDistance = 0.5;
// Wall and free space must both be more likely than not.
constexpr double kMinOccupied = 0.5;
constexpr double kMinFree = 0.4;
// Directions of walls that are tried. Between two of them, a wall of 3 m leaves
// its line by less than the width of a line.
constexpr int kNumWallDirections = 60;
// Width of a line, and the largest gap in a stretch of wall [m]; more in grids
// of large cells.
constexpr double kLineWidth = 0.1;
constexpr double kMaxGap = 0.25;
constexpr double kLineWidthInCells = 1.5;
constexpr double kMaxGapInCells = 2.5;
// Positions that are farther apart say nothing of the way between [m].
constexpr double kMaxStep = 1.5;

// The wall points of `points` that lie deep in free space of `model`, in the
// frame of `points`.
std::vector<Eigen::Vector2d> PointsInFreeSpace(const SurfaceModel& model,
                                               const SurfaceModel& points,
                                               const Rigid2& T_model_points) {
  const SurfaceCellLookup lookup(model, T_model_points);
  std::vector<Eigen::Vector2d> crossing;
  for (const SurfacePoint& point : points.walls) {
    if (point.weight < kMinOccupied) continue;
    const SurfaceCell* const cell = lookup.Find(point.position);
    if (cell != nullptr && cell->observed && cell->free >= 255. * kMinFree &&
        std::abs(cell->distance) >= 1e3 * kMinDistance) {
      crossing.push_back(point.position);
    }
  }
  return crossing;
}

// Whether the way leads across the line, between two places along it. `along`
// and `across` are orthonormal; the line is where across . p = `offset`.
bool LeadsAcross(const DrivenWay& way, const Eigen::Vector2d& along,
                 const Eigen::Vector2d& across, const double offset,
                 const double begin, const double end) {
  for (size_t i = 1; i < way.size(); ++i) {
    const double before = across.dot(way[i - 1]) - offset;
    const double after = across.dot(way[i]) - offset;
    if ((before < 0.) == (after < 0.) ||
        (way[i] - way[i - 1]).norm() > kMaxStep) {
      continue;
    }
    const double fraction = before / (before - after);
    const double where =
        along.dot(way[i - 1] + fraction * (way[i] - way[i - 1]));
    if (where >= begin && where <= end) return true;
  }
  return false;
}

// For each point the line in the direction `along` that it lies on, and where
// along it, in this order.
std::vector<std::pair<int, double>> SortAlongLines(
    const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& along,
    const Eigen::Vector2d& across, const double line_width) {
  std::vector<std::pair<int, double>> on_lines;
  on_lines.reserve(points.size());
  for (const Eigen::Vector2d& point : points) {
    on_lines.emplace_back(
        static_cast<int>(std::floor(across.dot(point) / line_width)),
        along.dot(point));
  }
  std::sort(on_lines.begin(), on_lines.end());
  return on_lines;
}

// Finds the longest straight stretch that the points fill, and that across
// which the way leads; both in the same frame.
CrossingWalls FindStretches(const std::vector<Eigen::Vector2d>& points,
                            const DrivenWay& way, const double resolution) {
  const double line_width =
      std::max(kLineWidth, kLineWidthInCells * resolution);
  const double max_gap = std::max(kMaxGap, kMaxGapInCells * resolution);
  CrossingWalls walls;
  for (int k = 0; k < kNumWallDirections; ++k) {
    const double angle = k * M_PI / kNumWallDirections;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d across(-along.y(), along.x());
    const auto on_lines = SortAlongLines(points, along, across, line_width);
    size_t begin = 0;
    for (size_t i = 0; i < on_lines.size(); ++i) {
      const auto& [line, position] = on_lines[i];
      const bool goes_on = i + 1 < on_lines.size() &&
                           on_lines[i + 1].first == line &&
                           on_lines[i + 1].second - position <= max_gap;
      if (goes_on) continue;
      const double start = on_lines[begin].second;
      const double length = position - start;
      walls.longest = std::max(walls.longest, length);
      if (length > walls.longest_driven_through &&
          LeadsAcross(way, along, across, (line + 0.5) * line_width, start,
                      position)) {
        walls.longest_driven_through = length;
      }
      begin = i + 1;
    }
  }
  return walls;
}

// Walls of `points` in the free space of `model`, through which `way` led.
CrossingWalls FindInFreeSpace(const SurfaceModel& model, const DrivenWay& way,
                              const SurfaceModel& points,
                              const Rigid2& T_model_points) {
  const std::vector<Eigen::Vector2d> crossing =
      PointsInFreeSpace(model, points, T_model_points);
  if (crossing.empty()) return {};
  const Rigid2 T_points_model = T_model_points.Inverse();
  DrivenWay way_among_points;
  for (const Eigen::Vector2d& position : way) {
    way_among_points.push_back(T_points_model * position);
  }
  return FindStretches(crossing, way_among_points, points.geometry.resolution);
}

}  // namespace

CrossingWalls FindCrossingWalls(const SurfaceModel& reference,
                                const DrivenWay& reference_way,
                                const SurfaceModel& query,
                                const DrivenWay& query_way,
                                const Rigid2& T_reference_query) {
  const CrossingWalls of_query =
      FindInFreeSpace(reference, reference_way, query, T_reference_query);
  const CrossingWalls of_reference =
      FindInFreeSpace(query, query_way, reference, T_reference_query.Inverse());
  return {std::max(of_query.longest, of_reference.longest),
          std::max(of_query.longest_driven_through,
                   of_reference.longest_driven_through)};
}

}  // namespace cartographer_sdf
