// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/feature_pictures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "glog/logging.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/decoded_png.h"
#include "test/testing/rectangular_room.h"

namespace cartographer_sdf::feature_pictures_test {
namespace {

using ::testing::HasSubstr;

CellGeometry TestGeometry() {
  return CellGeometry{{100, 80}, 0.05, Rigid2(-2.5, -2., 0.)};
}

// A room of 4 m x 3 m in the middle of a grid of 5 m x 4 m.
OccupancyGrid RoomGrid() {
  return RectangularRoom(4., 3., 0.1, TestGeometry());
}

DistanceField RoomField() {
  std::optional<DistanceField> field = MakeDistanceField({}, RoomGrid());
  CHECK(field.has_value());
  return *std::move(field);
}

int CountPixels(const DecodedPng& png, const std::function<bool(Rgb)>& is) {
  return static_cast<int>(
      std::count_if(png.pixels.begin(), png.pixels.end(), is));
}
// Up to how a fraction is rounded to a byte.
bool IsColor(const Rgb& a, const Rgb& b) {
  return std::abs(a.red - b.red) <= 1 && std::abs(a.green - b.green) <= 1 &&
         std::abs(a.blue - b.blue) <= 1;
}

bool IsWhite(const Rgb& p) {
  return p.red > 250 && p.green > 250 && p.blue > 250;
}

Feature FeatureAt(const double x, const double y, const KeypointKind kind) {
  return {{{x, y}, 1., kind, 1.}, 0.};
}

// Distance to a wall along y at x = 1 m of the grid frame: obstacle left of it.
DistanceField HalfPlane() {
  DistanceField field{TestGeometry(), Eigen::ArrayXXf(100, 80),
                      BoolArray::Constant(100, 80, true)};
  for (int i = 0; i < 100; ++i) {
    field.distance.row(i) =
        static_cast<float>(field.geometry.CellsToGrid({i, 0.}).x() - 1.);
  }
  return field;
}

TEST(DrawDistanceFieldTest, ColorsSidesContoursAndUnknown) {
  DistanceField field = HalfPlane();
  field.observed.rightCols(20).setConstant(false);
  // 5 m x 4 m at 100 pixels per metre.
  const DecodedPng png =
      DecodePng(DrawDistanceField(field, {}, 500).EncodePng());
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
  const std::vector<Feature> features = {
      FeatureAt(0., 0., KeypointKind::kMaximum),
      FeatureAt(1., 0., KeypointKind::kSaddle),
      FeatureAt(1., 1., KeypointKind::kMinimum)};
  const DecodedPng png =
      DecodePng(DrawDistanceField(HalfPlane(), features, 500).EncodePng());
  // The submap's origin is at (2.5, 2) m of the grid frame.
  EXPECT_TRUE(IsColor(png.At(250, 200), Rgb{230, 26, 26}));
  EXPECT_TRUE(IsColor(png.At(350, 200), Rgb{26, 179, 51}));
  EXPECT_TRUE(IsColor(png.At(350, 100), Rgb{255, 230, 26}));
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

TEST(ClearanceMaskTest, LeavesTheMiddleOut) {
  const DistanceField field = RoomField();
  int last = 0;
  for (const double clearance : {0.25, 0.5, 1., 2.}) {
    const DecodedPng png =
        DecodePng(DrawClearanceMask(field, clearance, 500).EncodePng());
    const int white = CountPixels(png, &IsWhite);
    EXPECT_GT(white, last);
    last = white;
    // Of a room, all but an inner rectangle is within the distance.
    const double all = 4. * 3.;
    const double inner =
        std::max(0., 4. - 2. * clearance) * std::max(0., 3. - 2. * clearance);
    const int shaded = CountPixels(
        png, [](const Rgb& p) { return p.blue > p.red + 20 && p.red < 140; });
    if (inner > 0.) {
      EXPECT_NEAR(static_cast<double>(shaded) / (white + shaded), inner / all,
                  0.05);
    } else {
      EXPECT_EQ(shaded, 0);
    }
  }
}

TEST(FieldSurfaceTest, DrawsTheSurfaceAndItsKeypoints) {
  const DistanceField field = RoomField();
  const DecodedPng bare =
      DecodePng(DrawFieldSurface(field, {}, 400).EncodePng());
  EXPECT_EQ(std::max(bare.width, bare.height), 400);
  const int drawn =
      static_cast<int>(bare.pixels.size()) - CountPixels(bare, &IsWhite);
  EXPECT_GT(drawn, 20000);
  const DecodedPng marked = DecodePng(
      DrawFieldSurface(field, {FeatureAt(0., 0., KeypointKind::kMaximum)}, 400)
          .EncodePng());
  EXPECT_GT(CountPixels(marked,
                        [](const Rgb& p) {
                          return p.red > 220 && p.green < 40 && p.blue < 40;
                        }),
            10);
}

TEST(FieldSurfaceTest, OfNothingIsWhite) {
  DistanceField field = RoomField();
  field.observed.setConstant(false);
  const DecodedPng png =
      DecodePng(DrawFieldSurface(field, {}, 100).EncodePng());
  EXPECT_EQ(CountPixels(png, &IsWhite), static_cast<int>(png.pixels.size()));
}

TEST(FeatureWindowTest, ShowsArrowsInACircle) {
  const DistanceField field = RoomField();
  const Eigen::ArrayXXf smoothed = SmoothField(field, 3.);
  const Feature feature = FeatureAt(0.3, 0.2, KeypointKind::kSaddle);
  const DecodedPng png = DecodePng(
      DrawFeatureWindow({}, field, smoothed, feature, 300).EncodePng());
  ASSERT_EQ(png.width, 300);
  // The dominant direction is drawn to the right of the middle, not to the
  // left.
  const auto is_red = [](const Rgb& p) {
    return p.red > 150 && p.green < 60 && p.blue < 60;
  };
  EXPECT_TRUE(is_red(png.At(220, 150)));
  EXPECT_FALSE(is_red(png.At(80, 150)));
}

TEST(DescriptorPlotTest, NamesBothParts) {
  Eigen::VectorXf descriptor = Eigen::VectorXf::Constant(18, 0.2f);
  const std::string svg = RenderDescriptor(descriptor);
  EXPECT_THAT(svg, HasSubstr("orientations"));
  EXPECT_THAT(svg, HasSubstr("mean distance"));
}

TEST(MatchMapTest, TintsBothSubmapsAndJoinsThem) {
  const OccupancyGrid grid = RoomGrid();
  const Rigid2 T_map_query(8., 0., 0.);
  const std::vector<PlacedGrid> placed = {{grid.geometry, Rigid2()},
                                          {grid.geometry, T_map_query}};
  MapPainter painter(placed, 600);
  const Picture picture = DrawMatchOnMap(
      painter, {RoomField(), Rigid2(), {{0, {{0., 0.}, {8., 0.}}}}},
      {RoomField(), T_map_query, {}}, {{{1., 1.}, {1., 1.}}});
  const DecodedPng png = DecodePng(picture.EncodePng());
  const auto at = [&](const double x, const double y) {
    const Eigen::Vector2d pixel = painter.frame().ToPixels({x, y});
    return png.At(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
  };
  EXPECT_GT(at(-1., 0.5).blue, at(-1., 0.5).red + 20);
  EXPECT_GT(at(8.5, -0.5).red, at(8.5, -0.5).blue + 20);
  // The line of the correspondence, between the rooms: a pixel wide, half
  // transparent, and perhaps spread over two.
  EXPECT_LT(at(4., 1.).red, at(4., -1.).red - 50);
}

}  // namespace
}  // namespace cartographer_sdf::feature_pictures_test
