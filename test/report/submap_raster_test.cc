// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/submap_raster.h"

#include <cmath>

#include "gtest/gtest.h"
#include "test/testing/decoded_png.h"
#include "test/testing/rectangular_room.h"

namespace cartographer_sdf::submap_raster_test {
namespace {

// 4 m x 3 m, in a grid that is turned in the submap and much larger.
OccupancyGrid Room() {
  return RectangularRoom(4., 3., 0.1,
                         CellGeometry{{200, 160}, 0.05, Rigid2(5., 4., M_PI)});
}

TEST(SubmapRasterTest, KeepsWhatIsKnownWhereItIs) {
  for (const int max_pixels : {1000, 84, 40}) {
    const SubmapRaster raster = RasterizeSubmap(Room(), max_pixels);
    // 4.2 m and 3.2 m, walls included.
    EXPECT_NEAR(raster.width * raster.resolution, 4.2, raster.resolution);
    EXPECT_NEAR(raster.height * raster.resolution, 3.2, raster.resolution);
    EXPECT_LE(std::max(raster.width, raster.height), max_pixels);
    EXPECT_EQ(raster.AtPoint({0., 0.}), CellClass::kFree);
    EXPECT_EQ(raster.AtPoint({1.8, -1.3}), CellClass::kFree);
    EXPECT_EQ(raster.AtPoint({2.05, 0.3}), CellClass::kWall) << max_pixels;
    EXPECT_EQ(raster.AtPoint({0.3, -1.55}), CellClass::kWall) << max_pixels;
    EXPECT_EQ(raster.AtPoint({2.5, 0.}), CellClass::kUnknown);
    for (const auto& [x, y] : {std::pair(0, 0), std::pair(3, 5)}) {
      EXPECT_EQ(raster.AtPoint(raster.CentreOf(x, y)), raster.At(x, y));
    }
  }
}

TEST(SubmapRasterTest, EncodesThreeClasses) {
  const SubmapRaster raster = RasterizeSubmap(Room(), 1000);
  const DecodedPng png = DecodePng(EncodePng(raster));
  ASSERT_EQ(png.width, raster.width);
  ASSERT_EQ(png.height, raster.height);
  EXPECT_EQ(png.At(0, 0), (Rgb{0, 0, 0}));
  EXPECT_EQ(png.At(40, 30), (Rgb{255, 255, 255}));
}

TEST(SubmapRasterTest, WallsOverlapWhereBothHaveThem) {
  const SubmapRaster raster = RasterizeSubmap(Room(), 1000);
  // The left wall of the query lies on the right one of the reference.
  const auto overlap = WhereWallsOverlap(raster, raster, Rigid2(4.1, 0., 0.));
  ASSERT_TRUE(overlap.has_value());
  EXPECT_NEAR(overlap->x(), 2.05, 0.1);
  EXPECT_NEAR(overlap->y(), 0., 0.1);
  EXPECT_EQ(raster.AtPoint(*overlap), CellClass::kWall);
}

TEST(SubmapRasterTest, WithoutCommonWallsItIsWhereBothKnow) {
  SubmapRaster free = RasterizeSubmap(Room(), 1000);
  for (CellClass& cell : free.cells) {
    if (cell == CellClass::kWall) cell = CellClass::kFree;
  }
  const auto overlap = WhereWallsOverlap(free, free, Rigid2(2., 0., 0.));
  ASSERT_TRUE(overlap.has_value());
  EXPECT_NEAR(overlap->x(), 1., 0.1);
  EXPECT_FALSE(WhereWallsOverlap(free, free, Rigid2(20., 0., 0.)).has_value());
}

TEST(SubmapRasterTest, SurvivesEmptyGrids) {
  const SubmapRaster nothing = RasterizeSubmap(OccupancyGrid(), 10);
  const SubmapRaster unknown =
      RasterizeSubmap(UnknownGrid(CellGeometry{{5, 5}, 0.05, Rigid2()}), 10);
  for (const SubmapRaster* const raster : {&nothing, &unknown}) {
    EXPECT_EQ(EncodePng(*raster), "");
    EXPECT_FALSE(WhereWallsOverlap(*raster, *raster, Rigid2()).has_value());
  }
}

}  // namespace
}  // namespace cartographer_sdf::submap_raster_test
