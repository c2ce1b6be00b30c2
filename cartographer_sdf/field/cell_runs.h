// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The part of a grid that is worth the work: nine of ten cells of a large
// submap were never observed.

#ifndef CARTOGRAPHER_SDF_FIELD_CELL_RUNS_H_
#define CARTOGRAPHER_SDF_FIELD_CELL_RUNS_H_

#include <Eigen/Core>
#include <vector>

#include "cartographer_sdf/grid/occupancy_grid.h"

namespace cartographer_sdf {

// Rows [begin, end) of a column.
struct CellRun {
  Eigen::Index begin, end;
};

// A set of cells, as runs along columns: those of each in order, apart from
// each other. Columns come in groups of 8, which have the same runs.
class CellRuns {
 public:
  // Returns a set that has every cell at most `reach_rows` rows and
  // `reach_cols` columns away from a true one, and others near by.
  [[nodiscard]] static CellRuns Near(const BoolArray& cells,
                                     Eigen::Index reach_rows,
                                     Eigen::Index reach_cols);
  // Returns the set of all cells of a grid.
  [[nodiscard]] static CellRuns All(Eigen::Index rows, Eigen::Index cols);

  [[nodiscard]] const std::vector<CellRun>& OfColumn(
      const Eigen::Index j) const {
    return groups_[j / kBlockSize];
  }

 private:
  static constexpr Eigen::Index kBlockSize = 8;

  // For each square of this size whether one of its cells is true.
  [[nodiscard]] static BoolArray BlocksWithTrue(const BoolArray& cells);

  std::vector<std::vector<CellRun>> groups_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_FIELD_CELL_RUNS_H_
