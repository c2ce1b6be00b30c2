// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/picture.h"

#include <cmath>

#include "gtest/gtest.h"
#include "test/testing/decoded_png.h"

namespace cartographer_sdf::picture_test {
namespace {

constexpr Color kRed{1., 0., 0.};

TEST(PictureTest, PngHoldsThePixels) {
  Picture picture(7, 5, Color{0.2, 0.4, 0.6});
  picture.BlendPixel(2, 3, kRed);
  picture.BlendPixel(6, 4, Color{1., 1., 1., 0.5});
  picture.BlendPixel(7, 0, kRed);
  picture.BlendPixel(0, -1, kRed);
  const DecodedPng png = DecodePng(picture.EncodePng());
  ASSERT_EQ(png.width, 7);
  ASSERT_EQ(png.height, 5);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 7; ++x) {
      const Rgb expected = x == 2 && y == 3   ? Rgb{255, 0, 0}
                           : x == 6 && y == 4 ? Rgb{153, 179, 204}
                                              : Rgb{51, 102, 153};
      EXPECT_EQ(png.At(x, y), expected) << x << " " << y;
    }
  }
}

TEST(PictureTest, DrawsShapesInPlace) {
  Picture picture(40, 40, kWhite);
  picture.DrawRectangle({2., 2.}, {4., 4.}, kRed);
  picture.DrawPolyline({{20.5, 0.}, {20.5, 40.}}, 1., Color{0., 0., 1.});
  picture.DrawCircle({32., 32.}, 4., Color{0., 1., 0.}, Color{0., 0., 0.});
  const DecodedPng png = DecodePng(picture.EncodePng());
  EXPECT_EQ(png.At(3, 3), (Rgb{255, 0, 0}));
  EXPECT_EQ(png.At(1, 3), (Rgb{255, 255, 255}));
  EXPECT_EQ(png.At(6, 3), (Rgb{255, 255, 255}));
  EXPECT_EQ(png.At(20, 20), (Rgb{0, 0, 255}));
  EXPECT_EQ(png.At(22, 20), (Rgb{255, 255, 255}));
  EXPECT_EQ(png.At(32, 32), (Rgb{0, 255, 0}));
  EXPECT_EQ(png.At(38, 38), (Rgb{255, 255, 255}));
}

TEST(PictureTest, PixelsMixWithShapes) {
  Picture picture(4, 4, kWhite);
  picture.DrawRectangle({0., 0.}, {4., 4.}, kRed);
  picture.BlendPixel(1, 1, Color{0., 0., 1.});
  picture.DrawRectangle({2., 2.}, {1., 1.}, kWhite);
  const DecodedPng png = DecodePng(picture.EncodePng());
  EXPECT_EQ(png.At(0, 0), (Rgb{255, 0, 0}));
  EXPECT_EQ(png.At(1, 1), (Rgb{0, 0, 255}));
  EXPECT_EQ(png.At(2, 2), (Rgb{255, 255, 255}));
}

TEST(PictureTest, EqualDrawingsGiveEqualBytes) {
  const auto draw = [] {
    Picture picture(60, 30, kWhite);
    picture.DrawText({30., 20.}, "12 m", 12., kRed, Picture::Anchor::kCentre);
    picture.DrawPolyline({{1., 2.}, {50., 20.}, {3., 29.}}, 1.5, kRed);
    return picture.EncodePng();
  };
  EXPECT_EQ(draw(), draw());
}

TEST(RoundStepTest, IsOneTwoOrFive) {
  EXPECT_DOUBLE_EQ(RoundStep(1.), 1.);
  EXPECT_DOUBLE_EQ(RoundStep(1.01), 2.);
  EXPECT_DOUBLE_EQ(RoundStep(0.003), 0.005);
  EXPECT_DOUBLE_EQ(RoundStep(7e7), 1e8);
  EXPECT_DOUBLE_EQ(RoundStep(1e-3), 1e-3);
}

TEST(PixelFrameTest, GoesUpWithYAndBack) {
  const PixelFrame frame{10., {-2., 3.}};
  EXPECT_TRUE(frame.ToPixels({-2., 3.}).isApprox(Eigen::Vector2d(0., 0.)));
  EXPECT_TRUE(frame.ToPixels({-1., 1.}).isApprox(Eigen::Vector2d(10., 20.)));
  EXPECT_TRUE(
      frame.ToPixels(frame.CentreOf(4, 7)).isApprox(Eigen::Vector2d(4.5, 7.5)));
}

TEST(ColorTest, CategoriesRepeatAndMixInterpolates) {
  EXPECT_EQ(CategoryColor(0).red, CategoryColor(6).red);
  EXPECT_EQ(CategoryColor(-1).red, CategoryColor(5).red);
  EXPECT_NE(CategoryColor(0).red, CategoryColor(1).red);
  EXPECT_DOUBLE_EQ(Mix(kWhite, kRed, 0.25).green, 0.75);
}

// WCAG 2.1.
double Luminance(const Color& color) {
  const auto linear = [](const double part) {
    return part <= 0.03928 ? part / 12.92
                           : std::pow((part + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(color.red) + 0.7152 * linear(color.green) +
         0.0722 * linear(color.blue);
}

TEST(ColorTest, CategoriesStandOutFromWhite) {
  for (int k = 0; k < 6; ++k) {
    EXPECT_GE(1.05 / (Luminance(CategoryColor(k)) + 0.05), 3.) << k;
  }
}

}  // namespace
}  // namespace cartographer_sdf::picture_test
