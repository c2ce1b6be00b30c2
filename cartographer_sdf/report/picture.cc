// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/picture.h"

#include <cairo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "cartographer_sdf/file/whole_file.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr int kMaxSize = 16384;

double Quantized(const double value) {
  return std::floor(255. * std::clamp(value, 0., 1.) + 0.5);
}

cairo_status_t AppendBytes(void* const output, const unsigned char* const bytes,
                           const unsigned int size) {
  static_cast<std::string*>(output)->append(
      reinterpret_cast<const char*>(bytes), size);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

struct Picture::Canvas {
  cairo_surface_t* surface = nullptr;
  cairo_t* context = nullptr;

  ~Canvas() {
    cairo_destroy(context);
    cairo_surface_destroy(surface);
  }
  void SetColor(const Color& color) const {
    cairo_set_source_rgba(context, color.red, color.green, color.blue,
                          color.alpha);
  }
};

Color Mix(const Color& a, const Color& b, const double fraction_of_b) {
  const auto mix = [fraction_of_b](const double x, const double y) {
    return x + fraction_of_b * (y - x);
  };
  return Color{mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue),
               mix(a.alpha, b.alpha)};
}

Color CategoryColor(const int category) {
  // Okabe and Ito, "Color universal design", 2008, without black and yellow.
  static constexpr std::array<Color, 6> kColors = {{{0.00, 0.45, 0.70, 1.},
                                                    {0.84, 0.37, 0.00, 1.},
                                                    {0.00, 0.62, 0.45, 1.},
                                                    {0.80, 0.47, 0.65, 1.},
                                                    {0.90, 0.62, 0.00, 1.},
                                                    {0.34, 0.71, 0.91, 1.}}};
  const int n = static_cast<int>(kColors.size());
  return kColors[static_cast<size_t>(((category % n) + n) % n)];
}

Picture::Picture(const int width, const int height, const Color& background)
    : canvas_(std::make_unique<Canvas>()) {
  CHECK(width >= 1 && width <= kMaxSize) << width;
  CHECK(height >= 1 && height <= kMaxSize) << height;
  canvas_->surface =
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
  canvas_->context = cairo_create(canvas_->surface);
  CHECK_EQ(cairo_status(canvas_->context), CAIRO_STATUS_SUCCESS);
  canvas_->SetColor(background);
  cairo_paint(canvas_->context);
  cairo_set_line_join(canvas_->context, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(canvas_->context, CAIRO_LINE_CAP_ROUND);
  cairo_select_font_face(canvas_->context, "sans-serif",
                         CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
}

Picture::Picture(Picture&&) noexcept = default;
Picture& Picture::operator=(Picture&&) noexcept = default;
Picture::~Picture() = default;

int Picture::width() const {
  return cairo_image_surface_get_width(canvas_->surface);
}

int Picture::height() const {
  return cairo_image_surface_get_height(canvas_->surface);
}

void Picture::BlendPixel(const int x, const int y, const Color& color) {
  if (x < 0 || y < 0 || x >= width() || y >= height()) return;
  cairo_surface_flush(canvas_->surface);
  unsigned char* const address =
      cairo_image_surface_get_data(canvas_->surface) +
      y * cairo_image_surface_get_stride(canvas_->surface) + 4 * x;
  uint32_t pixel;
  std::memcpy(&pixel, address, sizeof(pixel));
  const Color old{((pixel >> 16) & 255) / 255., ((pixel >> 8) & 255) / 255.,
                  (pixel & 255) / 255., 1.};
  const Color mixed = Mix(old, color, std::clamp(color.alpha, 0., 1.));
  pixel = static_cast<uint32_t>(Quantized(mixed.red)) << 16 |
          static_cast<uint32_t>(Quantized(mixed.green)) << 8 |
          static_cast<uint32_t>(Quantized(mixed.blue));
  std::memcpy(address, &pixel, sizeof(pixel));
  cairo_surface_mark_dirty_rectangle(canvas_->surface, x, y, 1, 1);
}

void Picture::DrawPolyline(const std::vector<Eigen::Vector2d>& positions,
                           const double width, const Color& color) {
  cairo_new_path(canvas_->context);
  for (const Eigen::Vector2d& position : positions) {
    cairo_line_to(canvas_->context, position.x(), position.y());
  }
  canvas_->SetColor(color);
  cairo_set_line_width(canvas_->context, width);
  cairo_stroke(canvas_->context);
}

void Picture::DrawRectangle(const Eigen::Vector2d& top_left,
                            const Eigen::Vector2d& size, const Color& fill) {
  canvas_->SetColor(fill);
  cairo_rectangle(canvas_->context, top_left.x(), top_left.y(), size.x(),
                  size.y());
  cairo_fill(canvas_->context);
}

void Picture::DrawCircle(const Eigen::Vector2d& centre, const double radius,
                         const Color& fill, const Color& outline) {
  cairo_new_path(canvas_->context);
  cairo_arc(canvas_->context, centre.x(), centre.y(), radius, 0., 2. * M_PI);
  canvas_->SetColor(fill);
  cairo_fill_preserve(canvas_->context);
  canvas_->SetColor(outline);
  cairo_set_line_width(canvas_->context, 1.);
  cairo_stroke(canvas_->context);
}

void Picture::DrawText(const Eigen::Vector2d& position, const std::string& text,
                       const double size, const Color& color,
                       const Anchor anchor) {
  cairo_set_font_size(canvas_->context, size);
  cairo_text_extents_t extents;
  cairo_text_extents(canvas_->context, text.c_str(), &extents);
  const double shift = anchor == Anchor::kLeft     ? 0.
                       : anchor == Anchor::kCentre ? 0.5 * extents.x_advance
                                                   : extents.x_advance;
  cairo_move_to(canvas_->context, position.x() - shift, position.y());
  cairo_text_path(canvas_->context, text.c_str());
  canvas_->SetColor(Color{1., 1., 1., 0.8});
  cairo_set_line_width(canvas_->context, 3.);
  cairo_stroke_preserve(canvas_->context);
  canvas_->SetColor(color);
  cairo_fill(canvas_->context);
}

std::string Picture::EncodePng() const {
  std::string png;
  CHECK_EQ(
      cairo_surface_write_to_png_stream(canvas_->surface, AppendBytes, &png),
      CAIRO_STATUS_SUCCESS);
  return png;
}

absl::Status Picture::WritePng(const std::string& path) const {
  return WriteWholeFile(path, EncodePng());
}

}  // namespace cartographer_sdf
