// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Small plots as <svg> elements for embedding in HTML. Axes and texts take the
// colour of the surrounding text, so that they are readable on light and dark
// backgrounds. Points and values that are not finite are left out.

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
  // By default, the range of all plotted values.
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
  // Values below and above the range count in the first and last bin.
  std::vector<HistogramSeries> series;
  int num_bins = 30;
};

[[nodiscard]] std::string RenderLinePlot(const LinePlot& plot);
[[nodiscard]] std::string RenderHistogram(const HistogramPlot& plot);

// A plot as a stand-alone file, black on white.
[[nodiscard]] std::string StandaloneSvg(const std::string& plot);

// Counts values in `num_bins` equal bins of [begin, end]. Values outside count
// in the first or last bin, NaN in none.
[[nodiscard]] std::vector<int> CountInBins(const std::vector<double>& values,
                                           double begin, double end,
                                           int num_bins);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_SVG_PLOT_H_
