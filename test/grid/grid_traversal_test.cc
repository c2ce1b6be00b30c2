// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/grid/grid_traversal.h"

#include <algorithm>
#include <random>
#include <vector>

#include "gtest/gtest.h"
#include "test/testing/random_number.h"

namespace cartographer_sdf::grid_traversal_test {
namespace {

using Eigen::Array2i;
using Eigen::Vector2d;

constexpr double kRounding = 1e-9;

struct Visit {
  Array2i cell;
  double t;
};

std::vector<Visit> Traverse(const Vector2d& begin, const Vector2d& end) {
  std::vector<Visit> visits;
  TraverseCells(begin, end, [&](int i, int j, double t) {
    visits.push_back({Array2i(i, j), t});
    return true;
  });
  return visits;
}

// The part [t_in, t_out] of the segment within the closed cell; t_in > t_out
// where there is none.
std::pair<double, double> Clip(const Vector2d& begin, const Vector2d& end,
                               const Array2i& cell) {
  double t_in = 0., t_out = 1.;
  for (int k = 0; k != 2; ++k) {
    const double direction = end[k] - begin[k];
    double t0 = (cell[k] - begin[k]) / direction;
    double t1 = (cell[k] + 1 - begin[k]) / direction;
    if (t0 > t1) std::swap(t0, t1);
    t_in = std::max(t_in, t0);
    t_out = std::min(t_out, t1);
  }
  return {t_in, t_out};
}

TEST(GridTraversalTest, VisitsWhatTheSegmentCrossesInOrder) {
  std::mt19937 engine(42);
  const auto draw = [&engine] { return testing::Uniform(-8., 8., &engine); };
  for (int trial = 0; trial != 300; ++trial) {
    const Vector2d begin(draw(), draw());
    const Vector2d end(draw(), draw());
    const std::vector<Visit> visits = Traverse(begin, end);
    ASSERT_TRUE(
        (visits.front().cell == begin.array().floor().cast<int>()).all());
    ASSERT_TRUE((visits.back().cell == end.array().floor().cast<int>()).all());
    for (size_t k = 0; k != visits.size(); ++k) {
      const auto [t_in, t_out] = Clip(begin, end, visits[k].cell);
      EXPECT_LE(t_in, t_out + kRounding);
      EXPECT_NEAR(visits[k].t, t_in, kRounding);
      if (k == 0) continue;
      EXPECT_EQ((visits[k].cell - visits[k - 1].cell).abs().sum(), 1);
    }
    for (int j = -8; j != 8; ++j) {
      for (int i = -8; i != 8; ++i) {
        const auto [t_in, t_out] = Clip(begin, end, Array2i(i, j));
        if (t_out - t_in < kRounding) continue;
        EXPECT_EQ(std::count_if(visits.begin(), visits.end(),
                                [&](const Visit& visit) {
                                  return (visit.cell == Array2i(i, j)).all();
                                }),
                  1);
      }
    }
  }
}

TEST(GridTraversalTest, HandlesAxisParallelCornersAndPoints) {
  EXPECT_EQ(Traverse({0.5, 0.5}, {0.5, 0.5}).size(), 1u);
  EXPECT_EQ(Traverse({0.5, 0.5}, {-4.5, 0.5}).size(), 6u);
  EXPECT_EQ(Traverse({0.5, 0.5}, {0.5, 3.5}).size(), 4u);
  EXPECT_EQ(Traverse({0., 0.}, {3., 3.}).size(), 7u);
  EXPECT_EQ(Traverse({3., 3.}, {0., 0.}).size(), 7u);
  EXPECT_EQ(Traverse({2., 1.}, {5., 1.}).size(), 4u);
}

TEST(GridTraversalTest, StopsOnRequest) {
  int visited = 0;
  TraverseCells({0.5, 0.5}, {9.5, 0.5},
                [&](int i, int, double) { return ++visited, i < 3; });
  EXPECT_EQ(visited, 4);
}

}  // namespace
}  // namespace cartographer_sdf::grid_traversal_test
