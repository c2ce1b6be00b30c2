// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A picture in memory, to be drawn upon and written as PNG. Pixel (0, 0) is at
// the top left; the centre of pixel (i, j) lies at (i + 0.5, j + 0.5).

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

// Well distinguishable colours, also by the colour-blind; they repeat.
[[nodiscard]] Color CategoryColor(int category);

// For ticks and scale bars: the least 1, 2 or 5 times a power of ten that is
// not less than `step` > 0.
[[nodiscard]] double RoundStep(double step);

// Where the points of a frame lie in a picture: its x axis to the right, its y
// axis up.
struct PixelFrame {
  double pixels_per_meter = 1.;
  // Of the top left corner of the picture [m].
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

  // Sizes are at least 1 and at most 16384.
  Picture(int width, int height, const Color& background);

  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;

  // Outside of the picture nothing happens.
  void BlendPixel(int x, int y, const Color& color);
  // Blends each pixel with its colour; those without one stay.
  void BlendPixels(
      const std::function<std::optional<Color>(int x, int y)>& color_of);

  // Positions are in pixels.
  void DrawPolyline(const std::vector<Eigen::Vector2d>& positions, double width,
                    const Color& color);
  void DrawRectangle(const Eigen::Vector2d& top_left,
                     const Eigen::Vector2d& size, const Color& fill);
  void DrawCircle(const Eigen::Vector2d& centre, double radius,
                  const Color& fill, const Color& outline);
  // `position` is on the baseline; with a halo that makes it readable on
  // anything.
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

// Of `bounds` [m], with the longer side at `max_pixels`.
[[nodiscard]] Sheet MakeSheet(const Eigen::AlignedBox2d& bounds, int max_pixels,
                              const Color& background);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_PICTURE_H_
