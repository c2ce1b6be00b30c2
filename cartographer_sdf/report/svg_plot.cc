// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "cartographer_sdf/report/picture.h"
#include "cartographer_sdf/report/text.h"
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

// Beyond it, differences overflow.
bool IsPlottable(const double value) { return std::abs(value) < 1e300; }

struct Range {
  double begin;
  double end;
};

// The range of the axis, or else of all values that can be plotted; never
// empty.
Range RangeOf(const PlotAxis& axis, const std::vector<double>& values) {
  Range range{std::numeric_limits<double>::infinity(),
              -std::numeric_limits<double>::infinity()};
  for (const double value : values) {
    if (!IsPlottable(value)) continue;
    range = {std::min(range.begin, value), std::max(range.end, value)};
  }
  if (axis.range) range = {axis.range->first, axis.range->second};
  if (!(range.begin <= range.end)) range = {0., 1.};
  const double least =
      1e-9 * std::max({1., std::abs(range.begin), std::abs(range.end)});
  if (range.end - range.begin < least) {
    range.end = range.begin + std::max(1., least);
  }
  return range;
}

// The frame of a plot.
struct Axes {
  Range x;
  Range y;

  [[nodiscard]] double PixelX(const double value) const {
    const double fraction = (value - x.begin) / (x.end - x.begin);
    return kLeft + fraction * (kWidth - kLeft - kRight);
  }
  [[nodiscard]] double PixelY(const double value) const {
    const double fraction = (value - y.begin) / (y.end - y.begin);
    return kHeight - kBottom - fraction * (kHeight - kTop - kBottom);
  }
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
    // Adding zero turns -0 into 0.
    ticks.push_back(tick + 0.);
  }
  return ticks;
}

std::string RenderAxes(const Axes& axes, const LinePlot& plot) {
  const double bottom = kHeight - kBottom;
  const double right = kWidth - kRight;
  std::string svg =
      Text(kLeft, 16., "start", plot.title, "font-weight=\"bold\"");
  for (const double tick : Ticks(axes.x)) {
    svg += Line(axes.PixelX(tick), bottom, axes.PixelX(tick), bottom + 4., 0.8);
    svg += Text(axes.PixelX(tick), bottom + 16., "middle",
                absl::StrFormat("%.6g", tick));
  }
  for (const double tick : Ticks(axes.y)) {
    svg += Line(kLeft, axes.PixelY(tick), right, axes.PixelY(tick), 0.15);
    svg += Text(kLeft - 6., axes.PixelY(tick) + 4., "end",
                absl::StrFormat("%.6g", tick));
  }
  svg += Line(kLeft, bottom, right, bottom, 0.8);
  svg += Line(kLeft, kTop, kLeft, bottom, 0.8);
  svg += Text(0.5 * (kLeft + right), kHeight - 8., "middle", plot.x.label);
  svg += Text(0., 0., "middle", plot.y.label,
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
                   const LegendCorner corner) {
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

// The nested <svg> clips at the given ranges. Filled series are closed.
std::string Render(const LinePlot& plot, const bool is_filled) {
  std::vector<double> xs, ys;
  for (const LineSeries& series : plot.series) {
    for (const Eigen::Vector2d& point : series.points) {
      if (!IsPlottable(point.x()) || !IsPlottable(point.y())) continue;
      xs.push_back(point.x());
      ys.push_back(point.y());
    }
  }
  const Axes axes{RangeOf(plot.x, xs), RangeOf(plot.y, ys)};
  std::string content;
  std::vector<std::string> names;
  for (const LineSeries& series : plot.series) {
    std::vector<std::string> points;
    for (const Eigen::Vector2d& point : series.points) {
      if (!IsPlottable(point.x()) || !IsPlottable(point.y())) continue;
      points.push_back(absl::StrFormat("%.2f,%.2f", axes.PixelX(point.x()),
                                       axes.PixelY(point.y())));
    }
    const std::string color = ColorName(names.size());
    absl::StrAppend(&content, is_filled ? "<polygon" : "<polyline",
                    " points=\"", absl::StrJoin(points, " "), "\" fill=\"",
                    is_filled ? color + "\" fill-opacity=\"0.3" : "none",
                    "\" stroke=\"", color,
                    is_filled ? "" : "\" stroke-width=\"1.8", "\"/>\n");
    names.push_back(series.name);
  }
  return absl::StrFormat(
      "<svg class=\"plot\" role=\"img\" aria-label=\"%s\" "
      "viewBox=\"0 0 %g %g\" font-size=\"11\" fill=\"currentColor\">\n%s"
      "<svg x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\" "
      "viewBox=\"%g %g %g %g\">\n%s</svg>\n%s</svg>\n",
      EscapeMarkup(plot.title), kWidth, kHeight, RenderAxes(axes, plot), kLeft,
      kTop, kWidth - kLeft - kRight, kHeight - kTop - kBottom, kLeft, kTop,
      kWidth - kLeft - kRight, kHeight - kTop - kBottom, content,
      Legend(names, plot.legend));
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
  return Render(plot, /*is_filled=*/false);
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
  std::vector<double> values;
  for (const HistogramSeries& series : plot.series) {
    values.insert(values.end(), series.values.begin(), series.values.end());
  }
  const Range x = RangeOf(plot.x, values);
  const double width = (x.end - x.begin) / plot.num_bins;
  LinePlot outlines{
      plot.title, {plot.x.label, {{x.begin, x.end}}}, {"count", {}}, {}};
  for (const HistogramSeries& series : plot.series) {
    LineSeries outline{series.name, {{x.begin, 0.}}};
    const std::vector<int> counts =
        CountInBins(series.values, x.begin, x.end, plot.num_bins);
    for (int bin = 0; bin < plot.num_bins; ++bin) {
      const double count = counts[static_cast<size_t>(bin)];
      outline.points.emplace_back(x.begin + bin * width, count);
      outline.points.emplace_back(x.begin + (bin + 1) * width, count);
    }
    outline.points.emplace_back(x.end, 0.);
    outlines.series.push_back(std::move(outline));
  }
  return Render(outlines, /*is_filled=*/true);
}

}  // namespace cartographer_sdf
