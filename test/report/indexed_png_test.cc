// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/indexed_png.h"

#include "gtest/gtest.h"
#include "test/testing/decoded_png.h"

namespace cartographer_sdf::indexed_png_test {
namespace {

// Each colour is its index.
std::vector<Rgba> PaletteOf(const int num_colors) {
  std::vector<Rgba> palette;
  for (int k = 0; k < num_colors; ++k) {
    palette.push_back(
        {static_cast<uint8_t>(k), static_cast<uint8_t>(255 - k), 7, 255});
  }
  return palette;
}

TEST(IndexedPngTest, ReadsBackWithAnyNumberOfColors) {
  // Of one, two, four and eight bits a pixel, in rows that end in any of them.
  for (const int num_colors : {1, 2, 3, 4, 5, 16, 17, 256}) {
    for (const int width : {1, 2, 3, 7, 8, 9}) {
      const int height = 5;
      std::vector<uint8_t> pixels;
      for (int k = 0; k < width * height; ++k) {
        pixels.push_back(static_cast<uint8_t>((k * 37) % num_colors));
      }
      const DecodedPng png = DecodePng(
          EncodeIndexedPng(width, height, PaletteOf(num_colors), pixels));
      ASSERT_EQ(png.width, width) << num_colors;
      ASSERT_EQ(png.height, height);
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          const int index = pixels[static_cast<size_t>(y) * width + x];
          ASSERT_EQ(png.At(x, y), (Rgb{index, 255 - index, 7}))
              << num_colors << " " << x << " " << y;
        }
      }
    }
  }
}

TEST(IndexedPngTest, IsSmall) {
  const std::vector<uint8_t> pixels(1'000'000, 1);
  EXPECT_LT(EncodeIndexedPng(1000, 1000, PaletteOf(3), pixels).size(), 2000u);
}

}  // namespace
}  // namespace cartographer_sdf::indexed_png_test
