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

// Returns the length of the longest straight stretch that the points fill.
double LongestStretch(const std::vector<Eigen::Vector2d>& points,
                      const double resolution) {
  const double line_width =
      std::max(kLineWidth, kLineWidthInCells * resolution);
  const double max_gap = std::max(kMaxGap, kMaxGapInCells * resolution);
  double longest = 0.;
  // For each point the line that it lies on, and where along it.
  std::vector<std::pair<int, double>> on_lines(points.size());
  for (int k = 0; k < kNumWallDirections; ++k) {
    const double angle = k * M_PI / kNumWallDirections;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d across(-along.y(), along.x());
    for (size_t i = 0; i < points.size(); ++i) {
      on_lines[i] = {
          static_cast<int>(std::floor(across.dot(points[i]) / line_width)),
          along.dot(points[i])};
    }
    std::sort(on_lines.begin(), on_lines.end());
    size_t begin = 0;
    for (size_t i = 1; i < on_lines.size(); ++i) {
      if (on_lines[i].first != on_lines[begin].first ||
          on_lines[i].second - on_lines[i - 1].second > max_gap) {
        begin = i;
      }
      longest = std::max(longest, on_lines[i].second - on_lines[begin].second);
    }
  }
  return longest;
}

double LongestStretchInFreeSpace(const SurfaceModel& model,
                                 const SurfaceModel& points,
                                 const Rigid2& T_model_points) {
  return LongestStretch(PointsInFreeSpace(model, points, T_model_points),
                        points.geometry.resolution);
}

}  // namespace

std::string Validate(const CrossingOptions& options) {
  if (!(options.max_wall_meters > 0.)) {
    return "max_wall_meters must be positive";
  }
  if (!(options.max_crossed_fraction >= 0. &&
        options.max_crossed_fraction <= 1.)) {
    return "max_crossed_fraction must lie between 0 and 1";
  }
  return "";
}

double LongestCrossingWall(const SurfaceModel& reference,
                           const SurfaceModel& query,
                           const Rigid2& T_reference_query) {
  return std::max(
      LongestStretchInFreeSpace(reference, query, T_reference_query),
      LongestStretchInFreeSpace(query, reference, T_reference_query.Inverse()));
}

bool IsCrossed(const CrossingOptions& options, const size_t num_crossed,
               const size_t num_compared) {
  return static_cast<double>(num_crossed) >
         options.max_crossed_fraction * static_cast<double>(num_compared);
}

}  // namespace cartographer_sdf
