// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// One picture of a whole map from its submaps: free space white, walls dark,
// unknown mid-grey, as in the host's pictures. Where submaps overlap, their
// mean is shown; misaligned walls look doubled and pale.

#ifndef CARTOGRAPHER_SDF_REPORT_MAP_PAINTER_H_
#define CARTOGRAPHER_SDF_REPORT_MAP_PAINTER_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/report/indexed_png.h"
#include "cartographer_sdf/report/picture.h"

namespace cartographer_sdf {

struct PlacedGrid {
  CellGeometry geometry;
  Rigid2 T_map_submap;
};

class MapPainter {
 public:
  // The picture shows all grids. Its longer side has at most `max_pixels`
  // pixels, and no pixel is smaller than a cell of the finest grid. Grids
  // without cells or with an absurd pose (beyond 10 000 km, NaN) are not shown.
  MapPainter(const std::vector<PlacedGrid>& grids, int max_pixels);

  // With pixels of the given size [m]; 0: that of a cell of the finest grid.
  // Fails if it is smaller than that, if no grid is shown, or if the picture
  // would have more than 16384 pixels along a side.
  [[nodiscard]] static absl::StatusOr<MapPainter> WithPixelSize(
      const std::vector<PlacedGrid>& grids, double pixel_size);

  // Uses memory for the picture only, not for the submaps. Drops cells outside
  // the picture.
  void AddSubmap(const OccupancyGrid& grid, const Rigid2& T_map_submap);

  [[nodiscard]] const PixelFrame& frame() const { return frame_; }
  // Size of the picture, in pixels.
  [[nodiscard]] Eigen::Array2i size() const {
    return {static_cast<int>(num_samples_.rows()),
            static_cast<int>(num_samples_.cols())};
  }
  // Pictures of the submaps added so far, and of an empty map.
  [[nodiscard]] Picture Paint() const;
  [[nodiscard]] Picture UnobservedPicture() const;
  // Mean probability of a pixel minus 1/2, with walls weighted more where
  // pixels are larger than cells: positive for walls, negative for free space;
  // none where nothing is known.
  [[nodiscard]] std::optional<double> ExcessAt(int x, int y) const;

 private:
  MapPainter() = default;
  void SetFrame(const Eigen::AlignedBox2d& bounds, double pixel_size,
                int max_pixels);

  PixelFrame frame_;
  // Per pixel, over the samples of known cells: their number, and the sums of
  // their probabilities' excess above and deficit below 1/2.
  Eigen::ArrayXXf num_samples_;
  Eigen::ArrayXXf occupied_;
  Eigen::ArrayXXf free_;
  double finest_resolution_ = 0.;
};

// A picture of few colours.
struct IndexedPicture {
  int width = 0;
  int height = 0;
  std::vector<Rgba> palette;
  std::vector<uint8_t> pixels;  // row by row, from the top

  [[nodiscard]] std::string EncodePng() const;
};

// As Paint(), with walls in the given colour, and transparent where nothing is
// known.
[[nodiscard]] IndexedPicture PaintIndexed(const MapPainter& map,
                                          const Color& wall);

// For overlays: walls in the given colour, the surer the stronger, all free
// space white, and transparent where nothing is known.
[[nodiscard]] IndexedPicture PaintWalls(const MapPainter& map,
                                        const Color& wall);

// Several maps in one picture. The painters are made of the same grids, and
// each has the submaps of one map. Walls have the colour of their map's index
// (CategoryColor), free space of any map is white, walls of one map in the free
// space of another are red, and what no map knows is grey.
[[nodiscard]] IndexedPicture PaintOverlaid(const std::vector<MapPainter>& maps);

// Of the pixels with a wall of any map, the share that is free in another.
[[nodiscard]] double ConflictShare(const std::vector<MapPainter>& maps);

// These draw on a map's picture. Positions are in the frame of `frame` [m];
// absurd ones are left out.
void DrawTrajectory(const std::vector<Eigen::Vector2d>& positions,
                    const PixelFrame& frame, const Color& color,
                    Picture* picture);
// A scale bar at the lower left, with a round length [m].
void DrawScaleBar(const PixelFrame& frame, Picture* picture);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_MAP_PAINTER_H_
