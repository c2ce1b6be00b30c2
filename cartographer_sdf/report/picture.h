// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A picture in memory that can be drawn on and encoded as PNG. Pixel (0, 0) is
// at the top left; the centre of pixel (i, j) lies at (i + 0.5, j + 0.5).

#ifndef CARTOGRAPHER_SDF_REPORT_PICTURE_H_
#define CARTOGRAPHER_SDF_REPORT_PICTURE_H_

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct _cairo;

namespace cartographer_sdf {

// Each in [0, 1].
struct Color {
  double red = 0.;
  double green = 0.;
  double blue = 0.;
  double alpha = 1.;
};

constexpr Color kWhite{1., 1., 1.};
constexpr Color kBlack{0., 0., 0.};

[[nodiscard]] Color Mix(const Color& a, const Color& b, double fraction_of_b);

// Colours that are easy to distinguish, also with colour blindness, and that
// stand out from white by a contrast of at least 3 (WCAG 2.1, 1.4.11); they
// repeat.
[[nodiscard]] Color CategoryColor(int category);

// For ticks and scale bars: the smallest 1, 2 or 5 times a power of ten that is
// at least `step` > 0.
[[nodiscard]] double RoundStep(double step);

// Maps points of a frame to a picture, with the frame's x axis to the right and
// its y axis up.
struct PixelFrame {
  double pixels_per_meter = 1.;
  // The picture's top left corner in the frame [m].
  Eigen::Vector2d top_left = Eigen::Vector2d::Zero();

  [[nodiscard]] Eigen::Vector2d ToPixels(const Eigen::Vector2d& p) const {
    return pixels_per_meter *
           Eigen::Vector2d(p.x() - top_left.x(), top_left.y() - p.y());
  }
  // The point at the centre of a pixel.
  [[nodiscard]] Eigen::Vector2d CentreOf(const int x, const int y) const {
    return top_left + Eigen::Vector2d(x + 0.5, -(y + 0.5)) / pixels_per_meter;
  }
};

class Picture {
 public:
  enum class Anchor { kLeft, kCentre };

  // Both sizes must be from 1 to 16384.
  Picture(int width, int height, const Color& background);

  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;

  // Ignores positions outside the picture.
  void BlendPixel(int x, int y, const Color& color);
  // Blends each pixel with its colour; leaves pixels without one unchanged.
  void BlendPixels(
      const std::function<std::optional<Color>(int x, int y)>& color_of);

  // Positions are in pixels.
  void DrawPolyline(const std::vector<Eigen::Vector2d>& positions, double width,
                    const Color& color);
  void DrawRectangle(const Eigen::Vector2d& top_left,
                     const Eigen::Vector2d& size, const Color& fill);
  void DrawCircle(const Eigen::Vector2d& centre, double radius,
                  const Color& fill, const Color& outline);
  // `position` is on the baseline. A halo keeps the text readable on any
  // background.
  void DrawText(const Eigen::Vector2d& position, const std::string& text,
                double size, const Color& color, Anchor anchor);

  [[nodiscard]] std::string EncodePng() const;

 private:
  std::unique_ptr<_cairo, void (*)(_cairo*)> context_;
};

// A picture of a part of a plane.
struct Sheet {
  Picture picture;
  PixelFrame frame;
};

// A sheet of `bounds` [m], whose longer side has `max_pixels` pixels.
[[nodiscard]] Sheet MakeSheet(const Eigen::AlignedBox2d& bounds, int max_pixels,
                              const Color& background);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_PICTURE_H_
