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

}  // namespace
}  // namespace cartographer_sdf::submap_pictures_test
