// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/indexed_png.h"

#include <zlib.h>

#include <cstddef>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr char kSignature[] = "\x89PNG\r\n\x1a\n";
constexpr char kIndexedColor = 3;
constexpr int kMaxIndexedPixels = 16384;

std::string BigEndianWord(const uint64_t word) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) {
    bytes.push_back(static_cast<char>((word >> shift) & 0xff));
  }
  return bytes;
}

std::string Chunk(const std::string& type, const std::string& data) {
  const std::string checked = type + data;
  const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(checked.data()),
                          static_cast<uInt>(checked.size()));
  return BigEndianWord(data.size()) + checked + BigEndianWord(sum);
}

int BitDepth(const size_t num_colors) {
  return num_colors <= 2 ? 1 : num_colors <= 4 ? 2 : num_colors <= 16 ? 4 : 8;
}

// Rows of packed indices, each behind its filter: none.
std::string PackRows(const int width, const int height, const int depth,
                     const std::vector<uint8_t>& pixels) {
  std::string rows;
  for (int y = 0; y < height; ++y) {
    rows.push_back(0);
    int byte = 0, num_bits = 0;
    for (int x = 0; x < width; ++x) {
      byte = (byte << depth) |
             pixels[static_cast<size_t>(y) * static_cast<size_t>(width) +
                    static_cast<size_t>(x)];
      num_bits += depth;
      if (num_bits < 8 && x + 1 < width) continue;
      rows.push_back(static_cast<char>(byte << (8 - num_bits)));
      byte = num_bits = 0;
    }
  }
  return rows;
}

std::string Compressed(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string compressed(size, 0);
  const int result =
      compress2(reinterpret_cast<Bytef*>(compressed.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(),
                Z_BEST_COMPRESSION);
  CHECK_EQ(result, Z_OK);
  compressed.resize(size);
  return compressed;
}

}  // namespace

std::string EncodeIndexedPng(const int width, const int height,
                             const std::vector<Rgba>& palette,
                             const std::vector<uint8_t>& pixels) {
  CHECK(width >= 1 && height >= 1 && width <= kMaxIndexedPixels &&
        height <= kMaxIndexedPixels)
      << width << " x " << height;
  CHECK(!palette.empty() && palette.size() <= 256) << palette.size();
  CHECK_EQ(pixels.size(),
           static_cast<size_t>(width) * static_cast<size_t>(height));
  const int depth = BitDepth(palette.size());
  std::string colors, alphas;
  for (const Rgba& color : palette) {
    for (const uint8_t part : {color.red, color.green, color.blue}) {
      colors.push_back(static_cast<char>(part));
    }
    alphas.push_back(static_cast<char>(color.alpha));
  }
  const std::string header =
      BigEndianWord(static_cast<uint64_t>(width)) +
      BigEndianWord(static_cast<uint64_t>(height)) +
      std::string({static_cast<char>(depth), kIndexedColor, 0, 0, 0});
  return std::string(kSignature, sizeof(kSignature) - 1) +
         Chunk("IHDR", header) + Chunk("PLTE", colors) + Chunk("tRNS", alphas) +
         Chunk("IDAT", Compressed(PackRows(width, height, depth, pixels))) +
         Chunk("IEND", "");
}

}  // namespace cartographer_sdf
