// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Small plots as <svg> elements to be embedded in HTML. Axes and texts take the
// colour of the surrounding text, so that they are readable on light and dark.
// Points and values that are not finite are left out.

#ifndef CARTOGRAPHER_SDF_REPORT_SVG_PLOT_H_
#define CARTOGRAPHER_SDF_REPORT_SVG_PLOT_H_

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cartographer_sdf {

struct PlotAxis {
  std::string label;
  // Of all that is plotted, where it is not given.
  std::optional<std::pair<double, double>> range;
};

struct LineSeries {
  std::string name;
  std::vector<Eigen::Vector2d> points;
};

enum class LegendCorner { kTopRight, kBottomLeft };

struct LinePlot {
  std::string title;
  PlotAxis x;
  PlotAxis y;
  std::vector<LineSeries> series;
  LegendCorner legend = LegendCorner::kTopRight;
};

struct HistogramSeries {
  std::string name;
  std::vector<double> values;
};

struct HistogramPlot {
  std::string title;
  PlotAxis x;
  // Values below and above the range are counted in the first and last bin.
  std::vector<HistogramSeries> series;
  int num_bins = 30;
};

[[nodiscard]] std::string RenderLinePlot(const LinePlot& plot);
[[nodiscard]] std::string RenderHistogram(const HistogramPlot& plot);

// A plot as a file of its own, black on white.
[[nodiscard]] std::string StandaloneSvg(const std::string& plot);

// Counts of values in `num_bins` equal bins of [begin, end]; those outside are
// counted in the first and the last bin, NaN nowhere.
[[nodiscard]] std::vector<int> CountInBins(const std::vector<double>& values,
                                           double begin, double end,
                                           int num_bins);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_SVG_PLOT_H_
