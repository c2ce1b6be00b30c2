// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/submap_pictures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "cartographer_sdf/report/submap_raster.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr Color kUnknown{0.78, 0.78, 0.78};
constexpr Color kReferenceWall{0.05, 0.15, 0.45};
constexpr Color kQueryWall{0.85, 0.1, 0.1};
constexpr Color kContradiction{1., 0.6, 0.};
constexpr Color kCorrespondence{0., 0.6, 0.3, 0.7};
// A wall this close explains a slightly displaced wall.
constexpr double kContradictionRadiusMeters = 0.3;
constexpr double kMaxTranslationMeters = 1e6;

bool IsWall(const OccupancyGrid& grid, const int i, const int j) {
  return ClassOf(grid, i, j) == CellClass::kWall;
}

bool IsFree(const OccupancyGrid& grid, const int i, const int j) {
  return ClassOf(grid, i, j) == CellClass::kFree;
}

bool IsFreeAt(const OccupancyGrid& grid, const Eigen::Vector2d& p_grid) {
  const Eigen::Array2i cell =
      (p_grid.array() / grid.geometry.resolution).floor().cast<int>();
  return grid.geometry.Contains(cell) && IsFree(grid, cell.x(), cell.y());
}

bool IsKnown(const OccupancyGrid& grid, const int i, const int j) {
  return grid.known(i, j);
}

// Centres of the cells for which `is_so` returns true, in the submap frame.
std::vector<Eigen::Vector2d> Centres(const OccupancyGrid& grid,
                                     bool (*is_so)(const OccupancyGrid&, int,
                                                   int)) {
  std::vector<Eigen::Vector2d> centres;
  for (int j = 0; j < grid.geometry.size.y(); ++j) {
    for (int i = 0; i < grid.geometry.size.x(); ++i) {
      if (is_so(grid, i, j)) {
        centres.push_back(grid.geometry.CellCentre({i, j}));
      }
    }
  }
  return centres;
}

// Bounding box of the known cells, or of the corner of a grid without any.
Eigen::AlignedBox2d KnownBounds(const OccupancyGrid& grid,
                                const Rigid2& T_frame_submap) {
  Eigen::AlignedBox2d bounds;
  for (const Eigen::Vector2d& centre : Centres(grid, IsKnown)) {
    bounds.extend(T_frame_submap * centre);
  }
  if (bounds.isEmpty()) {
    bounds.extend((T_frame_submap * grid.geometry.T_submap_grid).translation());
  }
  return bounds;
}

// Draws the free space of either submap. The sheet is in the reference's grid
// frame.
void DrawFreeSpace(const OccupancyGrid& reference, const OccupancyGrid& query,
                   const Rigid2& T_query_sheet, Sheet* const sheet) {
  constexpr Color kReferenceOnly{0.82, 0.88, 0.97};
  constexpr Color kQueryOnly{0.98, 0.87, 0.85};
  sheet->picture.BlendPixels(
      [&](const int x, const int y) -> std::optional<Color> {
        const Eigen::Vector2d p_sheet = sheet->frame.CentreOf(x, y);
        const bool in_reference = IsFreeAt(reference, p_sheet);
        const bool in_query = IsFreeAt(query, T_query_sheet * p_sheet);
        if (!in_reference && !in_query) return std::nullopt;
        return !in_query ? kReferenceOnly : !in_reference ? kQueryOnly : kWhite;
      });
}

// Draws squares of `size` [m] cell by cell, not pixel by pixel, so that none is
// lost.
void DrawCells(const std::vector<Eigen::Vector2d>& centres,
               const Rigid2& T_sheet_submap, const double size,
               const Color& color, Sheet* const sheet) {
  // Whole pixels: blended edges would look like uncertainty.
  const double pixels =
      std::max(1., std::round(size * sheet->frame.pixels_per_meter));
  for (const Eigen::Vector2d& centre : centres) {
    const Eigen::Vector2d corner =
        sheet->frame.ToPixels(T_sheet_submap * centre).array() - 0.5 * pixels;
    sheet->picture.DrawRectangle(corner.array().round(),
                                 Eigen::Vector2d::Constant(pixels), color);
  }
}

void DrawCorrespondences(const std::vector<PointPair>& correspondences,
                         const Rigid2& T_sheet_reference,
                         const Rigid2& T_sheet_query, Sheet* const sheet) {
  for (const PointPair& pair : correspondences) {
    const Eigen::Vector2d a =
        sheet->frame.ToPixels(T_sheet_reference * pair.first);
    const Eigen::Vector2d b =
        sheet->frame.ToPixels(T_sheet_query * pair.second);
    sheet->picture.DrawPolyline({a, b}, 1., kCorrespondence);
    sheet->picture.DrawCircle(a, 2., kCorrespondence, kCorrespondence);
  }
}

}  // namespace

std::vector<Eigen::Vector2d> ContradictedWalls(const OccupancyGrid& walls,
                                               const OccupancyGrid& space,
                                               const Rigid2& T_space_walls) {
  const int radius = static_cast<int>(
      std::ceil(kContradictionRadiusMeters / space.geometry.resolution));
  std::vector<Eigen::Vector2d> contradicted;
  for (const Eigen::Vector2d& p_walls : Centres(walls, IsWall)) {
    const Eigen::Vector2d p_space = T_space_walls * p_walls;
    const Eigen::Array2i centre = space.geometry.CellAt(p_space);
    bool all_free = true;
    for (int dj = -radius; all_free && dj <= radius; ++dj) {
      for (int di = -radius; all_free && di <= radius; ++di) {
        const Eigen::Array2i cell = centre + Eigen::Array2i(di, dj);
        all_free =
            space.geometry.Contains(cell) && IsFree(space, cell.x(), cell.y());
      }
    }
    if (all_free) contradicted.push_back(p_space);
  }
  return contradicted;
}

Picture DrawMatchedPair(const OccupancyGrid& reference,
                        const OccupancyGrid& query,
                        const Rigid2& T_reference_query,
                        const std::vector<PointPair>& correspondences,
                        const int max_pixels) {
  CHECK_LT(T_reference_query.translation().norm(), kMaxTranslationMeters);
  CHECK(std::isfinite(T_reference_query.rotation()));
  const Rigid2 T_sheet_reference = reference.geometry.T_submap_grid.Inverse();
  const Rigid2 T_sheet_query = T_sheet_reference * T_reference_query;
  const Rigid2 T_query_sheet =
      query.geometry.T_submap_grid.Inverse() * T_sheet_query.Inverse();
  Sheet sheet = MakeSheet(KnownBounds(reference, T_sheet_reference)
                              .merged(KnownBounds(query, T_sheet_query)),
                          max_pixels, kUnknown);
  DrawFreeSpace(reference, query, T_query_sheet, &sheet);
  const double resolution = reference.geometry.resolution;
  DrawCells(Centres(reference, IsWall), T_sheet_reference, resolution,
            kReferenceWall, &sheet);
  DrawCells(Centres(query, IsWall), T_sheet_query, query.geometry.resolution,
            kQueryWall, &sheet);
  DrawCells(ContradictedWalls(query, reference, T_reference_query),
            T_sheet_reference, 2. * resolution, kContradiction, &sheet);
  DrawCells(ContradictedWalls(reference, query, T_reference_query.Inverse()),
            T_sheet_query, 2. * resolution, kContradiction, &sheet);
  DrawCorrespondences(correspondences, T_sheet_reference, T_sheet_query,
                      &sheet);
  return std::move(sheet.picture);
}

}  // namespace cartographer_sdf
