// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/path_planner.h"

#include <algorithm>
#include <cmath>

#include "cartographer_sdf/simulation/random_numbers.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::path_planner_test {
namespace {

using Eigen::Array2i;
using Eigen::Vector2d;

TEST(PathPlannerTest, ClearanceAgreesWithBruteForce) {
  for (const double resolution : {0.1, 0.05}) {
    FloorPlan plan = EmptyFloorPlan({4., 3.}, resolution);
    RandomNumbers random(42);
    for (int k = 0; k != 6; ++k) {
      FillDisc({random.Uniform(0., 4.), random.Uniform(0., 3.)}, 0.12, &plan);
    }
    const NavigationGrid grid = MakeNavigationGrid(plan, 0.3);
    // Where two plan cells share a navigation cell, its centre is half the
    // diagonal of a plan cell away from the next centre of one.
    const double tolerance =
        resolution == 0.1 ? 1e-5 : resolution * std::sqrt(0.5) + 1e-5;
    for (int j = 0; j != grid.geometry.size.y(); ++j) {
      for (int i = 0; i != grid.geometry.size.x(); ++i) {
        const Vector2d p = grid.geometry.CellCentre({i, j});
        double nearest = NavigationGrid::kMaxClearance;
        for (int y = -1; y <= plan.geometry.size.y(); ++y) {
          for (int x = -1; x <= plan.geometry.size.x(); ++x) {
            const Array2i cell(x, y);
            if (plan.geometry.Contains(cell) && !plan.occupied(x, y)) continue;
            nearest =
                std::min(nearest, (plan.geometry.CellCentre(cell) - p).norm());
          }
        }
        ASSERT_NEAR(grid.clearance(i, j), nearest, tolerance)
            << i << ", " << j << " at " << resolution;
        if (grid.reachable(i, j)) {
          ASSERT_GE(grid.clearance(i, j), 0.3f);
        }
      }
    }
  }
}

// Two rooms of 4 m x 4 m and 2 m x 4 m, and a door of 1.2 m between them.
FloorPlan TwoRooms(const bool has_door) {
  FloorPlan plan = EmptyFloorPlan({6.2, 4.}, 0.1);
  FillRectangle({4.1, 2.}, {0.2, 4.}, 0., true, &plan);
  if (has_door) FillRectangle({4.1, 3.}, {0.2, 1.2}, 0., false, &plan);
  return plan;
}

TEST(PathPlannerTest, KeepsTheLargestComponentOnly) {
  const NavigationGrid closed = MakeNavigationGrid(TwoRooms(false), 0.4);
  EXPECT_TRUE(closed.reachable(20, 20));
  EXPECT_FALSE(closed.reachable(52, 20));
  const NavigationGrid open = MakeNavigationGrid(TwoRooms(true), 0.4);
  EXPECT_TRUE(open.reachable(20, 20));
  EXPECT_TRUE(open.reachable(52, 20));
  // Too narrow for a larger robot.
  EXPECT_FALSE(MakeNavigationGrid(TwoRooms(true), 0.7).reachable(52, 20));
}

TEST(PathPlannerTest, CostInTheOpenIsTheOctileDistance) {
  const FloorPlan plan = EmptyFloorPlan({8., 8.}, 0.1);
  const NavigationGrid grid = MakeNavigationGrid(plan, 0.4);
  const ShortestPaths paths = FindShortestPaths(grid, 40 + 80 * 40);
  for (int j = 12; j != 68; ++j) {
    for (int i = 12; i != 68; ++i) {
      const int dx = std::abs(i - 40), dy = std::abs(j - 40);
      const double octile =
          0.1 * (std::max(dx, dy) + (std::sqrt(2.) - 1.) * std::min(dx, dy));
      ASSERT_NEAR(paths.cost[i + 80 * j], octile, 1e-4);
    }
  }
}

TEST(PathPlannerTest, CostsAreConsistentAndPathsLeadThroughDoors) {
  const NavigationGrid grid = MakeNavigationGrid(TwoRooms(true), 0.4);
  const int width = grid.geometry.size.x();
  const ShortestPaths paths = FindShortestPaths(grid, 10 + width * 8);
  for (int k = 0; k != static_cast<int>(paths.cost.size()); ++k) {
    ASSERT_EQ(std::isfinite(paths.cost[k]), grid.reachable(k));
    ASSERT_EQ(paths.parent[k] >= 0, grid.reachable(k));
    if (!grid.reachable(k) || paths.parent[k] == k) continue;
    ASSERT_LT(paths.cost[paths.parent[k]], paths.cost[k]);
    // No neighbour offers a cheaper way at the least cost there is per metre.
    for (const int step : {1, -1, width, -width}) {
      ASSERT_LE(paths.cost[k], paths.cost[k + step] + 3.f * 0.1f);
    }
  }
  const std::vector<Vector2d> path =
      SmoothPath(grid, paths, 54 + width * 10, /*min_clearance=*/0.4);
  EXPECT_EQ(path.front(), grid.geometry.CellCentre({10, 8}));
  EXPECT_EQ(path.back(), grid.geometry.CellCentre({54, 10}));
  bool crosses_door = false;
  for (size_t k = 0; k != path.size(); ++k) {
    const Array2i cell = grid.geometry.CellAt(path[k]);
    EXPECT_GE(grid.clearance(cell.x(), cell.y()), 0.4f - 1e-5f);
    crosses_door |=
        std::abs(path[k].x() - 4.1) < 0.1 && std::abs(path[k].y() - 3.) < 0.6;
    if (k != 0) {
      EXPECT_LT((path[k] - path[k - 1]).norm(), 0.2);
    }
  }
  EXPECT_TRUE(crosses_door);
}

TEST(PathPlannerTest, NoRoomIsNoReachableCell) {
  EXPECT_EQ(MakeNavigationGrid(EmptyFloorPlan({0.5, 0.5}, 0.05), 0.4)
                .reachable.count(),
            0);
}

}  // namespace
}  // namespace cartographer_sdf::path_planner_test
