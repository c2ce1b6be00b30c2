// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/map_painter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr Color kUnobserved{0.5, 0.5, 0.5};
constexpr Color kInk{0.15, 0.15, 0.2};
// Along each axis: with pixels at least as large as a cell, samples are at most
// half a pixel apart, and no pixel inside a rotated grid stays empty.
constexpr int kSamplesPerCell = 2;
// Draws cells with a few more misses than hits white: with the host's default
// miss probability of 0.49, ten misses yield 0.4, fifty 0.12.
constexpr double kContrast = 3.;
// If a pixel is much larger than a cell, a wall covers only a fraction of it.
constexpr double kMaxWallGain = 4.;
constexpr double kMarginMeters = 0.5;
constexpr Color kConflict{0.9, 0.1, 0.1};
// Beyond it, a pixel is certainly wall or free.
constexpr double kSureExcess = 0.15;

// No map extends over more than a quarter of the earth's circumference.
constexpr double kMaxDrawnCoordinate = 1e7;

bool IsDrawable(const Eigen::Vector2d& position) {
  return (position.array().abs() < kMaxDrawnCoordinate).all();
}

bool IsDrawable(const Rigid2& pose) {
  return IsDrawable(pose.translation()) && std::isfinite(pose.rotation());
}

// Large pictures are shrunk to fit, and must remain readable.
double StrokeScale(const Picture& picture) {
  return std::max(1., std::max(picture.width(), picture.height()) / 700.);
}

// Of an indexed picture, from surely free to surely wall.
constexpr int kNumLevels = 15;
// CategoryColor repeats.
constexpr int kNumMapColors = 6;

Rgba ToRgba(const Color& color) {
  const auto byte = [](const double part) {
    return static_cast<uint8_t>(std::lround(255. * part));
  };
  return {byte(color.red), byte(color.green), byte(color.blue),
          byte(color.alpha)};
}

// As Paint() maps the excess to grey.
int LevelOf(const double excess, const int num_levels) {
  return static_cast<int>(std::lround(
      std::clamp(0.5 + kContrast * excess, 0., 1.) * (num_levels - 1)));
}

IndexedPicture BlankPicture(const MapPainter& map) {
  IndexedPicture picture;
  picture.width = map.size().x();
  picture.height = map.size().y();
  picture.pixels.reserve(static_cast<size_t>(picture.width) *
                         static_cast<size_t>(picture.height));
  return picture;
}

// Uncertain walls are paler; free space has the first level.
int WallLevelOf(const double excess) {
  return static_cast<int>(
      std::lround(std::clamp(kContrast * excess, 0., 1.) * (kNumLevels - 1)));
}

// The levels are from white to the colour of walls.
IndexedPicture PaintLevels(const MapPainter& map, const Color& wall,
                           const std::function<int(double)>& level_of) {
  IndexedPicture picture = BlankPicture(map);
  picture.palette.push_back({0, 0, 0, 0});
  for (int level = 0; level < kNumLevels; ++level) {
    picture.palette.push_back(
        ToRgba(Mix(kWhite, wall, level / (kNumLevels - 1.))));
  }
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const std::optional<double> excess = map.ExcessAt(x, y);
      picture.pixels.push_back(
          excess ? static_cast<uint8_t>(1 + level_of(*excess)) : 0);
    }
  }
  return picture;
}

// What several maps say of a pixel.
struct OverlaidPixel {
  bool is_known = false, is_free = false, is_wall = false;
  // The map that is surest of a wall.
  size_t map = 0;
  double excess = 0.;

  [[nodiscard]] bool IsInConflict() const { return is_free && is_wall; }
};

OverlaidPixel OverlayAt(const std::vector<MapPainter>& maps, const int x,
                        const int y) {
  OverlaidPixel pixel;
  for (size_t k = 0; k < maps.size(); ++k) {
    const std::optional<double> excess = maps[k].ExcessAt(x, y);
    if (!excess) continue;
    pixel.is_known = true;
    pixel.is_free |= *excess < -kSureExcess;
    pixel.is_wall |= *excess > kSureExcess;
    if (*excess > pixel.excess) {
      pixel.excess = *excess;
      pixel.map = k;
    }
  }
  return pixel;
}

constexpr int kMaxPicturePixels = 16384;

// What a picture of the grids shows [m], and their finest cell.
struct DrawnGrids {
  Eigen::AlignedBox2d bounds;
  double finest_resolution = std::numeric_limits<double>::infinity();
  int num_grids = 0;
};

DrawnGrids BoundGrids(const std::vector<PlacedGrid>& grids) {
  DrawnGrids drawn;
  for (const PlacedGrid& grid : grids) {
    if ((grid.geometry.size <= 0).any() || !IsDrawable(grid.T_map_submap)) {
      continue;
    }
    const Rigid2 T_map_grid = grid.T_map_submap * grid.geometry.T_submap_grid;
    const Eigen::Vector2d size =
        grid.geometry.size.cast<double>() * grid.geometry.resolution;
    for (const double x : {0., size.x()}) {
      for (const double y : {0., size.y()}) {
        drawn.bounds.extend(T_map_grid * Eigen::Vector2d(x, y));
      }
    }
    ++drawn.num_grids;
    drawn.finest_resolution =
        std::min(drawn.finest_resolution, grid.geometry.resolution);
  }
  if (drawn.bounds.isEmpty()) {
    drawn.bounds.extend(Eigen::Vector2d::Zero());
    drawn.finest_resolution = 0.05;
  }
  drawn.bounds.min().array() -= kMarginMeters;
  drawn.bounds.max().array() += kMarginMeters;
  return drawn;
}

}  // namespace

MapPainter::MapPainter(const std::vector<PlacedGrid>& grids,
                       const int max_pixels) {
  CHECK_GE(max_pixels, 1);
  const DrawnGrids drawn = BoundGrids(grids);
  finest_resolution_ = drawn.finest_resolution;
  SetFrame(drawn.bounds,
           std::max(finest_resolution_,
                    drawn.bounds.sizes().maxCoeff() / max_pixels),
           max_pixels);
}

absl::StatusOr<MapPainter> MapPainter::WithPixelSize(
    const std::vector<PlacedGrid>& grids, const double pixel_size) {
  const DrawnGrids drawn = BoundGrids(grids);
  if (drawn.num_grids == 0) {
    return absl::InvalidArgumentError("there are no submaps to draw");
  }
  const double finest = drawn.finest_resolution;
  // Files have cells of single precision.
  constexpr double kMicrometers = 1e6;
  const double size = pixel_size == 0.
                          ? std::round(kMicrometers * finest) / kMicrometers
                          : pixel_size;
  // A last digit makes no finer cell.
  if (!(size >= finest * (1. - 1e-6))) {
    return absl::InvalidArgumentError(absl::StrCat(
        "pixels of ", size, " m are finer than the cells, ", finest, " m"));
  }
  if (drawn.bounds.sizes().maxCoeff() > kMaxPicturePixels * size) {
    return absl::OutOfRangeError(
        absl::StrCat("pixels of ", size,
                     " m are too small: there would be "
                     "more than ",
                     kMaxPicturePixels, " along a side"));
  }
  MapPainter painter;
  painter.finest_resolution_ = finest;
  painter.SetFrame(drawn.bounds, size, kMaxPicturePixels);
  return painter;
}

void MapPainter::SetFrame(const Eigen::AlignedBox2d& bounds,
                          const double pixel_size, const int max_pixels) {
  frame_ = PixelFrame{1. / pixel_size, {bounds.min().x(), bounds.max().y()}};
  const auto num_pixels = [&](const double length) {
    return std::clamp(static_cast<int>(std::ceil(length / pixel_size - 1e-6)),
                      1, max_pixels);
  };
  const Eigen::Vector2d extent = bounds.sizes();
  num_samples_ = occupied_ = free_ =
      Eigen::ArrayXXf::Zero(num_pixels(extent.x()), num_pixels(extent.y()));
}

void MapPainter::AddSubmap(const OccupancyGrid& grid,
                           const Rigid2& T_map_submap) {
  if (!IsDrawable(T_map_submap)) return;
  const CellGeometry& geometry = grid.geometry;
  const Rigid2 T_map_grid = T_map_submap * geometry.T_submap_grid;
  // Pixel coordinates are an affine function of cell coordinates.
  const auto to_pixels = [&](const double i, const double j) {
    return frame_.ToPixels(T_map_grid *
                           geometry.CellsToGrid(Eigen::Vector2d(i, j)));
  };
  const Eigen::Array2d size(num_samples_.rows(), num_samples_.cols());
  const Eigen::Vector2d origin = to_pixels(0., 0.);
  const Eigen::Vector2d along_i = to_pixels(1., 0.) - origin;
  const Eigen::Vector2d along_j = to_pixels(0., 1.) - origin;
  for (int j = 0; j < geometry.size.y(); ++j) {
    for (int i = 0; i < geometry.size.x(); ++i) {
      if (!grid.known(i, j)) continue;
      const float excess = grid.probability(i, j) - 0.5f;
      for (int sample = 0; sample < kSamplesPerCell * kSamplesPerCell;
           ++sample) {
        const int row = sample / kSamplesPerCell;
        const double di = (sample % kSamplesPerCell + 0.5) / kSamplesPerCell;
        const double dj = (row + 0.5) / kSamplesPerCell;
        const Eigen::Vector2d pixel =
            origin + (i + di - 0.5) * along_i + (j + dj - 0.5) * along_j;
        if (!((pixel.array() >= 0.) && (pixel.array() < size)).all()) continue;
        const int x = static_cast<int>(pixel.x());
        const int y = static_cast<int>(pixel.y());
        num_samples_(x, y) += 1.f;
        (excess > 0.f ? occupied_ : free_)(x, y) += std::abs(excess);
      }
    }
  }
}

std::optional<double> MapPainter::ExcessAt(const int x, const int y) const {
  const double num_samples = num_samples_(x, y);
  if (num_samples == 0.) return std::nullopt;
  const double pixels_per_cell = frame_.pixels_per_meter * finest_resolution_;
  const double wall_gain = std::clamp(1. / pixels_per_cell, 1., kMaxWallGain);
  return (wall_gain * occupied_(x, y) - free_(x, y)) / num_samples;
}

Picture MapPainter::UnobservedPicture() const {
  return Picture(static_cast<int>(num_samples_.rows()),
                 static_cast<int>(num_samples_.cols()), kUnobserved);
}

Picture MapPainter::Paint() const {
  Picture picture = UnobservedPicture();
  picture.BlendPixels([this](const int x, const int y) -> std::optional<Color> {
    const std::optional<double> excess = ExcessAt(x, y);
    if (!excess) return std::nullopt;
    const double grey = std::clamp(0.5 - kContrast * *excess, 0., 1.);
    return Color{grey, grey, grey};
  });
  return picture;
}

std::string IndexedPicture::EncodePng() const {
  return EncodeIndexedPng(width, height, palette, pixels);
}

IndexedPicture PaintIndexed(const MapPainter& map, const Color& wall) {
  return PaintLevels(map, wall, [](const double excess) {
    return LevelOf(excess, kNumLevels);
  });
}

IndexedPicture PaintWalls(const MapPainter& map, const Color& wall) {
  return PaintLevels(map, wall, WallLevelOf);
}

IndexedPicture PaintOverlaid(const std::vector<MapPainter>& maps) {
  CHECK(!maps.empty());
  IndexedPicture picture = BlankPicture(maps.front());
  picture.palette = {ToRgba(kUnobserved), ToRgba(kConflict)};
  for (int k = 0; k < kNumMapColors; ++k) {
    for (int level = 0; level < kNumLevels; ++level) {
      picture.palette.push_back(
          ToRgba(Mix(kWhite, CategoryColor(k), level / (kNumLevels - 1.))));
    }
  }
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const OverlaidPixel pixel = OverlayAt(maps, x, y);
      const int map = static_cast<int>(pixel.map) % kNumMapColors;
      const int level = WallLevelOf(pixel.excess);
      picture.pixels.push_back(static_cast<uint8_t>(
          !pixel.is_known        ? 0
          : pixel.IsInConflict() ? 1
                                 : 2 + map * kNumLevels + level));
    }
  }
  return picture;
}

double ConflictShare(const std::vector<MapPainter>& maps) {
  CHECK(!maps.empty());
  int num_walls = 0, num_conflicts = 0;
  for (int y = 0; y < maps.front().size().y(); ++y) {
    for (int x = 0; x < maps.front().size().x(); ++x) {
      const OverlaidPixel pixel = OverlayAt(maps, x, y);
      num_walls += pixel.is_wall;
      num_conflicts += pixel.IsInConflict();
    }
  }
  return num_walls > 0 ? static_cast<double>(num_conflicts) / num_walls : 0.;
}

void DrawTrajectory(const std::vector<Eigen::Vector2d>& positions,
                    const PixelFrame& frame, const Color& color,
                    Picture* const picture) {
  std::vector<Eigen::Vector2d> pixels;
  for (const Eigen::Vector2d& position : positions) {
    if (IsDrawable(position)) pixels.push_back(frame.ToPixels(position));
  }
  if (pixels.empty()) return;
  const double scale = StrokeScale(*picture);
  picture->DrawPolyline(pixels, 1.2 * scale, color);
  picture->DrawCircle(pixels.front(), 3. * scale, kWhite, color);
  picture->DrawCircle(pixels.back(), 3. * scale, color, kWhite);
}

void DrawScaleBar(const PixelFrame& frame, Picture* const picture) {
  const double scale = StrokeScale(*picture);
  const double length =
      RoundStep(0.1 * picture->width() / frame.pixels_per_meter);
  const double pixels = length * frame.pixels_per_meter;
  const double thickness = 3. * scale;
  const Eigen::Vector2d left(20. * scale, picture->height() - 10. * scale);
  picture->DrawRectangle(left.array() - scale,
                         {pixels + 2. * scale, thickness + 2. * scale},
                         Color{1., 1., 1., 0.8});
  picture->DrawRectangle(left, {pixels, thickness}, kInk);
  picture->DrawText(left + Eigen::Vector2d(0.5 * pixels, -4. * scale),
                    absl::StrFormat("%g m", length), 10. * scale, kInk,
                    Picture::Anchor::kCentre);
}

}  // namespace cartographer_sdf
