// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/report/markup.h"
#include "cartographer_sdf/report/picture.h"
#include "cartographer_sdf/report/round_step.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr double kWidth = 460.;
constexpr double kHeight = 280.;
constexpr double kLeft = 58.;
constexpr double kRight = 14.;
constexpr double kTop = 30.;
constexpr double kBottom = 44.;
constexpr int kNumTicks = 5;

// Beyond, differences overflow.
bool IsPlottable(const double value) { return std::abs(value) < 1e300; }

struct Range {
  double begin;
  double end;
};

class RangeFinder {
 public:
  void Add(const double value) {
    if (!IsPlottable(value)) return;
    begin_ = std::min(begin_, value);
    end_ = std::max(end_, value);
  }
  // The range of the axis or else of what was added; never empty.
  [[nodiscard]] Range Get(const PlotAxis& axis) const {
    return axis.range.has_value()
               ? NotEmpty({axis.range->first, axis.range->second})
               : Get();
  }
  [[nodiscard]] Range Get() const { return NotEmpty({begin_, end_}); }

 private:
  static Range NotEmpty(Range range) {
    if (!(range.begin <= range.end)) range = {0., 1.};
    const double least =
        1e-9 * std::max({1., std::abs(range.begin), std::abs(range.end)});
    if (range.end - range.begin < least) {
      range.end = range.begin + std::max(1., least);
    }
    return range;
  }

  double begin_ = std::numeric_limits<double>::infinity();
  double end_ = -std::numeric_limits<double>::infinity();
};

// The frame of a plot: what both kinds share.
class Axes {
 public:
  Axes(const Range& x, const Range& y) : x_(x), y_(y) {}

  [[nodiscard]] double PixelX(const double x) const {
    const double fraction = (x - x_.begin) / (x_.end - x_.begin);
    return kLeft + fraction * (kWidth - kLeft - kRight);
  }
  [[nodiscard]] double PixelY(const double y) const {
    const double fraction = (y - y_.begin) / (y_.end - y_.begin);
    return kHeight - kBottom - fraction * (kHeight - kTop - kBottom);
  }
  [[nodiscard]] std::string Render(const std::string& title,
                                   const std::string& x_label,
                                   const std::string& y_label) const;

 private:
  const Range x_;
  const Range y_;
};

std::string Text(const double x, const double y, const char* const anchor,
                 const std::string& text, const std::string& attributes = "") {
  return absl::StrFormat(
      "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" %s>%s</text>\n", x, y,
      anchor, attributes, EscapeMarkup(text));
}

std::string Line(const double x1, const double y1, const double x2,
                 const double y2, const double opacity) {
  return absl::StrFormat(
      "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" "
      "stroke=\"currentColor\" stroke-opacity=\"%g\"/>\n",
      x1, y1, x2, y2, opacity);
}

std::vector<double> Ticks(const Range& range) {
  const double step = RoundStep((range.end - range.begin) / kNumTicks);
  std::vector<double> ticks;
  const double first = std::ceil(range.begin / step - 1e-9);
  for (int i = 0; i <= 2 * kNumTicks; ++i) {
    const double tick = (first + i) * step;
    if (tick > range.end + 1e-9 * step) break;
    // Adding zero takes the sign from zero.
    ticks.push_back(tick + 0.);
  }
  return ticks;
}

std::string Axes::Render(const std::string& title, const std::string& x_label,
                         const std::string& y_label) const {
  const double bottom = kHeight - kBottom;
  const double right = kWidth - kRight;
  std::string svg = Text(kLeft, 16., "start", title, "font-weight=\"bold\"");
  for (const double tick : Ticks(x_)) {
    svg += Line(PixelX(tick), bottom, PixelX(tick), bottom + 4., 0.8);
    svg += Text(PixelX(tick), bottom + 16., "middle",
                absl::StrFormat("%.6g", tick));
  }
  for (const double tick : Ticks(y_)) {
    svg += Line(kLeft, PixelY(tick), right, PixelY(tick), 0.15);
    svg += Text(kLeft - 6., PixelY(tick) + 4., "end",
                absl::StrFormat("%.6g", tick));
  }
  svg += Line(kLeft, bottom, right, bottom, 0.8);
  svg += Line(kLeft, kTop, kLeft, bottom, 0.8);
  svg += Text(0.5 * (kLeft + right), kHeight - 8., "middle", x_label);
  svg += Text(0., 0., "middle", y_label,
              absl::StrFormat("transform=\"translate(13 %.1f) rotate(-90)\"",
                              0.5 * (kTop + bottom)));
  return svg;
}

std::string ColorName(const size_t series) {
  const Color color = CategoryColor(static_cast<int>(series));
  const auto byte = [](const double value) {
    return static_cast<int>(std::lround(255. * value));
  };
  return absl::StrFormat("#%02x%02x%02x", byte(color.red), byte(color.green),
                         byte(color.blue));
}

std::string Legend(const std::vector<std::string>& names,
                   const LegendCorner corner = LegendCorner::kTopRight) {
  constexpr double kLine = 15.;
  const bool is_right = corner == LegendCorner::kTopRight;
  const double first = is_right
                           ? kTop + 12.
                           : kHeight - kBottom - 8. -
                                 kLine * static_cast<double>(names.size() - 1);
  std::string svg;
  for (size_t i = 0; i < names.size(); ++i) {
    const double y = first + kLine * static_cast<double>(i);
    absl::StrAppendFormat(&svg,
                          "<rect x=\"%.1f\" y=\"%.1f\" width=\"10\" "
                          "height=\"10\" fill=\"%s\"/>\n",
                          is_right ? kWidth - kRight - 12. : kLeft + 6., y - 9.,
                          ColorName(i));
    svg += is_right ? Text(kWidth - kRight - 18., y, "end", names[i])
                    : Text(kLeft + 22., y, "start", names[i]);
  }
  return svg;
}

// The nested <svg> clips what lies outside of given ranges.
std::string Document(const std::string& title, const std::string& axes,
                     const std::string& content, const std::string& legend) {
  return absl::StrFormat(
      "<svg class=\"plot\" role=\"img\" aria-label=\"%s\" "
      "viewBox=\"0 0 %g %g\" font-size=\"11\" fill=\"currentColor\">\n%s"
      "<svg x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\" "
      "viewBox=\"%g %g %g %g\">\n%s</svg>\n%s</svg>\n",
      EscapeMarkup(title), kWidth, kHeight, axes, kLeft, kTop,
      kWidth - kLeft - kRight, kHeight - kTop - kBottom, kLeft, kTop,
      kWidth - kLeft - kRight, kHeight - kTop - kBottom, content, legend);
}

}  // namespace

std::vector<int> CountInBins(const std::vector<double>& values,
                             const double begin, const double end,
                             const int num_bins) {
  CHECK_GT(num_bins, 0);
  CHECK_LT(begin, end);
  std::vector<int> counts(static_cast<size_t>(num_bins), 0);
  for (const double value : values) {
    if (std::isnan(value)) continue;
    const double bin = std::floor((value - begin) / (end - begin) * num_bins);
    ++counts[static_cast<size_t>(std::clamp(bin, 0., num_bins - 1.))];
  }
  return counts;
}

std::string RenderLinePlot(const LinePlot& plot) {
  RangeFinder x_range;
  RangeFinder y_range;
  for (const LineSeries& series : plot.series) {
    for (const Eigen::Vector2d& point : series.points) {
      if (!IsPlottable(point.x()) || !IsPlottable(point.y())) continue;
      x_range.Add(point.x());
      y_range.Add(point.y());
    }
  }
  const Axes axes(x_range.Get(plot.x), y_range.Get(plot.y));
  std::string content;
  std::vector<std::string> names;
  for (const LineSeries& series : plot.series) {
    std::string points;
    for (const Eigen::Vector2d& point : series.points) {
      if (!IsPlottable(point.x()) || !IsPlottable(point.y())) continue;
      absl::StrAppendFormat(&points, "%.2f,%.2f ", axes.PixelX(point.x()),
                            axes.PixelY(point.y()));
    }
    absl::StrAppendFormat(&content,
                          "<polyline points=\"%s\" fill=\"none\" "
                          "stroke=\"%s\" stroke-width=\"1.8\"/>\n",
                          points, ColorName(names.size()));
    names.push_back(series.name);
  }
  return Document(plot.title,
                  axes.Render(plot.title, plot.x.label, plot.y.label), content,
                  Legend(names, plot.legend));
}

std::string StandaloneSvg(const std::string& plot) {
  constexpr absl::string_view kBegin = "<svg ";
  CHECK(absl::StartsWith(plot, kBegin));
  return absl::StrFormat(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%g\" height=\"%g\" "
      "font-family=\"sans-serif\" color=\"black\" "
      "style=\"background: white\">\n"
      "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n"
      "%s</svg>\n",
      kWidth, kHeight, plot);
}

std::string RenderHistogram(const HistogramPlot& plot) {
  RangeFinder x_range;
  for (const HistogramSeries& series : plot.series) {
    for (const double value : series.values) x_range.Add(value);
  }
  const Range x = x_range.Get(plot.x);
  std::vector<std::vector<int>> counts;
  RangeFinder y_range;
  y_range.Add(0.);
  for (const HistogramSeries& series : plot.series) {
    counts.push_back(CountInBins(series.values, x.begin, x.end, plot.num_bins));
    for (const int count : counts.back()) y_range.Add(count);
  }
  const Axes axes(x, y_range.Get());
  std::string content;
  std::vector<std::string> names;
  for (size_t i = 0; i < counts.size(); ++i) {
    std::string points =
        absl::StrFormat("%.2f,%.2f ", axes.PixelX(x.begin), axes.PixelY(0.));
    for (int bin = 0; bin < plot.num_bins; ++bin) {
      const double y = axes.PixelY(counts[i][static_cast<size_t>(bin)]);
      const double width = (x.end - x.begin) / plot.num_bins;
      absl::StrAppendFormat(&points, "%.2f,%.2f %.2f,%.2f ",
                            axes.PixelX(x.begin + bin * width), y,
                            axes.PixelX(x.begin + (bin + 1) * width), y);
    }
    absl::StrAppendFormat(&points, "%.2f,%.2f", axes.PixelX(x.end),
                          axes.PixelY(0.));
    absl::StrAppendFormat(&content,
                          "<polygon points=\"%s\" fill=\"%s\" "
                          "fill-opacity=\"0.3\" stroke=\"%s\"/>\n",
                          points, ColorName(i), ColorName(i));
    names.push_back(plot.series[i].name);
  }
  return Document(plot.title, axes.Render(plot.title, plot.x.label, "count"),
                  content, Legend(names));
}

}  // namespace cartographer_sdf
