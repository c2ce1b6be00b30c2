// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/svg_plot.h"

#include <limits>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/markup_reader.h"

namespace cartographer_sdf::svg_plot_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(CountInBinsTest, CountsEachValueOnce) {
  EXPECT_THAT(CountInBins({0., 0.24, 0.25, 0.99, 1.}, 0., 1., 4),
              ElementsAre(2, 1, 0, 2));
  EXPECT_THAT(CountInBins({-5., kNan, kInfinity, -kInfinity, 0.5}, 0., 1., 2),
              ElementsAre(2, 2));
}

TEST(LinePlotTest, PutsPointsWhereTheyBelong) {
  LinePlot plot;
  plot.title = "precision < recall";
  plot.x = {"recall", {{0., 1.}}};
  plot.y = {"precision & more", {{0., 1.}}};
  plot.series = {{"a", {{0., 0.}, {0.5, 0.5}, {1., 1.}}}};
  const std::string svg = RenderLinePlot(plot);
  EXPECT_EQ(MarkupError(svg), "");
  // The area of the plot is from 58 to 446, and from 30 (above) to 236.
  EXPECT_THAT(svg, AllOf(HasSubstr("58.00,236.00 252.00,133.00 446.00,30.00"),
                         HasSubstr("precision &lt; recall"),
                         HasSubstr("precision &amp; more"), HasSubstr(">0.2<"),
                         HasSubstr(">0.8<")));
  EXPECT_THAT(svg, Not(HasSubstr("://")));
}

TEST(LinePlotTest, SurvivesDegenerateData) {
  LinePlot plot;
  EXPECT_EQ(MarkupError(RenderLinePlot(plot)), "");
  plot.series = {{"empty", {}},
                 {"one", {{3., 4.}}},
                 {"bad", {{kNan, 1.}, {1., kInfinity}, {1e308, -1e308}}}};
  const std::string svg = RenderLinePlot(plot);
  EXPECT_EQ(MarkupError(svg), "");
  EXPECT_THAT(svg, AllOf(Not(HasSubstr("nan")), Not(HasSubstr("inf"))));
  plot.series = {{"wide", {{-9e299, -9e299}, {9e299, 9e299}}},
                 {"point", {{1e200, 1e-200}}}};
  const std::string wide = RenderLinePlot(plot);
  EXPECT_THAT(wide, AllOf(Not(HasSubstr("nan")), Not(HasSubstr("inf"))));
}

TEST(HistogramTest, DrawsCounts) {
  HistogramPlot plot;
  plot.title = "residuals";
  plot.x = {"m", {{0., 2.}}};
  plot.num_bins = 2;
  plot.series = {{"before", {0.5, 1.5, 1.6, 1.7, 99.}}, {"after", {0.1}}};
  const std::string svg = RenderHistogram(plot);
  EXPECT_EQ(MarkupError(svg), "");
  // 1 and 4 of 4; then 1 and 0.
  EXPECT_THAT(svg, AllOf(HasSubstr("58.00,236.00 58.00,184.50 252.00,184.50 "
                                   "252.00,30.00 446.00,30.00 446.00,236.00"),
                         HasSubstr("58.00,236.00 58.00,184.50 252.00,184.50 "
                                   "252.00,236.00 446.00,236.00 446.00,236.00"),
                         HasSubstr("before"), HasSubstr("after")));
}

TEST(HistogramTest, SurvivesDegenerateData) {
  HistogramPlot plot;
  EXPECT_EQ(MarkupError(RenderHistogram(plot)), "");
  plot.series = {{"x", {kNan, kInfinity}}, {"y", {5., 5., 5.}}};
  const std::string svg = RenderHistogram(plot);
  EXPECT_EQ(MarkupError(svg), "");
  EXPECT_THAT(svg, AllOf(Not(HasSubstr("nan")), Not(HasSubstr("inf"))));
}

}  // namespace
}  // namespace cartographer_sdf::svg_plot_test
