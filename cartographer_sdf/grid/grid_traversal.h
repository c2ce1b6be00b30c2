// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Visits the cells that a line segment crosses, in order. [Amanatides1987], "A
// fast voxel traversal algorithm for ray tracing".

#ifndef CARTOGRAPHER_SDF_GRID_GRID_TRAVERSAL_H_
#define CARTOGRAPHER_SDF_GRID_GRID_TRAVERSAL_H_

#include <Eigen/Core>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace cartographer_sdf {

// Calls visit(i, j, t) for each cell from that of `begin` to that of `end`
// until `visit` returns false. Points are metres in the grid frame divided by
// the resolution: cell (i, j) is [i, i + 1) x [j, j + 1). The segment enters
// the cell at begin + t * (end - begin), t in [0, 1]. Consecutive cells share a
// side; a segment through a corner visits one of the two cells beside it.
template <typename Visitor>
void TraverseCells(const Eigen::Vector2d& begin, const Eigen::Vector2d& end,
                   const Visitor& visit) {
  const Eigen::Array2d direction = (end - begin).array();
  Eigen::Array2i cell = begin.array().floor().cast<int>();
  const Eigen::Array2i last = end.array().floor().cast<int>();
  Eigen::Array2i step;
  // t at the next crossing of a cell border, and between two crossings.
  Eigen::Array2d t_next, t_delta;
  for (int k = 0; k != 2; ++k) {
    step[k] = last[k] < cell[k] ? -1 : 1;
    if (last[k] == cell[k]) {
      t_next[k] = t_delta[k] = std::numeric_limits<double>::infinity();
      continue;
    }
    t_delta[k] = 1. / std::abs(direction[k]);
    const double border = cell[k] + (step[k] > 0 ? 1 : 0);
    t_next[k] = (border - begin[k]) / direction[k];
  }
  int remaining[2] = {std::abs(last[0] - cell[0]), std::abs(last[1] - cell[1])};
  double t = 0.;
  while (visit(cell[0], cell[1], t) && remaining[0] + remaining[1] > 0) {
    // Counting the remaining borders reaches the last cell despite rounding.
    const int k =
        remaining[1] == 0 || (remaining[0] != 0 && t_next[0] < t_next[1]) ? 0
                                                                          : 1;
    t = t_next[k];
    t_next[k] += t_delta[k];
    cell[k] += step[k];
    --remaining[k];
  }
}

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_GRID_GRID_TRAVERSAL_H_
