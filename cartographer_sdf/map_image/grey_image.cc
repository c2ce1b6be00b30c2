// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/map_image/grey_image.h"

#include <cairo.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <istream>
#include <limits>
#include <memory>
#include <optional>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace cartographer_sdf {
namespace {

// Bounds on the memory that a hostile header can request, and on the number of
// cells along an axis.
constexpr int64_t kMaxImagePixels = 25'000'000;
constexpr int64_t kMaxImageSide = 30'000;

bool IsSizeAllowed(const int64_t width, const int64_t height) {
  return width >= 1 && height >= 1 && width <= kMaxImageSide &&
         height <= kMaxImageSide && width <= kMaxImagePixels / height;
}

// Reads a decimal number of a PGM header or of P2 data; none if it is missing
// or exceeds `maximum`.
std::optional<int64_t> ReadNumber(const int64_t maximum,
                                  std::istream* const in) {
  while ((*in >> std::ws).peek() == '#') {
    in->ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  int64_t number = 0;
  // Without a sign.
  if (!std::isdigit(in->peek()) || !(*in >> number) || number > maximum) {
    return std::nullopt;
  }
  return number;
}

std::optional<int64_t> ReadPixel(const bool is_text, const int64_t maximum,
                                 std::istream* in) {
  if (is_text) return ReadNumber(maximum, in);
  int64_t pixel = in->get();
  if (maximum > 255) pixel = 256 * pixel + in->get();
  if (!in->good() || pixel > maximum) return std::nullopt;
  return pixel;
}

struct PgmHeader {
  bool is_text = false;
  int64_t width = 0;
  int64_t height = 0;
  int64_t maximum = 0;  // of a pixel: white
};

absl::StatusOr<PgmHeader> ReadPgmHeader(const std::string& path,
                                        std::istream* const in) {
  const int magic[2] = {in->get(), in->get()};
  const bool is_text = magic[1] == '2';
  if (magic[0] != 'P' || (!is_text && magic[1] != '5')) {
    return absl::InvalidArgumentError(
        absl::StrCat(path, " is not a PGM image (P2 or P5)"));
  }
  const std::optional<int64_t> width = ReadNumber(kMaxImageSide, in);
  const std::optional<int64_t> height = ReadNumber(kMaxImageSide, in);
  const std::optional<int64_t> maximum = ReadNumber(65535, in);
  if (!width || !height || !maximum || !IsSizeAllowed(*width, *height) ||
      *maximum < 1 || !std::isspace(in->get())) {
    return absl::InvalidArgumentError(
        absl::StrCat("the PGM header of ", path, " is broken or too large"));
  }
  return PgmHeader{is_text, *width, *height, *maximum};
}

// Reads on behalf of Cairo from an std::istream.
cairo_status_t ReadPngBytes(void* const stream, unsigned char* const data,
                            const unsigned int length) {
  std::istream& in = *static_cast<std::istream*>(stream);
  in.read(reinterpret_cast<char*>(data), length);
  return in.gcount() == static_cast<std::streamsize>(length)
             ? CAIRO_STATUS_SUCCESS
             : CAIRO_STATUS_READ_ERROR;
}

uint32_t BigEndian(const unsigned char* const bytes) {
  return uint32_t{bytes[0]} << 24 | uint32_t{bytes[1]} << 16 |
         uint32_t{bytes[2]} << 8 | uint32_t{bytes[3]};
}

// Checks the first chunk, which has the size, before anything is decoded.
absl::Status CheckPngHeader(const std::string& path, std::istream* const in) {
  constexpr unsigned char kMagic[8] = {137, 'P', 'N', 'G', 13, 10, 26, 10};
  unsigned char header[24];
  in->read(reinterpret_cast<char*>(header), sizeof(header));
  if (in->gcount() != sizeof(header) ||
      std::memcmp(header, kMagic, sizeof(kMagic)) != 0 ||
      std::memcmp(header + 12, "IHDR", 4) != 0) {
    return absl::InvalidArgumentError(
        absl::StrCat(path, " is not a PNG image"));
  }
  if (!IsSizeAllowed(BigEndian(header + 16), BigEndian(header + 20))) {
    return absl::InvalidArgumentError(
        absl::StrCat("the image ", path, " is empty or too large"));
  }
  in->clear();
  in->seekg(0);
  return absl::OkStatus();
}

using PngSurface = std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)>;

// Copies the pixels of a surface, whose colours are multiplied by their
// opacity.
GreyImage CopyPixels(cairo_surface_t* const surface) {
  const int width = cairo_image_surface_get_width(surface);
  const int height = cairo_image_surface_get_height(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  const bool has_alpha =
      cairo_image_surface_get_format(surface) == CAIRO_FORMAT_ARGB32;
  const unsigned char* const data = cairo_image_surface_get_data(surface);
  GreyImage image;
  image.brightness.resize(width, height);
  if (has_alpha) image.transparent.resize(width, height);
  for (int line = 0; line < height; ++line) {
    for (int x = 0; x < width; ++x) {
      uint32_t pixel = 0;
      std::memcpy(&pixel, data + int64_t{line} * stride + int64_t{4} * x,
                  sizeof(pixel));
      const uint32_t sum =
          (pixel >> 16 & 255) + (pixel >> 8 & 255) + (pixel & 255);
      image.brightness(x, height - 1 - line) = static_cast<float>(sum) / 765.f;
      if (has_alpha) {
        image.transparent(x, height - 1 - line) = pixel >> 24 != 255;
      }
    }
  }
  return image;
}

}  // namespace

absl::StatusOr<GreyImage> ReadPgmImage(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return absl::NotFoundError(absl::StrCat("cannot open ", path));
  const absl::StatusOr<PgmHeader> header = ReadPgmHeader(path, &in);
  if (!header.ok()) return header.status();
  const auto& [is_text, width, height, maximum] = *header;
  GreyImage image;
  image.brightness.resize(width, height);
  for (int64_t k = 0; k != width * height; ++k) {
    const std::optional<int64_t> pixel = ReadPixel(is_text, maximum, &in);
    if (!pixel) {
      return absl::DataLossError(absl::StrCat(
          path, " ends or is corrupted at pixel ", k, " of ", width * height));
    }
    // By rows, starting at the upper left.
    image.brightness(k % width, height - 1 - k / width) =
        static_cast<float>(*pixel) / static_cast<float>(maximum);
  }
  return image;
}

absl::StatusOr<GreyImage> ReadPngImage(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return absl::NotFoundError(absl::StrCat("cannot open ", path));
  const absl::Status status = CheckPngHeader(path, &in);
  if (!status.ok()) return status;
  const PngSurface surface(cairo_image_surface_create_from_png_stream(
                               &ReadPngBytes, static_cast<std::istream*>(&in)),
                           &cairo_surface_destroy);
  const cairo_format_t format = cairo_image_surface_get_format(surface.get());
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS ||
      (format != CAIRO_FORMAT_ARGB32 && format != CAIRO_FORMAT_RGB24)) {
    return absl::DataLossError(
        absl::StrCat("the image ", path, " cannot be decoded"));
  }
  return CopyPixels(surface.get());
}

}  // namespace cartographer_sdf
