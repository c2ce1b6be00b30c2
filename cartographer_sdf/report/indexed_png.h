// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_REPORT_INDEXED_PNG_H_
#define CARTOGRAPHER_SDF_REPORT_INDEXED_PNG_H_

#include <cstdint>
#include <string>
#include <vector>

namespace cartographer_sdf {

// Each in [0, 255]; an alpha of 0 is transparent.
struct Rgba {
  uint8_t red = 0;
  uint8_t green = 0;
  uint8_t blue = 0;
  uint8_t alpha = 255;
};

// A PNG file (ISO/IEC 15948) of few colours: a fifth of the size of one that
// stores each pixel's colour. `pixels` are indices into the palette, row by row
// from the top; the palette has from 1 to 256 colours, either size is from 1 to
// 16384.
[[nodiscard]] std::string EncodeIndexedPng(int width, int height,
                                           const std::vector<Rgba>& palette,
                                           const std::vector<uint8_t>& pixels);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_INDEXED_PNG_H_
