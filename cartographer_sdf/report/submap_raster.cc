// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/submap_raster.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cartographer_sdf/report/indexed_png.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Bounds of the known cells; empty if there are none.
Eigen::AlignedBox2i KnownCells(const OccupancyGrid& grid) {
  Eigen::AlignedBox2i bounds;
  for (int j = 0; j < grid.geometry.size.y(); ++j) {
    for (int i = 0; i < grid.geometry.size.x(); ++i) {
      if (grid.known(i, j)) bounds.extend(Eigen::Vector2i(i, j));
    }
  }
  return bounds;
}

Eigen::Vector2d MeanOf(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

// The one that is nearest to the mean of all: that itself may lie in a wall's
// curve, or in the void.
std::optional<Eigen::Vector2d> MiddleOf(
    const std::vector<Eigen::Vector2d>& points) {
  if (points.empty()) return std::nullopt;
  const Eigen::Vector2d mean = MeanOf(points);
  return *std::min_element(
      points.begin(), points.end(),
      [&mean](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        return (a - mean).squaredNorm() < (b - mean).squaredNorm();
      });
}

bool HasWallNear(const SubmapRaster& raster, const Eigen::Vector2d& p_submap) {
  const Eigen::Vector2d p_raster =
      raster.T_submap_raster.Inverse() * p_submap / raster.resolution;
  const int x = static_cast<int>(std::floor(p_raster.x()));
  const int y = static_cast<int>(std::floor(p_raster.y()));
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (raster.At(x + dx, y + dy) == CellClass::kWall) return true;
    }
  }
  return false;
}

}  // namespace

CellClass ClassOf(const OccupancyGrid& grid, const int i, const int j) {
  if (!grid.known(i, j)) return CellClass::kUnknown;
  const float probability = grid.probability(i, j);
  return probability >= kMinDrawnWallProbability   ? CellClass::kWall
         : probability <= kMaxDrawnFreeProbability ? CellClass::kFree
                                                   : CellClass::kUnknown;
}

CellClass SubmapRaster::At(const int x, const int y) const {
  if (x < 0 || y < 0 || x >= width || y >= height) return CellClass::kUnknown;
  return cells[static_cast<size_t>(y) * static_cast<size_t>(width) +
               static_cast<size_t>(x)];
}

CellClass SubmapRaster::AtPoint(const Eigen::Vector2d& p_submap) const {
  const Eigen::Vector2d p_raster =
      T_submap_raster.Inverse() * p_submap / resolution;
  return At(static_cast<int>(std::floor(p_raster.x())),
            static_cast<int>(std::floor(p_raster.y())));
}

Eigen::Vector2d SubmapRaster::CentreOf(const int x, const int y) const {
  return T_submap_raster * (resolution * Eigen::Vector2d(x + 0.5, y + 0.5));
}

SubmapRaster RasterizeSubmap(const OccupancyGrid& grid, const int max_pixels) {
  CHECK_GE(max_pixels, 1);
  SubmapRaster raster;
  const Eigen::AlignedBox2i known = KnownCells(grid);
  if (known.isEmpty()) return raster;
  const Eigen::Vector2i size = known.sizes() + Eigen::Vector2i::Ones();
  const int factor = (size.maxCoeff() + max_pixels - 1) / max_pixels;
  raster.width = (size.x() + factor - 1) / factor;
  raster.height = (size.y() + factor - 1) / factor;
  raster.resolution = factor * grid.geometry.resolution;
  raster.T_submap_raster =
      grid.geometry.T_submap_grid *
      Rigid2(grid.geometry.resolution * known.min().cast<double>(), 0.);
  const auto width = static_cast<size_t>(raster.width);
  raster.cells.assign(width * static_cast<size_t>(raster.height),
                      CellClass::kUnknown);
  for (int j = known.min().y(); j <= known.max().y(); ++j) {
    for (int i = known.min().x(); i <= known.max().x(); ++i) {
      const auto x = static_cast<size_t>((i - known.min().x()) / factor);
      const auto y = static_cast<size_t>((j - known.min().y()) / factor);
      CellClass& cell = raster.cells[y * width + x];
      cell = std::max(cell, ClassOf(grid, i, j));
    }
  }
  return raster;
}

std::string EncodePng(const SubmapRaster& raster) {
  if (raster.cells.empty()) return "";
  static const std::vector<Rgba>* const kPalette =
      new std::vector<Rgba>{{0, 0, 0, 0}, {255, 255, 255, 255}, {0, 0, 0, 255}};
  std::vector<uint8_t> pixels;
  pixels.reserve(raster.cells.size());
  for (const CellClass cell : raster.cells) {
    pixels.push_back(static_cast<uint8_t>(cell));
  }
  return EncodeIndexedPng(raster.width, raster.height, *kPalette, pixels);
}

std::optional<Eigen::Vector2d> WhereWallsOverlap(
    const SubmapRaster& reference, const SubmapRaster& query,
    const Rigid2& T_reference_query) {
  const Rigid2 T_query_reference = T_reference_query.Inverse();
  std::vector<Eigen::Vector2d> walls, known;
  for (int y = 0; y < reference.height; ++y) {
    for (int x = 0; x < reference.width; ++x) {
      const CellClass cell = reference.At(x, y);
      if (cell == CellClass::kUnknown) continue;
      const Eigen::Vector2d p_reference = reference.CentreOf(x, y);
      const Eigen::Vector2d p_query = T_query_reference * p_reference;
      if (query.AtPoint(p_query) != CellClass::kUnknown) {
        known.push_back(p_reference);
      }
      if (cell == CellClass::kWall && HasWallNear(query, p_query)) {
        walls.push_back(p_reference);
      }
    }
  }
  return MiddleOf(walls.empty() ? known : walls);
}

}  // namespace cartographer_sdf
