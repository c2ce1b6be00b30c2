// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/union_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cartographer_sdf {
namespace {

constexpr float kMinOccupiedFraction = 0.5f;
constexpr double kMaxMapCoordinate = 1e7;
constexpr int kMaxUnionSide = 32000;  // distance_transform.h
// How much the least certain cell counts.
constexpr float kMinCertainty = 0.02f;

bool IsUsable(const CellGeometry& geometry, const Rigid2& T_map_submap) {
  return (geometry.size > 0).all() &&
         (T_map_submap.translation().array().abs() < kMaxMapCoordinate).all() &&
         std::isfinite(T_map_submap.rotation());
}

Eigen::AlignedBox2d FootprintBounds(const CellGeometry& geometry,
                                    const Rigid2& T_map_submap) {
  const Rigid2 T_map_grid = T_map_submap * geometry.T_submap_grid;
  const Eigen::Vector2d size =
      geometry.resolution * geometry.size.cast<double>();
  Eigen::AlignedBox2d bounds;
  for (const double x : {0., size.x()}) {
    for (const double y : {0., size.y()}) {
      bounds.extend(T_map_grid * Eigen::Vector2d(x, y));
    }
  }
  return bounds;
}

bool FitsMemory(const Eigen::Vector2d& extent, const double resolution) {
  const Eigen::Vector2d cells = extent / resolution;
  return cells.maxCoeff() < kMaxUnionSide &&
         cells.prod() < UnionGrid::kMaxNumCells;
}

}  // namespace

UnionGrid::UnionGrid(const std::vector<GridFootprint>& grids) {
  Eigen::AlignedBox2d bounds;
  double resolution = std::numeric_limits<double>::infinity();
  for (const GridFootprint& grid : grids) {
    if (!IsUsable(grid.geometry, grid.T_map_submap)) continue;
    bounds.extend(FootprintBounds(grid.geometry, grid.T_map_submap));
    resolution = std::min(resolution, grid.geometry.resolution);
  }
  if (bounds.isEmpty()) return;
  const double finest = resolution;
  while (!FitsMemory(bounds.sizes(), resolution)) resolution *= 1.25;
  // A wall of one small cell crosses so much of a large one.
  min_occupied_fraction_ =
      kMinOccupiedFraction * static_cast<float>(finest / resolution);
  const Eigen::Array2d first = (bounds.min() / resolution).array().floor();
  geometry_.resolution = resolution;
  geometry_.T_submap_grid = Rigid2(resolution * first.matrix(), 0.);
  geometry_.size =
      ((bounds.max() / resolution).array().ceil() - first).cast<int>().max(1);
  occupied_ = known_ =
      Eigen::ArrayXXf::Zero(geometry_.size.x(), geometry_.size.y());
}

void UnionGrid::Add(const OccupancyGrid& grid, const Rigid2& T_map_submap) {
  if (!IsUsable(grid.geometry, T_map_submap) || known_.size() == 0) return;
  if (grid.geometry.resolution < 0.99 * geometry_.resolution) {
    AddScattered(grid, T_map_submap);
  } else {
    AddSampled(grid, T_map_submap);
  }
}

void UnionGrid::AddScattered(const OccupancyGrid& grid,
                             const Rigid2& T_map_submap) {
  for (int j = 0; j < grid.geometry.size.y(); ++j) {
    for (int i = 0; i < grid.geometry.size.x(); ++i) {
      if (!grid.known(i, j)) continue;
      const Eigen::Array2i cell =
          geometry_.CellAt(T_map_submap * grid.geometry.CellCentre({i, j}));
      if (geometry_.Contains(cell)) AddCell(cell, grid.probability(i, j));
    }
  }
}

void UnionGrid::AddSampled(const OccupancyGrid& grid,
                           const Rigid2& T_map_submap) {
  const CellGeometry& geometry = grid.geometry;
  const Eigen::AlignedBox2d bounds = FootprintBounds(geometry, T_map_submap);
  const Eigen::Array2i first = geometry_.CellAt(bounds.min()).max(0);
  const Eigen::Array2i last =
      geometry_.CellAt(bounds.max()).min(geometry_.size - 1);
  // Cell coordinates in the submap's grid, of which the floor is the cell, are
  // an affine function of those in this one.
  const Rigid2 T_grid_map = (T_map_submap * geometry.T_submap_grid).Inverse();
  const auto to_cells = [&](const double i, const double j) {
    return Eigen::Array2d(
        (T_grid_map * (geometry_.T_submap_grid *
                       geometry_.CellsToGrid(Eigen::Vector2d(i, j))))
            .array() /
        geometry.resolution);
  };
  const Eigen::Array2d along_i = to_cells(1., 0.) - to_cells(0., 0.);
  for (int j = first.y(); j <= last.y(); ++j) {
    const Eigen::Array2d begin = to_cells(0., j);
    for (int i = first.x(); i <= last.x(); ++i) {
      const Eigen::Array2d at = begin + i * along_i;
      const Eigen::Array2i cell = at.floor().cast<int>();
      if (!geometry.Contains(cell) || !grid.known(cell.x(), cell.y())) continue;
      AddCell({i, j}, grid.probability(cell.x(), cell.y()));
    }
  }
}

void UnionGrid::AddCell(const Eigen::Array2i& cell, const float probability) {
  const float excess = probability - 0.5f;
  const float certainty = std::max(std::abs(excess), kMinCertainty);
  known_(cell.x(), cell.y()) += certainty;
  if (excess > 0.f) occupied_(cell.x(), cell.y()) += certainty;
}

std::optional<OccupancyGrid> UnionGrid::Finish() const {
  if (!(known_ > 0.f).any()) return std::nullopt;
  OccupancyGrid grid = UnknownGrid(geometry_);
  for (Eigen::Index k = 0; k < known_.size(); ++k) {
    const float known = known_.data()[k];
    if (known <= 0.f) continue;
    const float fraction = occupied_.data()[k] / known;
    grid.known.data()[k] = true;
    grid.probability.data()[k] = fraction >= min_occupied_fraction_
                                     ? std::clamp(fraction, 0.6f, 0.9f)
                                     : std::clamp(fraction, 0.1f, 0.4f);
  }
  return grid;
}

}  // namespace cartographer_sdf
