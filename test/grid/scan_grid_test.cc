// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/grid/scan_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "cartographer_sdf/grid/grid_traversal.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::scan_grid_test {
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

void ExpectSame(const OccupancyGrid& a, const OccupancyGrid& b) {
  ASSERT_TRUE((a.geometry.size == b.geometry.size).all());
  EXPECT_EQ(a.geometry.T_submap_grid.translation(),
            b.geometry.T_submap_grid.translation());
  EXPECT_TRUE((a.known == b.known).all());
  EXPECT_TRUE((a.probability == b.probability).all());
}

TEST(ScanGridTest, OneBeam) {
  const OccupancyGrid grid = DrawScans(
      {}, {{Rigid2(0.02, 0.02, M_PI / 2.), {{Vector2f(1.02f, 0.02f)}, {}}}});
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

TEST(ScanGridTest, EachScanCountsOnceAndHitsComeFirst) {
  // The second and third beams end in the same cell as the first; the last
  // passes through it, and so does one without an echo.
  const Scan scan{{Vector2f(1.02f, 0.f), Vector2f(1.03f, 0.f),
                   Vector2f(1.04f, 0.f), Vector2f(2.02f, 0.f)},
                  {Vector2f(1.5f, 0.f)}};
  for (const int times : {1, 2, 5, 10}) {
    const OccupancyGrid grid = DrawScans(
        {}, std::vector<PlacedScan>(times, {Rigid2(0.025, 0.025, 0.), scan}));
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

TEST(ScanGridTest, ProbabilitiesAreClamped) {
  const OccupancyGrid grid = DrawScans(
      {}, std::vector<PlacedScan>(
              200, {Rigid2(0.02, 0.02, 0.), {{Vector2f(1.f, 0.f)}, {}}}));
  EXPECT_NEAR(grid.probability.maxCoeff(), 0.9f, kRounding);
  EXPECT_NEAR(grid.probability.minCoeff(), 0.1f, kRounding);
}

TEST(ScanGridTest, BeamsWithoutAnEchoClearAsFarAsTheyAreBelieved) {
  ScanGridOptions options;
  options.empty_beam_length = 3.;
  for (const auto& [end, first_cell] :
       {std::make_pair(-20.f, -2.975), std::make_pair(-1.f, -0.975)}) {
    const OccupancyGrid grid = DrawScans(
        options, {{Rigid2(0.02, 0.02, 0.), {{}, {Vector2f(end, 0.f)}}}});
    EXPECT_NEAR(grid.geometry.CellCentre({0, 0}).x(), first_cell, 1e-9);
    EXPECT_EQ(grid.geometry.size.y(), 1);
    EXPECT_TRUE(grid.known.all());
    EXPECT_NEAR(grid.probability.maxCoeff(), 0.49f, kRounding);
  }
}

// A sensor in a room whose inside is [-4, 4] x [-3, 3].
Scan ScanOfARoom(const Rigid2& T_room_sensor) {
  Scan scan;
  for (int k = 0; k != 360; ++k) {
    const double angle = 2. * M_PI * (k + 0.5) / 360.;
    const Vector2d beam(std::cos(angle), std::sin(angle));
    const Vector2d direction = T_room_sensor.RotationMatrix() * beam;
    double range = 100.;
    for (const int axis : {0, 1}) {
      const double wall = std::copysign(axis == 0 ? 4. : 3., direction[axis]);
      range = std::min(
          range, (wall - T_room_sensor.translation()[axis]) / direction[axis]);
    }
    scan.returns.push_back((range * beam).cast<float>());
  }
  return scan;
}

// Poses in the submap frame, which lies somehow in the room.
const Rigid2 kRoomSubmap(0.3, -0.2, 0.4);  // T_room_submap
std::vector<PlacedScan> ScansOfARoom() {
  std::vector<PlacedScan> scans;
  for (int k = 0; k != 30; ++k) {
    const Rigid2 T_submap_sensor(0.05 * k - 1., 0.02 * k, 0.3 * k);
    scans.push_back(
        {T_submap_sensor, ScanOfARoom(kRoomSubmap * T_submap_sensor)});
  }
  return scans;
}

TEST(ScanGridTest, WallsOfARoomLieWithinACellOfTheTruth) {
  const OccupancyGrid grid = DrawScans({}, ScansOfARoom());
  int num_walls = 0;
  for (int j = 0; j != grid.geometry.size.y(); ++j) {
    for (int i = 0; i != grid.geometry.size.x(); ++i) {
      const Vector2d p_room = kRoomSubmap * grid.geometry.CellCentre({i, j});
      // Positive inside.
      const double to_wall =
          std::min(4. - std::abs(p_room.x()), 3. - std::abs(p_room.y()));
      // A cell whose corner touches the wall.
      const double tolerance = 0.05 * std::sqrt(0.5) + kRounding;
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

// Cells of one scan at a time, kept by the test.
std::map<std::pair<int, int>, Cell> DrawCellByCell(
    const std::vector<PlacedScan>& scans) {
  std::map<std::pair<int, int>, double> log_odds;
  for (const PlacedScan& placed : scans) {
    std::map<std::pair<int, int>, double> changes;
    const Vector2d begin = placed.T_submap_sensor.translation() / 0.05;
    for (const bool is_hit : {true, false}) {
      for (const Vector2f& point : placed.scan.returns) {
        const Vector2d end =
            placed.T_submap_sensor * Vector2d(point.cast<double>()) / 0.05;
        TraverseCells(is_hit ? end : begin, end, [&](int i, int j, double) {
          const double p = is_hit ? 0.55 : 0.49;
          changes.insert({{i, j}, std::log(p / (1. - p))});
          return true;
        });
      }
    }
    for (const auto& [cell, change] : changes) log_odds[cell] += change;
  }
  std::map<std::pair<int, int>, Cell> cells;
  for (const auto& [cell, l] : log_odds) {
    cells[cell] = {true, std::clamp(1. / (1. + std::exp(-l)), 0.1, 0.9)};
  }
  return cells;
}

// The grid grows many times on this way, in all directions; too few scans see
// a cell for the order of clamping to matter.
TEST(ScanGridTest, GrowthEqualsBuildingAtOnce) {
  std::mt19937 random(42);
  std::vector<PlacedScan> scans;
  for (int k = 0; k != 40; ++k) {
    const double radius = 0.5 * k;
    Scan scan;
    for (int b = 0; b != 20; ++b) {
      scan.returns.emplace_back(static_cast<float>(random() % 1000) / 200.f,
                                static_cast<float>(random() % 1000) / 300.f);
    }
    scans.push_back({Rigid2(radius * std::cos(2.4 * k),
                            radius * std::sin(2.4 * k), 1.1 * k),
                     scan});
  }
  const OccupancyGrid grid = DrawScans({}, scans);
  const auto cells = DrawCellByCell(scans);
  EXPECT_EQ(grid.known.count(), static_cast<int>(cells.size()));
  for (const auto& [cell, expected] : cells) {
    const Cell actual =
        CellAt(grid, 0.05 * Vector2d(cell.first + 0.5, cell.second + 0.5));
    ASSERT_TRUE(actual.known);
    EXPECT_NEAR(actual.probability, expected.probability, kRounding);
  }
}

TEST(ScanGridTest, IsDeterministicAndTakesScansOneByOne) {
  const std::vector<PlacedScan> scans = ScansOfARoom();
  ScanGrid grid((ScanGridOptions()));
  for (const PlacedScan& placed : scans) {
    EXPECT_TRUE(grid.Insert(placed.T_submap_sensor, placed.scan));
    // Cropping is no end.
    EXPECT_TRUE(grid.Crop().known.any());
  }
  ExpectSame(grid.Crop(), DrawScans({}, scans));
}

TEST(ScanGridTest, CropsToKnownCellsWhereverTheyAre) {
  const OccupancyGrid grid =
      DrawScans({}, {{Rigid2(-7.28, 11.22, 0.),
                      {{Vector2f(1.f, 0.3f), Vector2f(0.4f, -0.7f)}, {}}}});
  EXPECT_TRUE(grid.known.row(0).any());
  EXPECT_TRUE(grid.known.row(grid.known.rows() - 1).any());
  EXPECT_TRUE(grid.known.col(0).any());
  EXPECT_TRUE(grid.known.col(grid.known.cols() - 1).any());
  EXPECT_GT(CellAt(grid, {-6.28, 11.52}).probability, 0.5);
  EXPECT_GT(CellAt(grid, {-6.88, 10.52}).probability, 0.5);
}

TEST(ScanGridTest, NothingSeenIsOneUnknownCell) {
  for (const std::vector<PlacedScan>& scans :
       {std::vector<PlacedScan>(), {PlacedScan()}}) {
    const OccupancyGrid grid = DrawScans({}, scans);
    EXPECT_EQ(grid.known.size(), 1);
    EXPECT_FALSE(grid.known(0, 0));
  }
}

// Of what is absurd, only what is not shall change anything.
TEST(ScanGridTest, LeavesOutPointsThatAreTooFarOrNoNumbers) {
  const float nan = std::nanf("");
  const float infinity = std::numeric_limits<float>::infinity();
  ScanGridOptions options;
  options.max_range = 8.;
  Scan scan{{Vector2f(1.f, 0.3f)}, {Vector2f(-1.f, 0.f)}};
  const OccupancyGrid grid = DrawScans(options, {{Rigid2(), scan}});
  for (const float x : {8.1f, 1e30f, infinity, -infinity, nan}) {
    scan.returns.emplace_back(x, 1.f);
    scan.returns.emplace_back(1.f, x);
  }
  for (const float x : {infinity, nan}) scan.misses.emplace_back(x, 1.f);
  ExpectSame(DrawScans(options, {{Rigid2(), scan}}), grid);
  // A direction is all that is used of a beam without an echo.
  scan.misses.emplace_back(3e38f, 0.f);
  EXPECT_NEAR(DrawScans(options, {{Rigid2(), scan}}).geometry.size.x(), 120, 1);
}

TEST(ScanGridTest, RefusesPosesThatWouldNeedTooMuchMemory) {
  const Scan scan{{Vector2f(1.f, 0.3f)}, {}};
  ScanGrid grid((ScanGridOptions()));
  // A long grid may be larger than a square one.
  EXPECT_TRUE(grid.Insert(Rigid2(), scan));
  EXPECT_TRUE(grid.Insert(Rigid2(1000., 0., 0.), scan));
  const OccupancyGrid before = grid.Crop();
  const double nan = std::nan("");
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double x : {1e5, -1e5, 4e7, -4e7, 1e9, 1e300, infinity, nan}) {
    EXPECT_FALSE(grid.Insert(Rigid2(x, x, 0.), scan)) << x;
    EXPECT_FALSE(grid.Insert(Rigid2(1., -x, 0.), scan)) << x;
  }
  EXPECT_FALSE(grid.Insert(Rigid2(1., 1., nan), scan));
  ExpectSame(grid.Crop(), before);
  // A first scan may be anywhere where cells have numbers.
  EXPECT_GT(DrawScans({}, {{Rigid2(4e7, -4e7, 0.), scan}}).known.count(), 20);
}

TEST(ScanGridTest, ValidatesOptions) {
  EXPECT_EQ(Validate(ScanGridOptions{}), "");
  for (double ScanGridOptions::*const field :
       {&ScanGridOptions::resolution, &ScanGridOptions::hit_probability,
        &ScanGridOptions::miss_probability, &ScanGridOptions::empty_beam_length,
        &ScanGridOptions::max_range}) {
    for (const double invalid : {-1., 1e9, std::nan("")}) {
      ScanGridOptions options;
      options.*field = invalid;
      EXPECT_NE(Validate(options), "") << invalid;
    }
  }
}

}  // namespace
}  // namespace cartographer_sdf::scan_grid_test
