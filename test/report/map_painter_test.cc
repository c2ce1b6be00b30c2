// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/map_painter.h"

#include <cmath>
#include <limits>

#include "gtest/gtest.h"
#include "test/testing/decoded_png.h"
#include "test/testing/rectangular_room.h"

namespace cartographer_sdf::map_painter_test {
namespace {

constexpr double kWall = 0.1;

// 6 m x 4 m around the origin of a submap frame that is turned in the grid.
CellGeometry TestGeometry() {
  return CellGeometry{{140, 100}, 0.05, Rigid2(3.5, 2.5, M_PI)};
}

OccupancyGrid TestRoom() {
  return RectangularRoom(6., 4., kWall, TestGeometry());
}

Rgb PixelAt(const DecodedPng& png, const PixelFrame& frame, const double x,
            const double y) {
  const Eigen::Vector2d pixel = frame.ToPixels({x, y});
  return png.At(static_cast<int>(std::floor(pixel.x())),
                static_cast<int>(std::floor(pixel.y())));
}

DecodedPng PaintOne(const Rigid2& T_map_submap, const int max_pixels,
                    PixelFrame* const frame) {
  MapPainter painter({{TestGeometry(), T_map_submap}}, max_pixels);
  painter.AddSubmap(TestRoom(), T_map_submap);
  *frame = painter.frame();
  return DecodePng(painter.Paint().EncodePng());
}

TEST(MapPainterTest, PaintsFreeWhiteWallsBlackUnknownGrey) {
  // Turned, moved and shrunk, the room must lie where the pose puts it.
  for (const int max_pixels : {2000, 110, 60}) {
    for (const double yaw : {0., 0.3, -M_PI / 2., 2.5}) {
      const Rigid2 T_map_submap(100., -50., yaw);
      PixelFrame frame;
      const DecodedPng png = PaintOne(T_map_submap, max_pixels, &frame);
      ASSERT_LE(std::max(png.width, png.height), max_pixels);
      const auto grey_at = [&](const double x, const double y) {
        const Eigen::Vector2d p_map = T_map_submap * Eigen::Vector2d(x, y);
        const Rgb rgb = PixelAt(png, frame, p_map.x(), p_map.y());
        EXPECT_EQ(rgb.red, rgb.blue);
        return rgb.red;
      };
      EXPECT_EQ(grey_at(0., 0.), 255);
      EXPECT_EQ(grey_at(2.7, -1.7), 255);
      EXPECT_EQ(grey_at(3.4, 0.), 128);
      EXPECT_EQ(grey_at(0., 2.4), 128);
      EXPECT_LT(grey_at(3.0 + kWall / 2., 0.5), 90) << max_pixels << " " << yaw;
      EXPECT_LT(grey_at(0.5, -2.0 - kWall / 2.), 90) << max_pixels << yaw;
    }
  }
}

TEST(MapPainterTest, LeavesNoHolesInTurnedGrids) {
  PixelFrame frame;
  const DecodedPng png = PaintOne(Rigid2(0., 0., 0.7), 2000, &frame);
  for (double x = -2.8; x < 2.8; x += 0.03) {
    for (double y = -1.8; y < 1.8; y += 0.03) {
      const Eigen::Vector2d p = Rigid2(0., 0., 0.7) * Eigen::Vector2d(x, y);
      ASSERT_EQ(PixelAt(png, frame, p.x(), p.y()).red, 255) << x << " " << y;
    }
  }
}

TEST(MapPainterTest, PixelsAreNotSmallerThanCells) {
  const MapPainter painter({{TestGeometry(), Rigid2()}}, 8000);
  EXPECT_DOUBLE_EQ(painter.frame().pixels_per_meter, 20.);
  // 7 m and 5 m of grid and 0.5 m around.
  const Picture picture = painter.Paint();
  EXPECT_EQ(picture.width(), 160);
  EXPECT_EQ(picture.height(), 120);
}

TEST(MapPainterTest, DoesNotDependOnTheOrderOfFarSubmaps) {
  const std::vector<PlacedGrid> grids = {{TestGeometry(), Rigid2(0., 0., 0.)},
                                         {TestGeometry(), Rigid2(20., 3., 1.)}};
  MapPainter a(grids, 300);
  MapPainter b(grids, 300);
  a.AddSubmap(TestRoom(), grids[0].T_map_submap);
  a.AddSubmap(TestRoom(), grids[1].T_map_submap);
  b.AddSubmap(TestRoom(), grids[1].T_map_submap);
  b.AddSubmap(TestRoom(), grids[0].T_map_submap);
  EXPECT_EQ(a.Paint().EncodePng(), b.Paint().EncodePng());
  MapPainter c(grids, 300);
  c.AddSubmap(TestRoom(), grids[0].T_map_submap);
  EXPECT_NE(a.Paint().EncodePng(), c.Paint().EncodePng());
}

TEST(MapPainterTest, SurvivesDegenerateMaps) {
  EXPECT_GE(MapPainter({}, 100).Paint().width(), 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Rigid2 lost(nan, 0., 0.);
  const Rigid2 far(1e300, 0., 0.);
  MapPainter painter({{TestGeometry(), lost},
                      {TestGeometry(), far},
                      {CellGeometry(), Rigid2()},
                      {TestGeometry(), Rigid2(0., 9e6, 0.)},
                      {TestGeometry(), Rigid2()}},
                     200);
  painter.AddSubmap(TestRoom(), lost);
  painter.AddSubmap(TestRoom(), far);
  painter.AddSubmap(TestRoom(), Rigid2());
  Picture picture = painter.Paint();
  EXPECT_LE(picture.height(), 200);
  EXPECT_LE(picture.width(), 200);
  DrawScaleBar(painter.frame(), &picture);
  DrawTrajectory({lost.translation(), far.translation()}, painter.frame(),
                 Color(), &picture);
  DrawTrajectory({}, painter.frame(), Color(), &picture);
}

TEST(MapPainterTest, OverlaysLieWhereTheirPointsAre) {
  const MapPainter painter({{TestGeometry(), Rigid2()}}, 1000);
  Picture picture = painter.Paint();
  const Color red{1., 0., 0.};
  DrawTrajectory({{-2., 0.}, {2., 0.}}, painter.frame(), red, &picture);
  const DecodedPng png = DecodePng(picture.EncodePng());
  const Rgb on_line = PixelAt(png, painter.frame(), 1., 0.01);
  EXPECT_GT(on_line.red, on_line.green + 50);
  EXPECT_EQ(PixelAt(png, painter.frame(), -2., 0.), (Rgb{255, 255, 255}));
  EXPECT_EQ(PixelAt(png, painter.frame(), 2., 0.), (Rgb{255, 0, 0}));
  EXPECT_EQ(PixelAt(png, painter.frame(), 0., 1.), (Rgb{128, 128, 128}));
}

// Two painters of the same grids, each with one of two rooms.
std::vector<MapPainter> TwoMaps(const Rigid2& T_map_second) {
  const std::vector<PlacedGrid> grids = {{TestGeometry(), Rigid2()},
                                         {TestGeometry(), T_map_second}};
  std::vector<MapPainter> maps(2, MapPainter(grids, 1000));
  maps[0].AddSubmap(TestRoom(), Rigid2());
  maps[1].AddSubmap(TestRoom(), T_map_second);
  return maps;
}

TEST(MapPainterTest, IndexedPicturesShowTheSame) {
  const std::vector<MapPainter> maps = TwoMaps(Rigid2(20., 0., 0.));
  const IndexedPicture picture = PaintIndexed(maps[0], kBlack);
  const DecodedPng png = DecodePng(picture.EncodePng());
  const PixelFrame& frame = maps[0].frame();
  EXPECT_EQ(PixelAt(png, frame, 0., 0.), (Rgb{255, 255, 255}));
  EXPECT_LT(PixelAt(png, frame, 3. + kWall / 2., 0.5).red, 90);
  // Transparent where nothing is known.
  const Eigen::Vector2d unknown = frame.ToPixels({10., 0.});
  const auto index =
      static_cast<size_t>(unknown.y()) * static_cast<size_t>(picture.width) +
      static_cast<size_t>(unknown.x());
  EXPECT_EQ(picture.pixels[index], 0);
  EXPECT_EQ(picture.palette[0].alpha, 0);
}

TEST(MapPainterTest, WallsAloneHaveAColor) {
  OccupancyGrid grid = TestRoom();
  // Half of the room is hardly known to be free.
  for (int j = 0; j < grid.geometry.size.y() / 2; ++j) {
    for (int i = 0; i < grid.geometry.size.x(); ++i) {
      if (grid.probability(i, j) < 0.5f) grid.probability(i, j) = 0.49f;
    }
  }
  MapPainter painter({{TestGeometry(), Rigid2()}}, 1000);
  painter.AddSubmap(grid, Rigid2());
  const DecodedPng png =
      DecodePng(PaintWalls(painter, CategoryColor(0)).EncodePng());
  for (const double y : {-1., 1.}) {
    EXPECT_EQ(PixelAt(png, painter.frame(), 0., y), (Rgb{255, 255, 255}));
  }
  const Rgb wall = PixelAt(png, painter.frame(), 3. + kWall / 2., 0.5);
  EXPECT_GT(wall.blue, wall.red + 100);
}

TEST(MapPainterTest, OverlaidMapsHaveTheirColors) {
  // A wall of the second stands in the middle of the first.
  const std::vector<MapPainter> maps = TwoMaps(Rigid2(3., 0., 0.));
  const DecodedPng png = DecodePng(PaintOverlaid(maps).EncodePng());
  const PixelFrame& frame = maps[0].frame();
  EXPECT_EQ(PixelAt(png, frame, -kWall / 2., 0.5), (Rgb{230, 26, 26}));
  EXPECT_EQ(PixelAt(png, frame, -1.5, 0.), (Rgb{255, 255, 255}));
  // The outer walls, each in its map's colour.
  const Rgb first = PixelAt(png, frame, -3. - kWall / 2., 0.5);
  const Rgb second = PixelAt(png, frame, 6. + kWall / 2., 0.5);
  EXPECT_GT(first.blue, first.red + 100);
  EXPECT_GT(second.red, second.blue + 100);
  EXPECT_EQ(PixelAt(png, frame, 0., 2.4), (Rgb{128, 128, 128}));
  EXPECT_GT(ConflictShare(maps), 0.2);
  EXPECT_EQ(ConflictShare(TwoMaps(Rigid2(20., 0., 0.))), 0.);
}

}  // namespace
}  // namespace cartographer_sdf::map_painter_test
