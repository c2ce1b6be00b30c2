// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/submap_grid.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_sdf {
namespace {

using Eigen::Array2i;
using Eigen::Vector2d;
using Eigen::Vector2f;

// Single precision of a probability.
constexpr double kRounding = 1e-6;

// Probability after so many updates with these odds each, from even odds.
double Repeated(const double probability, const int times) {
  const double odds = std::pow(probability / (1. - probability), times);
  return odds / (1. + odds);
}

struct Cell {
  bool known = false;
  double probability = 0.;
};

Cell CellAt(const OccupancyGrid& grid, const Vector2d& p_submap) {
  const Array2i cell = grid.geometry.CellAt(p_submap);
  if (!grid.geometry.Contains(cell)) return {};
  return {grid.known(cell.x(), cell.y()), grid.probability(cell.x(), cell.y())};
}

TEST(SubmapGridTest, OneBeam) {
  Scan scan;
  scan.returns = {Vector2f(1.02f, 0.02f)};
  const OccupancyGrid grid =
      BuildSubmapGrid({{Rigid2(0.02, 0.02, M_PI / 2.), &scan}}, {});
  // From (0.02, 0.02) to (0, 1.04) in the submap frame, cropped.
  EXPECT_EQ(grid.geometry.size.x(), 1);
  EXPECT_EQ(grid.geometry.size.y(), 21);
  EXPECT_TRUE(grid.known.all());
  EXPECT_EQ(grid.geometry.T_submap_grid.rotation(), 0.);
  EXPECT_NEAR(grid.geometry.T_submap_grid.translation().norm(), 0., 1e-9);
  for (int j = 0; j != 20; ++j) {
    EXPECT_NEAR(grid.probability(0, j), 0.49, kRounding);
  }
  EXPECT_NEAR(grid.probability(0, 20), 0.55, kRounding);
}

TEST(SubmapGridTest, EachScanCountsOnceAndHitsComeFirst) {
  Scan scan;
  // The second and third beams end in the same cell as the first; the last
  // passes through it.
  scan.returns = {Vector2f(1.02f, 0.f), Vector2f(1.03f, 0.f),
                  Vector2f(1.04f, 0.f), Vector2f(2.02f, 0.f)};
  for (const int times : {1, 2, 5, 10}) {
    const std::vector<PosedScan> scans(times,
                                       {Rigid2(0.025, 0.025, 0.), &scan});
    const OccupancyGrid grid = BuildSubmapGrid(scans, {});
    EXPECT_NEAR(CellAt(grid, {1.045, 0.025}).probability, Repeated(0.55, times),
                kRounding);
    EXPECT_NEAR(CellAt(grid, {2.045, 0.025}).probability, Repeated(0.55, times),
                kRounding);
    EXPECT_NEAR(CellAt(grid, {0.5, 0.025}).probability, Repeated(0.49, times),
                kRounding);
    EXPECT_NEAR(CellAt(grid, {1.5, 0.025}).probability, Repeated(0.49, times),
                kRounding);
    EXPECT_FALSE(CellAt(grid, {0.5, 0.075}).known);
  }
}

TEST(SubmapGridTest, ProbabilitiesAreClamped) {
  Scan scan;
  scan.returns = {Vector2f(1.f, 0.f)};
  const std::vector<PosedScan> scans(200, {Rigid2(0.02, 0.02, 0.), &scan});
  const OccupancyGrid grid = BuildSubmapGrid(scans, {});
  EXPECT_NEAR(grid.probability.maxCoeff(), 0.9f, kRounding);
  EXPECT_NEAR(grid.probability.minCoeff(), 0.1f, kRounding);
}

TEST(SubmapGridTest, EmptyBeamsClearWithoutHits) {
  Scan scan;
  scan.empty_beams = {Vector2f(-1.f, 0.f)};
  SubmapGridOptions options;
  options.empty_beam_length = 3.;
  const OccupancyGrid grid =
      BuildSubmapGrid({{Rigid2(0.02, 0.02, 0.), &scan}}, options);
  EXPECT_EQ(grid.geometry.size.x(), 61);
  EXPECT_NEAR(grid.geometry.CellCentre({0, 0}).x(), -2.975, 1e-9);
  EXPECT_NEAR(grid.probability.maxCoeff(), 0.49f, kRounding);
}

// The inside is [0, 8] x [0, 6] in the world.
TEST(SubmapGridTest, WallsOfARoomLieWithinACellOfTheTruth) {
  FloorPlan room = EmptyFloorPlan({10., 8.}, 0.025);
  FillRectangle({5., 4.}, {12., 12.}, 0., true, &room);
  FillRectangle({5., 4.}, {8., 6.}, 0., false, &room);
  const Rigid2 T_world_submap(5., 4., 0.4);
  RandomNumbers random(42);
  std::vector<Scan> scans;
  std::vector<PosedScan> posed;
  scans.reserve(30);
  LidarOptions lidar;
  lidar.range_noise = 0.01;
  for (int k = 0; k != 30; ++k) {
    const Rigid2 T_submap_robot(0.05 * k - 1., 0.02 * k, 0.3 * k);
    scans.push_back(
        TakeScan(room, {}, T_world_submap * T_submap_robot, lidar, &random));
    posed.push_back({T_submap_robot, &scans.back()});
  }
  const OccupancyGrid grid = BuildSubmapGrid(posed, {});
  int num_walls = 0;
  for (int j = 0; j != grid.geometry.size.y(); ++j) {
    for (int i = 0; i != grid.geometry.size.x(); ++i) {
      const Vector2d p_world =
          T_world_submap * grid.geometry.CellCentre({i, j});
      // Positive inside.
      const double to_wall = std::min(4. - std::abs(p_world.x() - 5.),
                                      3. - std::abs(p_world.y() - 4.));
      // A cell whose corner touches the wall, and three sigmas of noise.
      const double tolerance = 0.05 * std::sqrt(0.5) + 0.03;
      if (grid.known(i, j) && grid.probability(i, j) > 0.5f) {
        ++num_walls;
        EXPECT_NEAR(to_wall, 0., tolerance);
      }
      if (to_wall > tolerance) {
        EXPECT_TRUE(grid.known(i, j));
        EXPECT_LT(grid.probability(i, j), 0.5f);
      }
    }
  }
  // The outline is 28 m long: a closed line of cells has at least one in each
  // column or row of it.
  EXPECT_GT(num_walls, 28. / 0.05 / std::sqrt(2.));
  EXPECT_LT(num_walls, 3. * 28. / 0.05);
}

TEST(SubmapGridTest, CropsToKnownCellsWhereverTheyAre) {
  Scan scan;
  scan.returns = {Vector2f(1.f, 0.3f), Vector2f(0.4f, -0.7f)};
  const OccupancyGrid grid =
      BuildSubmapGrid({{Rigid2(-7.28, 11.22, 0.), &scan}}, {});
  EXPECT_TRUE(grid.known.row(0).any());
  EXPECT_TRUE(grid.known.row(grid.known.rows() - 1).any());
  EXPECT_TRUE(grid.known.col(0).any());
  EXPECT_TRUE(grid.known.col(grid.known.cols() - 1).any());
  EXPECT_GT(CellAt(grid, {-6.28, 11.52}).probability, 0.5);
  EXPECT_GT(CellAt(grid, {-6.88, 10.52}).probability, 0.5);
}

TEST(SubmapGridTest, NothingSeenIsOneUnknownCell) {
  const Scan scan;
  const OccupancyGrid grid = BuildSubmapGrid({{Rigid2(), &scan}}, {});
  EXPECT_EQ(grid.known.size(), 1);
  EXPECT_FALSE(grid.known(0, 0));
}

TEST(SubmapGridTest, ValidatesOptions) {
  EXPECT_EQ(Validate(SubmapGridOptions{}), "");
  for (double SubmapGridOptions::*const field :
       {&SubmapGridOptions::resolution, &SubmapGridOptions::hit_probability,
        &SubmapGridOptions::miss_probability,
        &SubmapGridOptions::empty_beam_length}) {
    for (const double invalid : {-1., 1e9, std::nan("")}) {
      SubmapGridOptions options;
      options.*field = invalid;
      EXPECT_NE(Validate(options), "") << invalid;
    }
  }
}

}  // namespace
}  // namespace cartographer_sdf
