// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/field/cell_runs.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace cartographer_sdf {
namespace {

using Eigen::Index;

// Cells at most `reach` columns away from a true one.
BoolArray Widened(const BoolArray& cells, const Index reach) {
  BoolArray widened = cells;
  for (Index k = 1; k <= std::min(reach, cells.cols() - 1); ++k) {
    const Index cols = cells.cols() - k;
    widened.leftCols(cols) = widened.leftCols(cols) || cells.rightCols(cols);
    widened.rightCols(cols) = widened.rightCols(cols) || cells.leftCols(cols);
  }
  return widened;
}

}  // namespace

BoolArray CellRuns::BlocksWithTrue(const BoolArray& cells) {
  const Index rows = cells.rows(), cols = cells.cols();
  BoolArray blocks((rows + kBlockSize - 1) / kBlockSize,
                   (cols + kBlockSize - 1) / kBlockSize);
  std::vector<uint8_t> any(blocks.rows() * kBlockSize);
  for (Index group = 0; group < blocks.cols(); ++group) {
    std::fill(any.begin(), any.end(), uint8_t{0});
    const Index end = std::min((group + 1) * kBlockSize, cols);
    for (Index j = group * kBlockSize; j < end; ++j) {
      const bool* const column = &cells(0, j);
      for (Index i = 0; i < rows; ++i) any[i] |= column[i];
    }
    for (Index b = 0; b < blocks.rows(); ++b) {
      uint64_t bytes;
      static_assert(sizeof(bytes) == kBlockSize);
      std::memcpy(&bytes, &any[b * kBlockSize], kBlockSize);
      blocks(b, group) = bytes != 0;
    }
  }
  return blocks;
}

CellRuns CellRuns::Near(const BoolArray& cells, const Index reach_rows,
                        const Index reach_cols) {
  const BoolArray blocks = Widened(BlocksWithTrue(cells),
                                   (reach_cols + kBlockSize - 1) / kBlockSize);
  CellRuns result;
  result.groups_.resize(blocks.cols());
  for (Index group = 0; group < blocks.cols(); ++group) {
    std::vector<CellRun>& runs = result.groups_[group];
    for (Index b = 0; b < blocks.rows(); ++b) {
      if (!blocks(b, group)) continue;
      const Index begin = std::max<Index>(b * kBlockSize - reach_rows, 0);
      const Index end =
          std::min((b + 1) * kBlockSize + reach_rows, cells.rows());
      if (runs.empty() || begin > runs.back().end) {
        runs.push_back({begin, end});
      } else {
        runs.back().end = end;
      }
    }
  }
  return result;
}

CellRuns CellRuns::All(const Index rows, const Index cols) {
  CellRuns result;
  result.groups_.assign((cols + kBlockSize - 1) / kBlockSize, {{0, rows}});
  return result;
}

}  // namespace cartographer_sdf
