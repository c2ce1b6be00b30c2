// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/picture.h"

#include <cairo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr int kMaxPictureSide = 16384;
// Corridors of maps reach hundreds of metres; no pair of submaps exceeds this.
constexpr double kMaxExtentMeters = 2000.;

double Quantized(const double value) {
  return std::floor(255. * std::clamp(value, 0., 1.) + 0.5);
}

cairo_status_t AppendBytes(void* const output, const unsigned char* const bytes,
                           const unsigned int size) {
  static_cast<std::string*>(output)->append(
      reinterpret_cast<const char*>(bytes), size);
  return CAIRO_STATUS_SUCCESS;
}

void SetColor(cairo_t* const context, const Color& color) {
  cairo_set_source_rgba(context, color.red, color.green, color.blue,
                        color.alpha);
}

}  // namespace

Color Mix(const Color& a, const Color& b, const double fraction_of_b) {
  const auto mix = [fraction_of_b](const double x, const double y) {
    return x + fraction_of_b * (y - x);
  };
  return Color{mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue),
               mix(a.alpha, b.alpha)};
}

Color CategoryColor(const int category) {
  // Okabe and Ito, "Color universal design", 2008, without black and yellow;
  // the last three darker, so that they stand out from white by 3 to 1.
  static constexpr std::array<Color, 6> kColors = {{{0.00, 0.45, 0.70, 1.},
                                                    {0.84, 0.37, 0.00, 1.},
                                                    {0.00, 0.62, 0.45, 1.},
                                                    {0.78, 0.46, 0.64, 1.},
                                                    {0.75, 0.51, 0.00, 1.},
                                                    {0.28, 0.59, 0.76, 1.}}};
  const int n = static_cast<int>(kColors.size());
  return kColors[static_cast<size_t>(((category % n) + n) % n)];
}

double RoundStep(const double step) {
  CHECK(std::isfinite(step) && step > 0.) << step;
  const double magnitude = std::pow(10., std::floor(std::log10(step)));
  for (const double factor : {1., 2., 5.}) {
    // Tolerates the rounding of the logarithm.
    if (factor * magnitude >= step * (1. - 1e-9)) return factor * magnitude;
  }
  return 10. * magnitude;
}

Picture::Picture(const int width, const int height, const Color& background)
    : context_(nullptr, &cairo_destroy) {
  CHECK(width >= 1 && width <= kMaxPictureSide) << width;
  CHECK(height >= 1 && height <= kMaxPictureSide) << height;
  cairo_surface_t* const surface =
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
  context_.reset(cairo_create(surface));
  cairo_surface_destroy(surface);  // the context holds a reference
  CHECK_EQ(cairo_status(context_.get()), CAIRO_STATUS_SUCCESS);
  SetColor(context_.get(), background);
  cairo_paint(context_.get());
  cairo_set_line_join(context_.get(), CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(context_.get(), CAIRO_LINE_CAP_ROUND);
  cairo_select_font_face(context_.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         CAIRO_FONT_WEIGHT_NORMAL);
}

int Picture::width() const {
  return cairo_image_surface_get_width(cairo_get_target(context_.get()));
}

int Picture::height() const {
  return cairo_image_surface_get_height(cairo_get_target(context_.get()));
}

void Picture::BlendPixel(const int x, const int y, const Color& color) {
  if (x < 0 || y < 0 || x >= width() || y >= height()) return;
  cairo_surface_t* const surface = cairo_get_target(context_.get());
  cairo_surface_flush(surface);
  // A picture of 30,000 pixels along each side has more than 2 GB.
  const ptrdiff_t stride = cairo_image_surface_get_stride(surface);
  unsigned char* const address =
      cairo_image_surface_get_data(surface) + stride * y + ptrdiff_t{4} * x;
  uint32_t pixel;
  std::memcpy(&pixel, address, sizeof(pixel));
  const Color old{((pixel >> 16) & 255) / 255., ((pixel >> 8) & 255) / 255.,
                  (pixel & 255) / 255., 1.};
  const Color mixed = Mix(old, color, std::clamp(color.alpha, 0., 1.));
  pixel = static_cast<uint32_t>(Quantized(mixed.red)) << 16 |
          static_cast<uint32_t>(Quantized(mixed.green)) << 8 |
          static_cast<uint32_t>(Quantized(mixed.blue));
  std::memcpy(address, &pixel, sizeof(pixel));
  cairo_surface_mark_dirty_rectangle(surface, x, y, 1, 1);
}

void Picture::BlendPixels(
    const std::function<std::optional<Color>(int x, int y)>& color_of) {
  for (int y = 0; y < height(); ++y) {
    for (int x = 0; x < width(); ++x) {
      if (const std::optional<Color> color = color_of(x, y)) {
        BlendPixel(x, y, *color);
      }
    }
  }
}

void Picture::DrawPolyline(const std::vector<Eigen::Vector2d>& positions,
                           const double width, const Color& color) {
  cairo_new_path(context_.get());
  for (const Eigen::Vector2d& position : positions) {
    cairo_line_to(context_.get(), position.x(), position.y());
  }
  SetColor(context_.get(), color);
  cairo_set_line_width(context_.get(), width);
  cairo_stroke(context_.get());
}

void Picture::DrawRectangle(const Eigen::Vector2d& top_left,
                            const Eigen::Vector2d& size, const Color& fill) {
  SetColor(context_.get(), fill);
  cairo_rectangle(context_.get(), top_left.x(), top_left.y(), size.x(),
                  size.y());
  cairo_fill(context_.get());
}

void Picture::DrawCircle(const Eigen::Vector2d& centre, const double radius,
                         const Color& fill, const Color& outline) {
  cairo_new_path(context_.get());
  cairo_arc(context_.get(), centre.x(), centre.y(), radius, 0., 2. * M_PI);
  SetColor(context_.get(), fill);
  cairo_fill_preserve(context_.get());
  SetColor(context_.get(), outline);
  cairo_set_line_width(context_.get(), 1.);
  cairo_stroke(context_.get());
}

void Picture::DrawText(const Eigen::Vector2d& position, const std::string& text,
                       const double size, const Color& color,
                       const Anchor anchor) {
  cairo_set_font_size(context_.get(), size);
  cairo_text_extents_t extents;
  cairo_text_extents(context_.get(), text.c_str(), &extents);
  const double shift = anchor == Anchor::kCentre ? 0.5 * extents.x_advance : 0.;
  cairo_move_to(context_.get(), position.x() - shift, position.y());
  cairo_text_path(context_.get(), text.c_str());
  SetColor(context_.get(), Color{1., 1., 1., 0.8});
  cairo_set_line_width(context_.get(), 3.);
  cairo_stroke_preserve(context_.get());
  SetColor(context_.get(), color);
  cairo_fill(context_.get());
}

std::string Picture::EncodePng() const {
  std::string png;
  CHECK_EQ(cairo_surface_write_to_png_stream(cairo_get_target(context_.get()),
                                             AppendBytes, &png),
           CAIRO_STATUS_SUCCESS);
  return png;
}

Sheet MakeSheet(const Eigen::AlignedBox2d& bounds, const int max_pixels,
                const Color& background) {
  CHECK_GE(max_pixels, 1);
  CHECK(!bounds.isEmpty());
  const Eigen::Vector2d extent =
      bounds.sizes().cwiseMax(1e-3).cwiseMin(kMaxExtentMeters);
  const double pixels_per_meter = max_pixels / extent.maxCoeff();
  const auto num_pixels = [&](const double length) {
    return std::clamp(static_cast<int>(std::lround(length * pixels_per_meter)),
                      1, max_pixels);
  };
  return Sheet{
      Picture(num_pixels(extent.x()), num_pixels(extent.y()), background),
      PixelFrame{pixels_per_meter, {bounds.min().x(), bounds.max().y()}}};
}

}  // namespace cartographer_sdf
