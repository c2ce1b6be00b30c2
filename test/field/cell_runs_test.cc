// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/field/cell_runs.h"

#include <random>

#include "gtest/gtest.h"
#include "test/testing/random_number.h"

namespace cartographer_sdf::cell_runs_test {
namespace {

using Eigen::Index;

// The cells of the runs, which must lie in the grid, apart and in order.
BoolArray CellsOf(const CellRuns& runs, const Index rows, const Index cols) {
  BoolArray cells = BoolArray::Constant(rows, cols, false);
  for (Index j = 0; j < cols; ++j) {
    Index end = -1;
    for (const CellRun& run : runs.OfColumn(j)) {
      EXPECT_GT(run.begin, end);
      EXPECT_GT(run.end, run.begin);
      EXPECT_LE(run.end, rows);
      end = run.end;
      cells.col(j).segment(run.begin, run.end - run.begin) = true;
    }
  }
  return cells;
}

BoolArray Dilated(const BoolArray& cells, const Index reach_rows,
                  const Index reach_cols) {
  BoolArray dilated = BoolArray::Constant(cells.rows(), cells.cols(), false);
  for (Index j = 0; j < cells.cols(); ++j) {
    for (Index i = 0; i < cells.rows(); ++i) {
      if (!cells(i, j)) continue;
      const Index top = std::max<Index>(i - reach_rows, 0);
      const Index left = std::max<Index>(j - reach_cols, 0);
      const Index bottom = std::min(i + reach_rows + 1, cells.rows());
      const Index right = std::min(j + reach_cols + 1, cells.cols());
      dilated.block(top, left, bottom - top, right - left) = true;
    }
  }
  return dilated;
}

TEST(CellRunsTest, HasTheCellsNearTrueOnesAndNoneFarFromThem) {
  std::mt19937 engine(42);
  const Eigen::Array2i shapes[] = {{1, 1}, {7, 9}, {8, 8}, {61, 83}, {200, 3}};
  for (const Eigen::Array2i& shape : shapes) {
    for (const double density : {0., 0.001, 0.01, 1.}) {
      BoolArray cells(shape.x(), shape.y());
      for (Index k = 0; k < cells.size(); ++k) {
        cells(k) = testing::Uniform(0., 1., &engine) < density;
      }
      for (const Eigen::Array2i& reach :
           {Eigen::Array2i(0, 0), Eigen::Array2i(5, 1), Eigen::Array2i(3, 18),
            Eigen::Array2i(400, 400)}) {
        const BoolArray actual = CellsOf(
            CellRuns::Near(cells, reach.x(), reach.y()), shape.x(), shape.y());
        EXPECT_TRUE((actual || !Dilated(cells, reach.x(), reach.y())).all());
        // Blocks of 8 x 8 cells.
        EXPECT_TRUE(
            (!actual || Dilated(cells, reach.x() + 7, reach.y() + 14)).all());
      }
    }
  }
}

TEST(CellRunsTest, AllCells) {
  EXPECT_TRUE(CellsOf(CellRuns::All(5, 17), 5, 17).all());
}

}  // namespace
}  // namespace cartographer_sdf::cell_runs_test
