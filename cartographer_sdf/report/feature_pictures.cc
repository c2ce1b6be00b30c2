// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/feature_pictures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "cartographer_sdf/report/svg_plot.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr Color kUnknownCell{0.78, 0.78, 0.78};
constexpr Color kHatch{0.66, 0.66, 0.66};
constexpr Color kShade{0.45, 0.5, 0.58};
constexpr Color kUnknownFace{0.8, 0.8, 0.8};
constexpr Color kFar{0.1, 0.35, 0.7};
constexpr Color kInside{0.55, 0.3, 0.1};
constexpr Color kDark{0.1, 0.1, 0.1};
constexpr Color kReference{0.05, 0.25, 0.75};
constexpr Color kQuery{0.8, 0.08, 0.08};
constexpr double kContourIntervalMeters = 0.5;
// The view of the surface: rotated, and tilted towards the viewer.
constexpr double kAzimuth = 30. * M_PI / 180.;
constexpr double kElevation = 38. * M_PI / 180.;
// Heights are exaggerated by this factor, so that rooms stand out.
constexpr double kHeightScale = 1.6;
// The distance at which the colours saturate [m].
constexpr double kFullColorMeters = 3.;
constexpr double kSurfaceColorMeters = 2.;

Color KeypointColor(const KeypointKind kind) {
  return kind == KeypointKind::kMaximum  ? Color{0.9, 0.1, 0.1}
         : kind == KeypointKind::kSaddle ? Color{0.1, 0.7, 0.2}
                                         : Color{1., 0.9, 0.1};
}

// From 0 at a wall to 1 at `full` metres.
double Fraction(const double distance, const double full) {
  return std::clamp(distance / full, 0., 1.);
}

// From blue on walls to yellow far from them.
Color HeightColor(const double distance) {
  const double f = Fraction(distance, kSurfaceColorMeters);
  constexpr Color kLow{0.25, 0.25, 0.62};
  constexpr Color kMiddle{0.25, 0.7, 0.72};
  constexpr Color kHigh{1., 0.93, 0.45};
  return f < 0.5 ? Mix(kLow, kMiddle, 2. * f)
                 : Mix(kMiddle, kHigh, 2. * f - 1.);
}

Color HatchColor(const int x, const int y) {
  return (x + y) % 8 == 0 ? kHatch : kUnknownCell;
}

Eigen::AlignedBox2d BoundsOf(const CellGeometry& geometry) {
  return Eigen::AlignedBox2d(
      Eigen::Vector2d::Zero(),
      geometry.resolution * geometry.size.cast<double>().matrix());
}

Eigen::Array2i CellOf(const CellGeometry& geometry,
                      const Eigen::Vector2d& p_grid) {
  return (p_grid.array() / geometry.resolution).floor().cast<int>();
}

// The distance in the cell that holds the point, where it was observed.
std::optional<double> ObservedDistance(const DistanceField& field,
                                       const Eigen::Vector2d& p_grid) {
  const Eigen::Array2i cell = CellOf(field.geometry, p_grid);
  if (!field.geometry.Contains(cell) || !field.observed(cell.x(), cell.y())) {
    return std::nullopt;
  }
  return static_cast<double>(field.distance(cell.x(), cell.y()));
}

// As ObservedDistance, but interpolated bilinearly between cell centres.
std::optional<double> SmoothDistance(const DistanceField& field,
                                     const Eigen::Vector2d& p_grid) {
  const std::optional<double> distance = ObservedDistance(field, p_grid);
  if (!distance) return std::nullopt;
  const std::optional<FieldSample> sample = SampleField(field, p_grid);
  return sample ? sample->distance : *distance;
}

// Strength of the contour between two neighbouring pixels; 0 if there is none.
double ContourStrength(const double here, const double next) {
  const double level = std::floor(here / kContourIntervalMeters);
  const double other = std::floor(next / kContourIntervalMeters);
  if (other == level) return 0.;
  const bool is_wall = std::max(level, other) == 0.;
  return is_wall ? 1. : 0.35;
}

// Calls back with the centre of each observed cell in the grid frame and with
// its distance.
void ForEachObserved(
    const DistanceField& field,
    const std::function<void(const Eigen::Vector2d&, double)>& on_cell) {
  for (int j = 0; j < field.geometry.size.y(); ++j) {
    for (int i = 0; i < field.geometry.size.x(); ++i) {
      if (!field.observed(i, j)) continue;
      on_cell(field.geometry.CellsToGrid(Eigen::Vector2d(i, j)),
              field.distance(i, j));
    }
  }
}

// The box without the outermost hundredth of the observed cells on each side,
// in the grid frame [m]: single beams through doors reach far.
Eigen::AlignedBox2d ObservedBounds(const DistanceField& field) {
  std::vector<double> xs, ys;
  ForEachObserved(field, [&](const Eigen::Vector2d& p_grid, double) {
    xs.push_back(p_grid.x());
    ys.push_back(p_grid.y());
  });
  if (xs.empty()) return {Eigen::Vector2d(0., 0.), Eigen::Vector2d(1., 1.)};
  std::sort(xs.begin(), xs.end());
  std::sort(ys.begin(), ys.end());
  const size_t rim = xs.size() / 100;
  const Eigen::Vector2d margin =
      Eigen::Vector2d::Constant(10. * field.geometry.resolution);
  const Eigen::Vector2d low(xs[rim], ys[rim]);
  const Eigen::Vector2d high(xs[xs.size() - 1 - rim], ys[ys.size() - 1 - rim]);
  return {low - margin, high + margin};
}

// An axonometric view of the surface over `plane`, in the grid frame.
struct ObliqueView {
  Eigen::AlignedBox2d plane;

  // To the right, and away from the viewer.
  [[nodiscard]] Eigen::Vector2d Turned(const Eigen::Vector2d& p_grid) const {
    return Eigen::Rotation2Dd(-kAzimuth) * (p_grid - plane.center());
  }
  [[nodiscard]] Eigen::Vector2d ToGrid(const Eigen::Vector2d& turned) const {
    return Eigen::Rotation2Dd(kAzimuth) * turned + plane.center();
  }
  // Projected position of a surface point, to the right and up [m].
  [[nodiscard]] static Eigen::Vector2d Seen(const Eigen::Vector2d& turned,
                                            const double distance) {
    return {turned.x(), turned.y() * std::sin(kElevation) +
                            kHeightScale * distance * std::cos(kElevation)};
  }
};

// Shading of the surface, lit from the upper left.
double Brightness(const DistanceField& field, const Eigen::Vector2d& p_grid) {
  const std::optional<FieldSample> sample = SampleField(field, p_grid);
  if (!sample) return 1.;
  const Eigen::Vector3d normal =
      Eigen::Vector3d(-kHeightScale * sample->gradient.x(),
                      -kHeightScale * sample->gradient.y(), 1.)
          .normalized();
  const Eigen::Vector3d light = Eigen::Vector3d(-0.5, 0.35, 0.8).normalized();
  return 0.6 + 0.4 * std::max(0., normal.dot(light));
}

// Draws one column of pixels from front to back: points below the horizon drawn
// so far are hidden. `depths` are those of the plane.
void DrawSurfaceColumn(const DistanceField& field, const ObliqueView& view,
                       const std::pair<double, double>& depths, const int x,
                       Sheet* const sheet) {
  const double step = std::min(0.5 * field.geometry.resolution,
                               0.5 / sheet->frame.pixels_per_meter);
  const double right = sheet->frame.CentreOf(x, 0).x();
  const auto num_steps =
      static_cast<int64_t>(std::floor((depths.second - depths.first) / step));
  int horizon = sheet->picture.height();
  bool follows_observed = false;
  for (int64_t k = 0; k <= num_steps; ++k) {
    const double depth = depths.first + static_cast<double>(k) * step;
    const Eigen::Vector2d p_grid = view.ToGrid({right, depth});
    const std::optional<double> distance = ObservedDistance(field, p_grid);
    if (!distance || !view.plane.contains(p_grid)) {
      follows_observed = false;
      continue;
    }
    const int row = static_cast<int>(std::floor(
        sheet->frame.ToPixels(ObliqueView::Seen({right, depth}, *distance))
            .y()));
    // A rising surface is drawn down to the horizon, but without a cliff where
    // an observed part begins.
    const int lowest = follows_observed ? horizon : std::min(horizon, row + 1);
    follows_observed = true;
    if (row >= horizon) continue;
    const Color color =
        Mix(kBlack, HeightColor(*distance), Brightness(field, p_grid));
    for (int y = std::max(0, row); y < lowest; ++y) {
      sheet->picture.BlendPixel(x, y, color);
    }
    horizon = row;
  }
}

// The window of a descriptor, in the grid frame.
struct FeatureWindow {
  Eigen::Vector2d centre;
  double radius;  // [m]
  PixelFrame frame;

  [[nodiscard]] Eigen::Vector2d PixelAtAngle(const double angle) const {
    return frame.ToPixels(
        centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
};

// Draws the gradients at every third cell in the window, with their weight as
// length and a dot at the foot. `sigma` is that of the weights [m].
void DrawWeighedGradients(const CellGeometry& geometry,
                          const Eigen::ArrayXXf& smoothed,
                          const FeatureWindow& window, const double sigma,
                          Picture* const picture) {
  constexpr int kStride = 3;
  const Eigen::Array2i middle =
      geometry.GridToCells(window.centre).array().round().cast<int>();
  const int cells = static_cast<int>(window.radius / geometry.resolution);
  for (int dj = -cells; dj <= cells; ++dj) {
    for (int di = -cells; di <= cells; ++di) {
      const int i = middle.x() + di;
      const int j = middle.y() + dj;
      if (di % kStride != 0 || dj % kStride != 0 || i < 1 || j < 1 ||
          i + 1 >= smoothed.rows() || j + 1 >= smoothed.cols()) {
        continue;
      }
      const Eigen::Vector2d p_grid =
          geometry.CellsToGrid(Eigen::Vector2d(i, j));
      const double squared = (p_grid - window.centre).squaredNorm();
      if (squared > window.radius * window.radius) continue;
      const Eigen::Vector2d gradient(
          0.5f * (smoothed(i + 1, j) - smoothed(i - 1, j)),
          0.5f * (smoothed(i, j + 1) - smoothed(i, j - 1)));
      const double weight = std::exp(-0.5 * squared / (sigma * sigma));
      const Eigen::Vector2d foot = window.frame.ToPixels(p_grid);
      picture->DrawPolyline(
          {foot, window.frame.ToPixels(p_grid + kStride * geometry.resolution *
                                                    weight * gradient)},
          1.5, kDark);
      picture->DrawCircle(foot, 1.3, kDark, kDark);
    }
  }
}

void TintSubmap(const ShownSubmap& submap, const PixelFrame& frame,
                const Color& color, Picture* const picture) {
  const Rigid2 T_grid_map =
      (submap.T_map_submap * submap.field.geometry.T_submap_grid).Inverse();
  picture->BlendPixels([&](const int x, const int y) -> std::optional<Color> {
    const std::optional<double> distance =
        ObservedDistance(submap.field, T_grid_map * frame.CentreOf(x, y));
    if (!distance) return std::nullopt;
    Color tint = color;
    if (*distance > 0.) {
      tint.alpha =
          0.12 + 0.4 * std::sqrt(Fraction(*distance, kFullColorMeters));
    }
    return tint;
  });
}

}  // namespace

Picture DrawOccupancyGrid(const OccupancyGrid& grid, const int max_pixels) {
  Sheet sheet = MakeSheet(BoundsOf(grid.geometry), max_pixels, kUnknownCell);
  sheet.picture.BlendPixels([&](const int x, const int y) {
    const Eigen::Array2i cell =
        CellOf(grid.geometry, sheet.frame.CentreOf(x, y));
    if (!grid.geometry.Contains(cell) || !grid.known(cell.x(), cell.y())) {
      return HatchColor(x, y);
    }
    const double grey = std::clamp(
        1. - static_cast<double>(grid.probability(cell.x(), cell.y())), 0., 1.);
    return Color{grey, grey, grey};
  });
  return std::move(sheet.picture);
}

Picture DrawDistanceField(const DistanceField& field,
                          const std::vector<Feature>& features,
                          const int max_pixels) {
  Sheet sheet = MakeSheet(BoundsOf(field.geometry), max_pixels, kUnknownCell);
  const auto distance_at = [&](const int x, const int y) {
    return SmoothDistance(field, sheet.frame.CentreOf(x, y));
  };
  sheet.picture.BlendPixels([&](const int x, const int y) {
    const std::optional<double> here = distance_at(x, y);
    if (!here) return HatchColor(x, y);
    const std::optional<double> right = distance_at(x + 1, y);
    const std::optional<double> below = distance_at(x, y + 1);
    double strength = right ? ContourStrength(*here, *right) : 0.;
    if (strength == 0. && below) strength = ContourStrength(*here, *below);
    const Color color =
        Mix(kWhite, *here < 0. ? kInside : kFar,
            std::sqrt(Fraction(std::abs(*here), kFullColorMeters)));
    return Mix(color, kBlack, strength);
  });
  const Rigid2 T_grid_submap = field.geometry.T_submap_grid.Inverse();
  for (const Feature& feature : features) {
    sheet.picture.DrawCircle(
        sheet.frame.ToPixels(T_grid_submap * feature.keypoint.position), 3.5,
        KeypointColor(feature.keypoint.kind), kBlack);
  }
  return std::move(sheet.picture);
}

Picture DrawClearanceMask(const DistanceField& field,
                          const double max_clearance, const int max_pixels) {
  Sheet sheet = MakeSheet(ObservedBounds(field), max_pixels, kUnknownFace);
  sheet.picture.BlendPixels(
      [&](const int x, const int y) -> std::optional<Color> {
        const std::optional<double> distance =
            ObservedDistance(field, sheet.frame.CentreOf(x, y));
        if (!distance) return std::nullopt;
        return *distance <= 0.              ? kBlack
               : *distance <= max_clearance ? kWhite
                                            : kShade;
      });
  return std::move(sheet.picture);
}

Picture DrawFieldSurface(const DistanceField& field,
                         const std::vector<Feature>& features,
                         const int max_pixels) {
  const ObliqueView view{ObservedBounds(field)};
  Eigen::AlignedBox2d corners;
  for (const double x : {view.plane.min().x(), view.plane.max().x()}) {
    for (const double y : {view.plane.min().y(), view.plane.max().y()}) {
      corners.extend(view.Turned({x, y}));
    }
  }
  Eigen::AlignedBox2d seen;
  ForEachObserved(
      field, [&](const Eigen::Vector2d& p_grid, const double distance) {
        seen.extend(ObliqueView::Seen(view.Turned(p_grid), distance));
      });
  if (seen.isEmpty()) seen.extend(Eigen::Vector2d(0., 0.));
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(0.3);
  Sheet sheet =
      MakeSheet({seen.min() - margin, seen.max() + margin}, max_pixels, kWhite);
  for (int x = 0; x < sheet.picture.width(); ++x) {
    DrawSurfaceColumn(field, view, {corners.min().y(), corners.max().y()}, x,
                      &sheet);
  }
  const Rigid2 T_grid_submap = field.geometry.T_submap_grid.Inverse();
  for (const Feature& feature : features) {
    const Eigen::Vector2d p_grid = T_grid_submap * feature.keypoint.position;
    const std::optional<FieldSample> sample = SampleField(field, p_grid);
    if (!sample || !view.plane.contains(p_grid)) continue;
    sheet.picture.DrawCircle(sheet.frame.ToPixels(ObliqueView::Seen(
                                 view.Turned(p_grid), sample->distance)),
                             3.5, KeypointColor(feature.keypoint.kind), kBlack);
  }
  return std::move(sheet.picture);
}

Picture DrawFeatureWindow(const DescriptorOptions& options,
                          const DistanceField& field,
                          const Eigen::ArrayXXf& smoothed,
                          const Feature& feature, const int max_pixels) {
  CHECK_GE(max_pixels, 1);
  CHECK_EQ(smoothed.rows(), field.distance.rows());
  CHECK_EQ(smoothed.cols(), field.distance.cols());
  const Rigid2 T_grid_submap = field.geometry.T_submap_grid.Inverse();
  const Eigen::Vector2d centre = T_grid_submap * feature.keypoint.position;
  const double reach = 1.15 * options.radius_meters;
  const FeatureWindow window{
      centre,
      options.radius_meters,
      {max_pixels / (2. * reach), centre + reach * Eigen::Vector2d(-1., 1.)}};
  Picture picture(max_pixels, max_pixels, kUnknownFace);
  picture.BlendPixels([&](const int x, const int y) -> std::optional<Color> {
    const std::optional<double> distance =
        ObservedDistance(field, window.frame.CentreOf(x, y));
    if (!distance) return std::nullopt;
    const double fraction = std::sqrt(Fraction(*distance, kSurfaceColorMeters));
    return *distance <= 0. ? kInside : Mix(kWhite, kFar, 0.8 * fraction);
  });
  DrawWeighedGradients(field.geometry, smoothed, window,
                       options.gaussian_sigma_ratio * options.radius_meters,
                       &picture);
  std::vector<Eigen::Vector2d> rim;
  for (int k = 0; k <= 72; ++k) {
    rim.push_back(window.PixelAtAngle(k * M_PI / 36.));
  }
  picture.DrawPolyline(rim, 2., kBlack);
  picture.DrawPolyline(
      {window.frame.ToPixels(centre),
       window.PixelAtAngle(feature.orientation + T_grid_submap.rotation())},
      3., Color{0.85, 0.1, 0.1});
  picture.DrawCircle(window.frame.ToPixels(centre), 4.,
                     KeypointColor(feature.keypoint.kind), kBlack);
  return picture;
}

std::string RenderDescriptor(const Eigen::VectorXf& descriptor) {
  CHECK_GE(descriptor.size(), 2);
  // Bars, as lines that begin and end on the axis.
  const auto bar = [](const int k, const float value,
                      std::vector<Eigen::Vector2d>* const points) {
    for (const auto& [x, y] : {std::pair<double, double>{k - 0.4, 0.},
                               {k - 0.4, value},
                               {k + 0.4, value},
                               {k + 0.4, 0.}}) {
      points->emplace_back(x, y);
    }
  };
  const int num_bins = static_cast<int>(descriptor.size()) - 1;
  LinePlot plot;
  plot.title = "Descriptor";
  plot.x = {"bin (the last is the mean distance)",
            std::make_pair(-1., num_bins + 1.)};
  plot.y.label = "weight";
  LineSeries histogram{"orientations", {}};
  for (int k = 0; k < num_bins; ++k) bar(k, descriptor[k], &histogram.points);
  LineSeries distance{"mean distance", {}};
  bar(num_bins, descriptor[num_bins], &distance.points);
  plot.series = {histogram, distance};
  return RenderLinePlot(plot);
}

Picture DrawMatchOnMap(const MapPainter& map, const ShownSubmap& reference,
                       const ShownSubmap& query,
                       const std::vector<PointPair>& inliers) {
  constexpr Color kPale{1., 1., 1., 0.55};
  constexpr Color kLine{0., 0., 0., 0.7};
  Picture picture = map.Paint();
  const PixelFrame& frame = map.frame();
  picture.BlendPixels([&](int, int) { return kPale; });
  TintSubmap(reference, frame, kReference, &picture);
  TintSubmap(query, frame, kQuery, &picture);
  for (const auto& [trajectory, path] : reference.paths) {
    DrawTrajectory(path, frame, kReference, &picture);
  }
  for (const auto& [trajectory, path] : query.paths) {
    DrawTrajectory(path, frame, kQuery, &picture);
  }
  for (const auto& [p_reference, p_query] : inliers) {
    const Eigen::Vector2d a =
        frame.ToPixels(reference.T_map_submap * p_reference);
    const Eigen::Vector2d b = frame.ToPixels(query.T_map_submap * p_query);
    picture.DrawPolyline({a, b}, 1., kLine);
    picture.DrawCircle(a, 1.5, kBlack, kBlack);
    picture.DrawCircle(b, 1.5, kBlack, kBlack);
  }
  DrawScaleBar(frame, &picture);
  return picture;
}

}  // namespace cartographer_sdf
