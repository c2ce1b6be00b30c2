// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/match_map.h"

#include <algorithm>
#include <cmath>

namespace cartographer_sdf {
namespace {

constexpr Color kReference{0.05, 0.25, 0.75};
constexpr Color kQuery{0.8, 0.08, 0.08};
constexpr double kMatchColorMeters = 3.;
constexpr double kPaleness = 0.55;

Color WithAlpha(Color color, const double alpha) {
  color.alpha = alpha;
  return color;
}

void TintSubmap(const ShownSubmap& submap, const PixelFrame& frame,
                const Color& color, Picture* const picture) {
  const CellGeometry& geometry = submap.field.geometry;
  const Rigid2 T_grid_map =
      (submap.T_map_submap * geometry.T_submap_grid).Inverse();
  for (int y = 0; y < picture->height(); ++y) {
    for (int x = 0; x < picture->width(); ++x) {
      const Eigen::Array2i cell =
          ((T_grid_map * frame.CentreOf(x, y)).array() / geometry.resolution)
              .floor()
              .cast<int>();
      if (!geometry.Contains(cell) ||
          !submap.field.observed(cell.x(), cell.y())) {
        continue;
      }
      const double distance = submap.field.distance(cell.x(), cell.y());
      if (distance <= 0.) {
        picture->BlendPixel(x, y, color);
        continue;
      }
      const double depth =
          std::sqrt(std::min(1., distance / kMatchColorMeters));
      picture->BlendPixel(x, y, WithAlpha(color, 0.12 + 0.4 * depth));
    }
  }
}

}  // namespace

Picture DrawMatchOnMap(const MapPainter& map,
                       const std::vector<ShownPath>& paths,
                       const ShownMatch& match) {
  Picture picture = map.Paint();
  const PixelFrame& frame = map.frame();
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      picture.BlendPixel(x, y, Color{1., 1., 1., kPaleness});
    }
  }
  TintSubmap(match.reference, frame, kReference, &picture);
  TintSubmap(match.query, frame, kQuery, &picture);
  for (const ShownPath& path : paths) {
    DrawTrajectory(path.positions, frame, path.is_query ? kQuery : kReference,
                   &picture);
  }
  for (const PointPair& pair : match.inliers) {
    const Eigen::Vector2d a =
        frame.ToPixels(match.reference.T_map_submap * pair.p_reference);
    const Eigen::Vector2d b =
        frame.ToPixels(match.query.T_map_submap * pair.p_query);
    picture.DrawPolyline({a, b}, 1., Color{0., 0., 0., 0.7});
    for (const Eigen::Vector2d& end : {a, b}) {
      picture.DrawCircle(end, 1.5, Color{0., 0., 0.}, Color{0., 0., 0.});
    }
  }
  DrawScaleBar(frame, &picture);
  return picture;
}

}  // namespace cartographer_sdf
