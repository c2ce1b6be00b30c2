// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// One picture of a whole map from its submaps: free space white, walls dark,
// unknown mid-grey, as the host's. Where submaps overlap, their mean is shown;
// walls that do not fall together look doubled and pale.

#ifndef CARTOGRAPHER_SDF_REPORT_MAP_PAINTER_H_
#define CARTOGRAPHER_SDF_REPORT_MAP_PAINTER_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/report/picture.h"

namespace cartographer_sdf {

struct PlacedGrid {
  CellGeometry geometry;
  Rigid2 T_map_submap;
};

class MapPainter {
 public:
  // The picture shows all grids; its longer side has at most `max_pixels`
  // pixels, none of which is smaller than a cell of the finest grid. Grids
  // without cells or with a pose off this world (10 000 km, NaN) are not shown.
  MapPainter(const std::vector<PlacedGrid>& grids, int max_pixels);

  // Memory is that of the picture, not of the submaps. What lies outside of the
  // picture is dropped.
  void AddSubmap(const OccupancyGrid& grid, const Rigid2& T_map_submap);

  [[nodiscard]] const PixelFrame& frame() const { return frame_; }
  // Of what was added so far; of nothing.
  [[nodiscard]] Picture Paint() const;
  [[nodiscard]] Picture UnobservedPicture() const;
  // How far the mean probability of a pixel is above (a wall) or below (free)
  // 1/2; none where nothing is known.
  [[nodiscard]] std::optional<double> ExcessAt(int x, int y) const;

 private:
  PixelFrame frame_;
  // Per pixel, of the samples of known cells: their number, and the sum of how
  // far their probability is above or below 1/2.
  Eigen::ArrayXXf num_samples_;
  Eigen::ArrayXXf occupied_;
  Eigen::ArrayXXf free_;
  double finest_resolution_ = 0.;
};

// Several maps in one picture, painted by painters of the same grids, each with
// submaps of its own: the walls of each in the colour of its place in the list
// (CategoryColor), what is free in any of them white, and red where a wall of
// one stands in the free space of another.
[[nodiscard]] Picture PaintOverlaid(const std::vector<MapPainter>& maps);

// To be drawn upon a map's picture. Positions are in the frame of `frame` [m];
// those off this world are left out.
void DrawTrajectory(const std::vector<Eigen::Vector2d>& positions,
                    const PixelFrame& frame, const Color& color,
                    Picture* picture);
// A dot at both ends.
void DrawLink(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
              const PixelFrame& frame, const Color& color, Picture* picture);
// Fine lines every so many metres, with their coordinates at the border.
void DrawMetricGrid(const PixelFrame& frame, Picture* picture);
// At the lower left, of a round number of metres.
void DrawScaleBar(const PixelFrame& frame, Picture* picture);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_MAP_PAINTER_H_
