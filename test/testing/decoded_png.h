// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef TEST_TESTING_DECODED_PNG_H_
#define TEST_TESTING_DECODED_PNG_H_

#include <cairo/cairo.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <ostream>
#include <string>
#include <vector>

struct Rgb {
  int red = 0;
  int green = 0;
  int blue = 0;

  friend bool operator==(const Rgb& a, const Rgb& b) {
    return a.red == b.red && a.green == b.green && a.blue == b.blue;
  }
  friend bool operator!=(const Rgb& a, const Rgb& b) { return !(a == b); }
  friend std::ostream& operator<<(std::ostream& out, const Rgb& rgb) {
    return out << "(" << rgb.red << " " << rgb.green << " " << rgb.blue << ")";
  }
};

struct DecodedPng {
  int width = 0;
  int height = 0;
  std::vector<Rgb> pixels;

  // Black outside, as of an empty picture where the bytes are no PNG.
  [[nodiscard]] Rgb At(const int x, const int y) const {
    if (x < 0 || y < 0 || x >= width || y >= height) return {};
    return pixels[static_cast<size_t>(y) * static_cast<size_t>(width) +
                  static_cast<size_t>(x)];
  }
};

inline DecodedPng DecodePng(const std::string& png) {
  std::string rest = png;
  cairo_surface_t* const surface = cairo_image_surface_create_from_png_stream(
      [](void* closure, unsigned char* bytes, unsigned int size) {
        std::string& unread = *static_cast<std::string*>(closure);
        if (unread.size() < size) return CAIRO_STATUS_READ_ERROR;
        std::memcpy(bytes, unread.data(), size);
        unread.erase(0, size);
        return CAIRO_STATUS_SUCCESS;
      },
      &rest);
  DecodedPng decoded;
  if (cairo_surface_status(surface) == CAIRO_STATUS_SUCCESS) {
    decoded.width = cairo_image_surface_get_width(surface);
    decoded.height = cairo_image_surface_get_height(surface);
    const std::ptrdiff_t stride = cairo_image_surface_get_stride(surface);
    for (int y = 0; y < decoded.height; ++y) {
      for (int x = 0; x < decoded.width; ++x) {
        uint32_t pixel;
        std::memcpy(&pixel,
                    cairo_image_surface_get_data(surface) + y * stride +
                        std::ptrdiff_t{4} * x,
                    sizeof(pixel));
        decoded.pixels.push_back(Rgb{static_cast<int>((pixel >> 16) & 255),
                                     static_cast<int>((pixel >> 8) & 255),
                                     static_cast<int>(pixel & 255)});
      }
    }
  }
  cairo_surface_destroy(surface);
  return decoded;
}

#endif  // TEST_TESTING_DECODED_PNG_H_
