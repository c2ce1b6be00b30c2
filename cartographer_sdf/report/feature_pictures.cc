// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/feature_pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/report/svg_plot.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr Color kShade{0.45, 0.5, 0.58};
constexpr Color kUnknownFace{0.8, 0.8, 0.8};
// The view of the surface: turned, and tilted towards the viewer.
constexpr double kAzimuth = 30. * M_PI / 180.;
constexpr double kElevation = 38. * M_PI / 180.;
// Heights are drawn this much larger than lengths, so that rooms stand out.
constexpr double kHeightScale = 1.6;
// The distance at which the colours saturate [m].
constexpr double kSurfaceColorMeters = 2.;

Color MarkColor(const KeypointMark mark) {
  switch (mark) {
    case KeypointMark::kMaximum:
      return {0.9, 0.1, 0.1};
    case KeypointMark::kSaddle:
      return {0.1, 0.7, 0.2};
    case KeypointMark::kMinimum:
      return {1., 0.9, 0.1};
  }
  LOG(FATAL) << "not a mark: " << static_cast<int>(mark);
}

// From blue on walls to yellow far from them.
Color HeightColor(const double distance) {
  const double f = std::clamp(distance / kSurfaceColorMeters, 0., 1.);
  constexpr Color kLow{0.25, 0.25, 0.62};
  constexpr Color kMiddle{0.25, 0.7, 0.72};
  constexpr Color kHigh{1., 0.93, 0.45};
  return f < 0.5 ? Mix(kLow, kMiddle, 2. * f)
                 : Mix(kMiddle, kHigh, 2. * f - 1.);
}

// The box that holds all but one in a hundred of the observed cells on each
// side, in the grid frame [m]: single beams through doors reach far.
Eigen::AlignedBox2d ObservedBounds(const DistanceField& field) {
  std::vector<double> xs, ys;
  for (int j = 0; j < field.geometry.size.y(); ++j) {
    for (int i = 0; i < field.geometry.size.x(); ++i) {
      if (!field.observed(i, j)) continue;
      const Eigen::Vector2d p_grid =
          field.geometry.CellsToGrid(Eigen::Vector2d(i, j));
      xs.push_back(p_grid.x());
      ys.push_back(p_grid.y());
    }
  }
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

int NumPixels(const double length, const double pixels_per_meter,
              const int max_pixels) {
  return std::clamp(static_cast<int>(std::lround(length * pixels_per_meter)), 1,
                    max_pixels);
}

// The distance in the cell that holds the point, where it was observed.
std::optional<double> ObservedDistance(const DistanceField& field,
                                       const Eigen::Vector2d& p_grid) {
  const Eigen::Array2i cell =
      (p_grid.array() / field.geometry.resolution).floor().cast<int>();
  if (!field.geometry.Contains(cell) || !field.observed(cell.x(), cell.y())) {
    return std::nullopt;
  }
  return static_cast<double>(field.distance(cell.x(), cell.y()));
}

// An axonometric view: where a point of the surface is seen, to the right, and
// up [m].
struct ObliqueView {
  Eigen::Vector2d centre;  // of the plane

  // To the right, and away from the viewer.
  [[nodiscard]] Eigen::Vector2d Turned(const Eigen::Vector2d& p_grid) const {
    return Eigen::Rotation2Dd(-kAzimuth) * (p_grid - centre);
  }
  [[nodiscard]] Eigen::Vector2d ToGrid(const Eigen::Vector2d& turned) const {
    return Eigen::Rotation2Dd(kAzimuth) * turned + centre;
  }
  [[nodiscard]] static double Height(const double depth,
                                     const double distance) {
    return depth * std::sin(kElevation) +
           kHeightScale * distance * std::cos(kElevation);
  }
};

struct SurfaceSheet {
  ObliqueView view;
  Eigen::AlignedBox2d plane;   // what is shown, in the grid frame
  Eigen::AlignedBox2d turned;  // all corners of the plane
  Eigen::AlignedBox2d seen;    // all that is seen [m]
  double pixels_per_meter = 1.;

  [[nodiscard]] Eigen::Vector2d ToPixels(const double right,
                                         const double up) const {
    return pixels_per_meter *
           Eigen::Vector2d(right - seen.min().x(), seen.max().y() - up);
  }
};

SurfaceSheet PlaceSurface(const DistanceField& field, const int max_pixels) {
  const Eigen::AlignedBox2d bounds = ObservedBounds(field);
  SurfaceSheet sheet;
  sheet.plane = bounds;
  sheet.view.centre = bounds.center();
  for (const double x : {bounds.min().x(), bounds.max().x()}) {
    for (const double y : {bounds.min().y(), bounds.max().y()}) {
      sheet.turned.extend(sheet.view.Turned({x, y}));
    }
  }
  for (int j = 0; j < field.geometry.size.y(); ++j) {
    for (int i = 0; i < field.geometry.size.x(); ++i) {
      if (!field.observed(i, j)) continue;
      const Eigen::Vector2d turned =
          sheet.view.Turned(field.geometry.CellsToGrid(Eigen::Vector2d(i, j)));
      sheet.seen.extend(Eigen::Vector2d(
          turned.x(), ObliqueView::Height(turned.y(), field.distance(i, j))));
    }
  }
  if (sheet.seen.isEmpty()) sheet.seen.extend(Eigen::Vector2d(0., 0.));
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(0.3);
  sheet.seen = {sheet.seen.min() - margin, sheet.seen.max() + margin};
  sheet.pixels_per_meter = max_pixels / sheet.seen.sizes().maxCoeff();
  return sheet;
}

// How bright the surface is where it leans: lit from the upper left.
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

// Draws one column of pixels from front to back: what is lower than what was
// drawn before it is hidden behind it.
void DrawSurfaceColumn(const DistanceField& field, const SurfaceSheet& sheet,
                       const int x, Picture* const picture) {
  const double step =
      std::min(0.5 * field.geometry.resolution, 0.5 / sheet.pixels_per_meter);
  const double right =
      sheet.seen.min().x() + (x + 0.5) / sheet.pixels_per_meter;
  int horizon = picture->height();
  bool follows_observed = false;
  for (double depth = sheet.turned.min().y(); depth <= sheet.turned.max().y();
       depth += step) {
    const Eigen::Vector2d p_grid = sheet.view.ToGrid({right, depth});
    const std::optional<double> distance = ObservedDistance(field, p_grid);
    if (!distance || !sheet.plane.contains(p_grid)) {
      follows_observed = false;
      continue;
    }
    const int row = static_cast<int>(std::floor(
        sheet.ToPixels(right, ObliqueView::Height(depth, *distance)).y()));
    // What rises is drawn down to the horizon, but is no cliff where an
    // observed part begins.
    const int lowest = follows_observed ? horizon : std::min(horizon, row + 1);
    follows_observed = true;
    if (row >= horizon) continue;
    const Color color =
        Mix(kBlack, HeightColor(*distance), Brightness(field, p_grid));
    for (int y = std::max(0, row); y < lowest; ++y) {
      picture->BlendPixel(x, y, color);
    }
    horizon = row;
  }
}

void DrawSurfaceKeypoints(const DistanceField& field, const SurfaceSheet& sheet,
                          const std::vector<MarkedKeypoint>& keypoints,
                          Picture* const picture) {
  const Rigid2 T_grid_submap = field.geometry.T_submap_grid.Inverse();
  for (const MarkedKeypoint& keypoint : keypoints) {
    const Eigen::Vector2d p_grid = T_grid_submap * keypoint.position;
    const std::optional<FieldSample> sample = SampleField(field, p_grid);
    if (!sample || !sheet.plane.contains(p_grid)) continue;
    const Eigen::Vector2d turned = sheet.view.Turned(p_grid);
    picture->DrawCircle(
        sheet.ToPixels(turned.x(),
                       ObliqueView::Height(turned.y(), sample->distance)),
        3.5, MarkColor(keypoint.mark), kBlack);
  }
}

// The window of a descriptor, in the grid frame.
struct FeatureWindow {
  Eigen::Vector2d centre;
  double radius;  // [m]
  PixelFrame frame;
};

Eigen::Vector2d AtAngle(const FeatureWindow& window, const double angle) {
  return window.centre +
         window.radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

void DrawWindowField(const DistanceField& field, const PixelFrame& frame,
                     Picture* const picture) {
  constexpr Color kWall{0.55, 0.3, 0.1};
  constexpr Color kFar{0.1, 0.35, 0.7};
  for (int y = 0; y < picture->height(); ++y) {
    for (int x = 0; x < picture->width(); ++x) {
      const std::optional<double> distance =
          ObservedDistance(field, frame.CentreOf(x, y));
      if (!distance) continue;
      const double fraction =
          std::sqrt(std::clamp(*distance / kSurfaceColorMeters, 0., 1.));
      picture->BlendPixel(
          x, y, *distance <= 0. ? kWall : Mix(kWhite, kFar, 0.8 * fraction));
    }
  }
}

// An arrow without a head, but with a dot at its foot.
void DrawGradient(const Eigen::Vector2d& foot, const Eigen::Vector2d& tip,
                  const PixelFrame& frame, Picture* const picture) {
  constexpr Color kDark{0.1, 0.1, 0.1};
  picture->DrawPolyline({frame.ToPixels(foot), frame.ToPixels(tip)}, 1.5,
                        kDark);
  picture->DrawCircle(frame.ToPixels(foot), 1.3, kDark, kDark);
}

// The gradients at every third cell in the window, as long as they weigh.
// `sigma` is that of the weights [m].
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
      DrawGradient(p_grid,
                   p_grid + kStride * geometry.resolution * weight * gradient,
                   window.frame, picture);
    }
  }
}

void DrawRim(const FeatureWindow& window, Picture* const picture) {
  std::vector<Eigen::Vector2d> circle;
  for (int k = 0; k <= 72; ++k) {
    circle.push_back(window.frame.ToPixels(AtAngle(window, k * M_PI / 36.)));
  }
  picture->DrawPolyline(circle, 2., kBlack);
}

void DrawDirection(const FeatureWindow& window, const double orientation,
                   Picture* const picture) {
  picture->DrawPolyline({window.frame.ToPixels(window.centre),
                         window.frame.ToPixels(AtAngle(window, orientation))},
                        3., Color{0.85, 0.1, 0.1});
}

KeypointMark MarkOf(const KeypointKind kind) {
  return kind == KeypointKind::kMaximum  ? KeypointMark::kMaximum
         : kind == KeypointKind::kSaddle ? KeypointMark::kSaddle
                                         : KeypointMark::kMinimum;
}

}  // namespace

std::vector<MarkedKeypoint> MarkKeypoints(const FeatureSet& features) {
  std::vector<MarkedKeypoint> marked;
  for (const Feature& feature : features.features) {
    marked.push_back(
        {feature.keypoint.position, MarkOf(feature.keypoint.kind)});
  }
  return marked;
}

Picture DrawClearanceMask(const DistanceField& field,
                          const double max_clearance, const int max_pixels) {
  CHECK_GE(max_pixels, 1);
  const Eigen::AlignedBox2d bounds = ObservedBounds(field);
  const PixelFrame frame{max_pixels / bounds.sizes().maxCoeff(),
                         {bounds.min().x(), bounds.max().y()}};
  Picture picture(
      NumPixels(bounds.sizes().x(), frame.pixels_per_meter, max_pixels),
      NumPixels(bounds.sizes().y(), frame.pixels_per_meter, max_pixels),
      kUnknownFace);
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const std::optional<double> distance =
          ObservedDistance(field, frame.CentreOf(x, y));
      if (!distance) continue;
      picture.BlendPixel(x, y,
                         *distance <= 0.              ? kBlack
                         : *distance <= max_clearance ? kWhite
                                                      : kShade);
    }
  }
  return picture;
}

Picture DrawFieldSurface(const DistanceField& field,
                         const std::vector<MarkedKeypoint>& keypoints,
                         const int max_pixels) {
  CHECK_GE(max_pixels, 1);
  const SurfaceSheet sheet = PlaceSurface(field, max_pixels);
  Picture picture(
      NumPixels(sheet.seen.sizes().x(), sheet.pixels_per_meter, max_pixels),
      NumPixels(sheet.seen.sizes().y(), sheet.pixels_per_meter, max_pixels),
      kWhite);
  for (int x = 0; x < picture.width(); ++x) {
    DrawSurfaceColumn(field, sheet, x, &picture);
  }
  DrawSurfaceKeypoints(field, sheet, keypoints, &picture);
  return picture;
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
  DrawWindowField(field, window.frame, &picture);
  DrawWeighedGradients(field.geometry, smoothed, window,
                       options.gaussian_sigma_ratio * options.radius_meters,
                       &picture);
  DrawRim(window, &picture);
  DrawDirection(window, feature.orientation + T_grid_submap.rotation(),
                &picture);
  picture.DrawCircle(window.frame.ToPixels(centre), 4.,
                     MarkColor(MarkOf(feature.keypoint.kind)), kBlack);
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

}  // namespace cartographer_sdf
