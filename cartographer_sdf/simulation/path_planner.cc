// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/path_planner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "cartographer_sdf/field/distance_transform.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr double kNavigationResolution = 0.1;  // [m]

constexpr std::array<std::array<int, 2>, 8> kNeighbours = {
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

// Calls visit(flat index, is_diagonal) for the neighbours inside the grid.
template <typename Visitor>
void VisitNeighbours(const Eigen::Array2i& size, const int cell,
                     const Visitor& visit) {
  const int x = cell % size.x(), y = cell / size.x();
  for (const std::array<int, 2>& offset : kNeighbours) {
    const int i = x + offset[0], j = y + offset[1];
    if (i < 0 || j < 0 || i >= size.x() || j >= size.y()) continue;
    visit(i + size.x() * j, offset[0] != 0 && offset[1] != 0);
  }
}

// Clearance at the resolution of the plan. Cells outside the plan are occupied.
Eigen::ArrayXXf ComputeClearance(const FloorPlan& plan) {
  const Eigen::Index width = plan.occupied.rows();
  const Eigen::Index height = plan.occupied.cols();
  BoolArray occupied = BoolArray::Constant(width + 2, height + 2, true);
  occupied.block(1, 1, width, height) = plan.occupied;
  const double resolution = plan.geometry.resolution;
  const auto reach =
      static_cast<float>(NavigationGrid::kMaxClearance / resolution);
  const Eigen::ArrayXXf squared = SquaredDistanceTransform(occupied)
                                      .block(1, 1, width, height)
                                      .cast<float>()
                                      .min(reach * reach);
  return squared.sqrt() * static_cast<float>(resolution);
}

// Keeps only the largest connected set; the first one on ties.
void KeepLargestComponent(BoolArray* const cells) {
  const Eigen::Array2i size(cells->rows(), cells->cols());
  std::vector<int> component(cells->size(), -1);
  std::vector<int> largest;
  for (int seed = 0; seed != cells->size(); ++seed) {
    if (!(*cells)(seed) || component[seed] >= 0) continue;
    std::vector<int> members = {seed};
    component[seed] = seed;
    for (size_t k = 0; k != members.size(); ++k) {
      VisitNeighbours(size, members[k], [&](const int cell, bool) {
        if (!(*cells)(cell) || component[cell] >= 0) return;
        component[cell] = seed;
        members.push_back(cell);
      });
    }
    if (members.size() > largest.size()) largest = std::move(members);
  }
  cells->setConstant(false);
  for (const int cell : largest) (*cells)(cell) = true;
}

double ClearanceAt(const NavigationGrid& grid, const Eigen::Vector2d& point) {
  const Eigen::Array2i cell = grid.geometry.CellAt(point);
  return grid.geometry.Contains(cell) ? grid.clearance(cell.x(), cell.y()) : 0.;
}

}  // namespace

NavigationGrid MakeNavigationGrid(const FloorPlan& plan,
                                  const double min_clearance) {
  const Eigen::ArrayXXf clearance = ComputeClearance(plan);
  const int factor =
      std::max(1, static_cast<int>(std::lround(kNavigationResolution /
                                               plan.geometry.resolution)));
  NavigationGrid grid;
  grid.geometry.resolution = factor * plan.geometry.resolution;
  grid.geometry.size = (plan.geometry.size / factor).max(1);
  grid.clearance.resize(grid.geometry.size.x(), grid.geometry.size.y());
  for (int j = 0; j != grid.geometry.size.y(); ++j) {
    for (int i = 0; i != grid.geometry.size.x(); ++i) {
      const Eigen::Array2i cell =
          plan.geometry.CellAt(grid.geometry.CellCentre({i, j}))
              .min(plan.geometry.size - 1);
      grid.clearance(i, j) = clearance(cell.x(), cell.y());
    }
  }
  grid.reachable = grid.clearance >= static_cast<float>(min_clearance);
  KeepLargestComponent(&grid.reachable);
  return grid;
}

ShortestPaths FindShortestPaths(const NavigationGrid& grid, const int source) {
  CHECK(grid.reachable(source));
  const Eigen::Array2i size = grid.geometry.size;
  const int num_cells = size.prod();
  ShortestPaths paths;
  paths.cost.assign(num_cells, std::numeric_limits<float>::infinity());
  paths.parent.assign(num_cells, -1);
  // Ties are broken by the index of the cell.
  using Entry = std::pair<float, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  paths.cost[source] = 0.f;
  paths.parent[source] = source;
  queue.push({0.f, source});
  const float resolution = static_cast<float>(grid.geometry.resolution);
  while (!queue.empty()) {
    const auto [cost, cell] = queue.top();
    queue.pop();
    if (cost > paths.cost[cell]) continue;
    VisitNeighbours(
        size, cell,
        [&, cost = cost, cell = cell](const int next, const bool is_diagonal) {
          if (!grid.reachable(next)) return;
          const float crowding =
              1.f - grid.clearance(next) /
                        static_cast<float>(NavigationGrid::kMaxClearance);
          const float step = resolution * (is_diagonal ? 1.41421356f : 1.f) *
                             (1.f + 2.f * crowding);
          if (cost + step < paths.cost[next]) {
            paths.cost[next] = cost + step;
            paths.parent[next] = cell;
            queue.push({cost + step, next});
          }
        });
  }
  return paths;
}

std::vector<Eigen::Vector2d> SmoothPath(const NavigationGrid& grid,
                                        const ShortestPaths& paths,
                                        const int target,
                                        const double min_clearance) {
  CHECK_GE(paths.parent[target], 0);
  const int stride = grid.geometry.size.x();
  int cell = target;
  std::vector<Eigen::Vector2d> path;
  while (true) {
    path.push_back(grid.geometry.CellCentre({cell % stride, cell / stride}));
    if (paths.parent[cell] == cell) break;
    cell = paths.parent[cell];
  }
  std::reverse(path.begin(), path.end());
  // Smooths over about the square root of this number in cells, half a metre.
  constexpr int kIterations = 30;
  for (int iteration = 0; iteration != kIterations; ++iteration) {
    for (size_t k = 1; k + 1 < path.size(); ++k) {
      const Eigen::Vector2d smoother =
          0.25 * path[k - 1] + 0.5 * path[k] + 0.25 * path[k + 1];
      if (ClearanceAt(grid, smoother) >= min_clearance) path[k] = smoother;
    }
  }
  return path;
}

}  // namespace cartographer_sdf
