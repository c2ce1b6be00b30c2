// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/submap_pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gtest/gtest.h"
#include "test/testing/decoded_png.h"
#include "test/testing/rectangular_room.h"

namespace cartographer_sdf::submap_pictures_test {
namespace {

constexpr Rgb kWhite{255, 255, 255};

CellGeometry TestGeometry() {
  return CellGeometry{{100, 80}, 0.05, Rigid2(-2.5, -2., 0.)};
}

// Up to how a fraction is rounded to a byte.
bool IsColor(const Rgb& a, const Rgb& b) {
  return std::abs(a.red - b.red) <= 1 && std::abs(a.green - b.green) <= 1 &&
         std::abs(a.blue - b.blue) <= 1;
}

int CountPixels(const DecodedPng& png, const Rgb& rgb) {
  return static_cast<int>(
      std::count_if(png.pixels.begin(), png.pixels.end(),
                    [&rgb](const Rgb& pixel) { return IsColor(pixel, rgb); }));
}

// Distance to a wall along y at x = 1 m of the grid frame: obstacle left of it.
Eigen::ArrayXXf HalfPlane(const CellGeometry& geometry) {
  Eigen::ArrayXXf distance(geometry.size.x(), geometry.size.y());
  for (int i = 0; i < geometry.size.x(); ++i) {
    distance.row(i) =
        static_cast<float>(geometry.CellsToGrid({i, 0.}).x() - 1.);
  }
  return distance;
}

TEST(DrawDistanceFieldTest, ColorsSidesContoursAndUnknown) {
  const CellGeometry geometry = TestGeometry();
  BoolArray observed = BoolArray::Constant(100, 80, true);
  observed.rightCols(20).setConstant(false);
  // 5 m x 4 m at 100 pixels per metre.
  const DecodedPng png = DecodePng(
      DrawDistanceField(geometry, HalfPlane(geometry), observed, {}, 500)
          .EncodePng());
  ASSERT_EQ(png.width, 500);
  ASSERT_EQ(png.height, 400);
  const Rgb free = png.At(320, 300);
  EXPECT_GT(free.blue, free.red + 50);
  const Rgb inside = png.At(30, 300);
  EXPECT_GT(inside.red, inside.blue + 50);
  // The wall between the pixels 99 and 100, a contour between 149 and 150.
  EXPECT_EQ(png.At(99, 300), (Rgb{0, 0, 0}));
  EXPECT_NE(png.At(98, 300), (Rgb{0, 0, 0}));
  EXPECT_NE(png.At(100, 300), (Rgb{0, 0, 0}));
  EXPECT_LT(png.At(149, 300).blue, png.At(148, 300).blue - 20);
  EXPECT_LT(png.At(149, 300).blue, png.At(150, 300).blue - 20);
  // The unobserved metre on top is hatched grey.
  const Rgb unknown = png.At(321, 40);
  EXPECT_EQ(unknown.red, unknown.blue);
  EXPECT_NE(png.At(320, 40), png.At(321, 40));
}

TEST(DrawDistanceFieldTest, MarksKeypointsByKind) {
  const CellGeometry geometry = TestGeometry();
  const std::vector<MarkedKeypoint> keypoints = {
      {{0., 0.}, KeypointMark::kMaximum},
      {{1., 0.}, KeypointMark::kSaddle},
      {{1., 1.}, KeypointMark::kMinimum}};
  const DecodedPng png = DecodePng(
      DrawDistanceField(geometry, HalfPlane(geometry),
                        BoolArray::Constant(100, 80, true), keypoints, 500)
          .EncodePng());
  // The submap's origin is at (2.5, 2) m of the grid frame.
  EXPECT_TRUE(IsColor(png.At(250, 200), Rgb{230, 26, 26}));
  EXPECT_TRUE(IsColor(png.At(350, 200), Rgb{26, 179, 51}));
  EXPECT_TRUE(IsColor(png.At(350, 100), Rgb{255, 230, 26}));
}

class DrawMatchedPairTest : public ::testing::Test {
 protected:
  const OccupancyGrid room_ = RectangularRoom(4., 3., 0.1, TestGeometry());
  const Rgb reference_wall_{13, 38, 115};
  const Rgb query_wall_{217, 26, 26};
  const Rgb contradiction_{255, 153, 0};
};

TEST_F(DrawMatchedPairTest, FittingRoomsDoNotContradict) {
  // The query's frame is turned and moved against the reference's.
  const Rigid2 T_reference_query(1., 2., 0.5);
  CellGeometry geometry = TestGeometry();
  geometry.T_submap_grid = T_reference_query.Inverse() * geometry.T_submap_grid;
  OccupancyGrid query = room_;
  query.geometry = geometry;
  const DecodedPng png = DecodePng(
      DrawMatchedPair(room_, query, T_reference_query, {}, 400).EncodePng());
  EXPECT_EQ(png.At(png.width / 2, png.height / 2), kWhite);
  EXPECT_EQ(CountPixels(png, contradiction_), 0);
  // Query walls cover those of the reference.
  EXPECT_GT(CountPixels(png, query_wall_), 1000);
  EXPECT_LT(CountPixels(png, reference_wall_), 100);
}

TEST_F(DrawMatchedPairTest, ShowsContradictionsOfBothSides) {
  const Rigid2 T_reference_query(1.5, 0., 0.);
  const DecodedPng png = DecodePng(
      DrawMatchedPair(room_, room_, T_reference_query, {}, 400).EncodePng());
  EXPECT_GT(CountPixels(png, query_wall_), 500);
  EXPECT_GT(CountPixels(png, reference_wall_), 500);
  EXPECT_GT(CountPixels(png, contradiction_), 500);
  // Both rooms lack nothing but the walls that the other sees through: the
  // query's left, the reference's right one, except near the other's walls.
  for (const Eigen::Vector2d& p :
       ContradictedWalls(room_, room_, T_reference_query)) {
    EXPECT_NEAR(p.x(), -2.05 + 1.5, 0.051);
    EXPECT_LT(std::abs(p.y()), 1.5 - 0.25);
  }
}

TEST_F(DrawMatchedPairTest, DrawsCorrespondences) {
  const DecodedPng with = DecodePng(
      DrawMatchedPair(room_, room_, Rigid2(), {{{0., 0.}, {0.5, 0.}}}, 400)
          .EncodePng());
  const DecodedPng without =
      DecodePng(DrawMatchedPair(room_, room_, Rigid2(), {}, 400).EncodePng());
  const int x = with.width / 2;
  const int y = with.height / 2;
  EXPECT_EQ(without.At(x, y), kWhite);
  EXPECT_GT(with.At(x, y).green, with.At(x, y).red + 50);
  EXPECT_EQ(with.At(x - 20, y), kWhite);
}

TEST_F(DrawMatchedPairTest, SurvivesEmptyGrids) {
  const OccupancyGrid unknown = UnknownGrid(TestGeometry());
  const OccupancyGrid empty = UnknownGrid(CellGeometry());
  for (const OccupancyGrid* a : {&room_, &unknown, &empty}) {
    for (const OccupancyGrid* b : {&room_, &unknown, &empty}) {
      EXPECT_LE(DrawMatchedPair(*a, *b, Rigid2(3., 4., 1.), {}, 64).width(),
                64);
    }
  }
}

TEST(DrawOccupancyGridTest, ShowsProbability) {
  OccupancyGrid grid = UnknownGrid(CellGeometry{{2, 1}, 0.05, Rigid2()});
  grid.known(0, 0) = true;
  grid.probability(0, 0) = 0.2f;
  const DecodedPng png = DecodePng(DrawOccupancyGrid(grid, 20).EncodePng());
  EXPECT_EQ(png.width, 20);
  EXPECT_EQ(png.height, 10);
  EXPECT_EQ(png.At(3, 3), (Rgb{204, 204, 204}));
  EXPECT_EQ(png.At(11, 5), (Rgb{168, 168, 168}));
  EXPECT_EQ(png.At(12, 5), (Rgb{199, 199, 199}));
}

}  // namespace
}  // namespace cartographer_sdf::submap_pictures_test
