// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/submap_pictures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr Color kUnknown{0.78, 0.78, 0.78};
constexpr Color kHatch{0.66, 0.66, 0.66};
constexpr Color kReferenceWall{0.05, 0.15, 0.45};
constexpr Color kQueryWall{0.85, 0.1, 0.1};
constexpr Color kContradiction{1., 0.6, 0.};
constexpr Color kCorrespondence{0., 0.6, 0.3, 0.7};
// Between them, a cell says too little to be drawn as either.
constexpr float kMinWallProbability = 0.55f;
constexpr float kMaxFreeProbability = 0.48f;
constexpr double kContourIntervalMeters = 0.5;
// The distance at which the colours saturate.
constexpr double kFullColorMeters = 3.;
// A wall this near explains a wall that is seen a little elsewhere.
constexpr double kContradictionRadiusMeters = 0.3;
// Corridors of maps reach hundreds of metres; more is no pair of submaps.
constexpr double kMaxExtentMeters = 2000.;
constexpr double kMaxTranslationMeters = 1e6;

bool IsWall(const OccupancyGrid& grid, const int i, const int j) {
  return grid.known(i, j) && grid.probability(i, j) >= kMinWallProbability;
}

bool IsFree(const OccupancyGrid& grid, const int i, const int j) {
  return grid.known(i, j) && grid.probability(i, j) <= kMaxFreeProbability;
}

bool IsFreeAt(const OccupancyGrid& grid, const Eigen::Vector2d& p_grid) {
  const Eigen::Array2i cell =
      (p_grid.array() / grid.geometry.resolution).floor().cast<int>();
  return grid.geometry.Contains(cell) && IsFree(grid, cell.x(), cell.y());
}

// In the submap frame.
std::vector<Eigen::Vector2d> WallCentres(const OccupancyGrid& grid) {
  std::vector<Eigen::Vector2d> centres;
  for (int j = 0; j < grid.geometry.size.y(); ++j) {
    for (int i = 0; i < grid.geometry.size.x(); ++i) {
      if (IsWall(grid, i, j)) {
        centres.push_back(grid.geometry.CellCentre({i, j}));
      }
    }
  }
  return centres;
}

struct Sheet {
  Picture picture;
  PixelFrame frame;
};

// A sheet for `bounds` [m]. Pixels may be fractions of a cell.
Sheet MakeSheet(const Eigen::AlignedBox2d& bounds, const int max_pixels) {
  CHECK_GE(max_pixels, 1);
  CHECK(!bounds.isEmpty());
  const Eigen::Vector2d extent =
      bounds.sizes().cwiseMax(1e-3).cwiseMin(kMaxExtentMeters);
  const double pixels_per_meter = max_pixels / extent.maxCoeff();
  const auto num_pixels = [&](const double length) {
    return std::clamp(static_cast<int>(std::lround(length * pixels_per_meter)),
                      1, max_pixels);
  };
  return Sheet{
      Picture(num_pixels(extent.x()), num_pixels(extent.y()), kUnknown),
      PixelFrame{pixels_per_meter, {bounds.min().x(), bounds.max().y()}}};
}

Eigen::AlignedBox2d BoundsOf(const CellGeometry& geometry) {
  return Eigen::AlignedBox2d(
      Eigen::Vector2d::Zero(),
      geometry.resolution * geometry.size.cast<double>().matrix());
}

// Of the known cells, or of the corner of a grid without any.
Eigen::AlignedBox2d KnownBounds(const OccupancyGrid& grid,
                                const Rigid2& T_frame_submap) {
  const Rigid2 T_frame_grid = T_frame_submap * grid.geometry.T_submap_grid;
  Eigen::AlignedBox2d bounds;
  for (int j = 0; j < grid.geometry.size.y(); ++j) {
    for (int i = 0; i < grid.geometry.size.x(); ++i) {
      if (!grid.known(i, j)) continue;
      bounds.extend(T_frame_submap * grid.geometry.CellCentre({i, j}));
    }
  }
  if (bounds.isEmpty()) bounds.extend(T_frame_grid.translation());
  return bounds;
}

void Hatch(Picture* const picture, const int x, const int y) {
  picture->BlendPixel(x, y, (x + y) % 8 == 0 ? kHatch : kUnknown);
}

// Bilinear between the observed cells around; none in an unobserved one.
std::optional<double> DistanceAt(const CellGeometry& geometry,
                                 const Eigen::ArrayXXf& distance,
                                 const BoolArray& observed,
                                 const Eigen::Vector2d& p_grid) {
  const Eigen::Array2d cells = geometry.GridToCells(p_grid).array();
  const Eigen::Array2i nearest = (cells + 0.5).floor().cast<int>();
  if (!geometry.Contains(nearest) || !observed(nearest.x(), nearest.y())) {
    return std::nullopt;
  }
  const Eigen::Array2i lower = cells.floor().cast<int>();
  double sum = 0.;
  double sum_weights = 0.;
  for (const Eigen::Array2i& offset :
       {Eigen::Array2i(0, 0), Eigen::Array2i(1, 0), Eigen::Array2i(0, 1),
        Eigen::Array2i(1, 1)}) {
    const Eigen::Array2i cell = lower + offset;
    if (!geometry.Contains(cell) || !observed(cell.x(), cell.y())) continue;
    const double weight = (1. - (cells - cell.cast<double>()).abs()).prod();
    sum += weight * distance(cell.x(), cell.y());
    sum_weights += weight;
  }
  return sum / sum_weights;
}

Color DistanceColor(const double distance) {
  constexpr Color kFar{0.1, 0.35, 0.7};
  constexpr Color kInside{0.55, 0.3, 0.1};
  const double fraction =
      std::sqrt(std::min(1., std::abs(distance) / kFullColorMeters));
  return Mix(kWhite, distance < 0. ? kInside : kFar, fraction);
}

// How strongly a contour between two neighbouring pixels is drawn; 0 where
// there is none.
double ContourStrength(const double here, const double next) {
  const double level = std::floor(here / kContourIntervalMeters);
  const double other = std::floor(next / kContourIntervalMeters);
  if (other == level) return 0.;
  const bool is_wall = std::max(level, other) == 0.;
  return is_wall ? 1. : 0.35;
}

void DrawKeypoints(const std::vector<MarkedKeypoint>& keypoints,
                   const Rigid2& T_sheet_submap, Sheet* const sheet) {
  for (const MarkedKeypoint& keypoint : keypoints) {
    const Color fill =
        keypoint.mark == KeypointMark::kMaximum  ? Color{0.9, 0.1, 0.1}
        : keypoint.mark == KeypointMark::kSaddle ? Color{0.1, 0.7, 0.2}
                                                 : Color{1., 0.9, 0.1};
    sheet->picture.DrawCircle(
        sheet->frame.ToPixels(T_sheet_submap * keypoint.position), 3.5, fill,
        kBlack);
  }
}

// Where either submap is free space. The sheet is in the reference's grid.
void DrawFreeSpace(const OccupancyGrid& reference, const OccupancyGrid& query,
                   const Rigid2& T_query_sheet, Sheet* const sheet) {
  constexpr Color kReferenceOnly{0.82, 0.88, 0.97};
  constexpr Color kQueryOnly{0.98, 0.87, 0.85};
  for (int y = 0; y < sheet->picture.height(); ++y) {
    for (int x = 0; x < sheet->picture.width(); ++x) {
      const Eigen::Vector2d p_sheet = sheet->frame.CentreOf(x, y);
      const bool in_reference = IsFreeAt(reference, p_sheet);
      const bool in_query = IsFreeAt(query, T_query_sheet * p_sheet);
      if (!in_reference && !in_query) continue;
      sheet->picture.BlendPixel(x, y,
                                !in_query       ? kReferenceOnly
                                : !in_reference ? kQueryOnly
                                                : kWhite);
    }
  }
}

// Squares of `size` [m]. Cell by cell, not pixel by pixel, so that none is
// lost.
void DrawCells(const std::vector<Eigen::Vector2d>& centres,
               const Rigid2& T_sheet_submap, const double size,
               const Color& color, Sheet* const sheet) {
  // Whole pixels: blended edges would look like doubt.
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
        sheet->frame.ToPixels(T_sheet_reference * pair.p_reference);
    const Eigen::Vector2d b =
        sheet->frame.ToPixels(T_sheet_query * pair.p_query);
    sheet->picture.DrawPolyline({a, b}, 1., kCorrespondence);
    sheet->picture.DrawCircle(a, 2., kCorrespondence, kCorrespondence);
  }
}

}  // namespace

Picture DrawDistanceField(const CellGeometry& geometry,
                          const Eigen::ArrayXXf& distance,
                          const BoolArray& observed,
                          const std::vector<MarkedKeypoint>& keypoints,
                          const int max_pixels) {
  CHECK((geometry.size == Eigen::Array2i(distance.rows(), distance.cols()))
            .all());
  CHECK((geometry.size == Eigen::Array2i(observed.rows(), observed.cols()))
            .all());
  Sheet sheet = MakeSheet(BoundsOf(geometry), max_pixels);
  Picture& picture = sheet.picture;
  const auto distance_at = [&](const int x, const int y) {
    return DistanceAt(geometry, distance, observed, sheet.frame.CentreOf(x, y));
  };
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const std::optional<double> here = distance_at(x, y);
      if (!here.has_value()) {
        Hatch(&picture, x, y);
        continue;
      }
      const std::optional<double> right = distance_at(x + 1, y);
      const std::optional<double> below = distance_at(x, y + 1);
      double strength = right ? ContourStrength(*here, *right) : 0.;
      if (strength == 0. && below) strength = ContourStrength(*here, *below);
      picture.BlendPixel(x, y, Mix(DistanceColor(*here), kBlack, strength));
    }
  }
  DrawKeypoints(keypoints, geometry.T_submap_grid.Inverse(), &sheet);
  return std::move(sheet.picture);
}

std::vector<Eigen::Vector2d> ContradictedWalls(const OccupancyGrid& walls,
                                               const OccupancyGrid& space,
                                               const Rigid2& T_space_walls) {
  const int radius = static_cast<int>(
      std::ceil(kContradictionRadiusMeters / space.geometry.resolution));
  std::vector<Eigen::Vector2d> contradicted;
  for (const Eigen::Vector2d& p_walls : WallCentres(walls)) {
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
                          max_pixels);
  DrawFreeSpace(reference, query, T_query_sheet, &sheet);
  const double resolution = reference.geometry.resolution;
  DrawCells(WallCentres(reference), T_sheet_reference, resolution,
            kReferenceWall, &sheet);
  DrawCells(WallCentres(query), T_sheet_query, query.geometry.resolution,
            kQueryWall, &sheet);
  DrawCells(ContradictedWalls(query, reference, T_reference_query),
            T_sheet_reference, 2. * resolution, kContradiction, &sheet);
  DrawCells(ContradictedWalls(reference, query, T_reference_query.Inverse()),
            T_sheet_query, 2. * resolution, kContradiction, &sheet);
  DrawCorrespondences(correspondences, T_sheet_reference, T_sheet_query,
                      &sheet);
  return std::move(sheet.picture);
}

Picture DrawOccupancyGrid(const OccupancyGrid& grid, const int max_pixels) {
  Sheet sheet = MakeSheet(BoundsOf(grid.geometry), max_pixels);
  for (int y = 0; y < sheet.picture.height(); ++y) {
    for (int x = 0; x < sheet.picture.width(); ++x) {
      const Eigen::Array2i cell =
          (sheet.frame.CentreOf(x, y).array() / grid.geometry.resolution)
              .floor()
              .cast<int>();
      if (!grid.geometry.Contains(cell) || !grid.known(cell.x(), cell.y())) {
        Hatch(&sheet.picture, x, y);
        continue;
      }
      const double grey = std::clamp(
          1. - static_cast<double>(grid.probability(cell.x(), cell.y())), 0.,
          1.);
      sheet.picture.BlendPixel(x, y, Color{grey, grey, grey});
    }
  }
  return std::move(sheet.picture);
}

}  // namespace cartographer_sdf
