// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/grid_conversion.h"

#include <cmath>
#include <limits>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::grid_conversion_test {
namespace {

using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Of values from 0.1 to 0.9 in 32766 steps, computed in single precision.
constexpr double kProbabilityTolerance = 1e-6;
constexpr double kMetres = 1e-12;

// Three cells along -y (fast), two along -x (slow), as the host has them:
//   x = 1.75: y = 0.75, 0.25, -0.25
//   x = 1.25: y = 0.75, 0.25, -0.25
proto::Grid2D HandMadeGrid() {
  proto::Grid2D grid;
  grid.mutable_limits()->set_resolution(0.5);
  grid.mutable_limits()->mutable_max()->set_x(2.);
  grid.mutable_limits()->mutable_max()->set_y(1.);
  grid.mutable_limits()->mutable_cell_limits()->set_num_x_cells(3);
  grid.mutable_limits()->mutable_cell_limits()->set_num_y_cells(2);
  for (const int value : {1, 0, 32767, 16384, 8001, 0}) grid.add_cells(value);
  grid.mutable_probability_grid_2d();
  grid.set_min_correspondence_cost(0.1f);
  grid.set_max_correspondence_cost(0.9f);
  return grid;
}

struct Cell {
  double x;
  double y;
  // Negative: unknown.
  double probability;
};

void ExpectCells(const OccupancyGrid& grid, const std::vector<Cell>& cells) {
  for (const Cell& cell : cells) {
    const Eigen::Vector2d p_submap(cell.x, cell.y);
    const Eigen::Array2i index = grid.geometry.CellAt(p_submap);
    ASSERT_TRUE(grid.geometry.Contains(index)) << p_submap.transpose();
    EXPECT_LE((grid.geometry.CellCentre(index) - p_submap).norm(), kMetres);
    EXPECT_EQ(grid.known(index.x(), index.y()), cell.probability >= 0.);
    if (cell.probability >= 0.) {
      EXPECT_NEAR(grid.probability(index.x(), index.y()), cell.probability,
                  kProbabilityTolerance)
          << p_submap.transpose();
    }
  }
}

TEST(GridConversionTest, CellsLandWhereTheyMust) {
  const absl::StatusOr<OccupancyGrid> grid =
      MakeOccupancyGrid(HandMadeGrid(), Rigid2(1.5, 0.25, 0.));
  ASSERT_TRUE(grid.ok()) << grid.status();
  EXPECT_EQ(grid->geometry.resolution, 0.5);
  EXPECT_TRUE((grid->geometry.size == Eigen::Array2i(2, 3)).all());
  EXPECT_EQ(grid->known.count(), 4);
  ExpectCells(*grid, {{0.25, 0.5, 0.9},
                      {0.25, 0., -1.},
                      {0.25, -0.5, 0.1},
                      {-0.25, 0.5, 0.5},
                      // 0.9 - 0.8 * 8000 / 32766
                      {-0.25, 0., 0.704675578},
                      {-0.25, -0.5, -1.}});
}

TEST(GridConversionTest, CellsLandWhereTheyMustInATurnedSubmap) {
  // p_submap = (p_local.y - 0.25, 1.5 - p_local.x)
  const absl::StatusOr<OccupancyGrid> grid =
      MakeOccupancyGrid(HandMadeGrid(), Rigid2(1.5, 0.25, M_PI / 2.));
  ASSERT_TRUE(grid.ok()) << grid.status();
  ExpectCells(*grid, {{0.5, -0.25, 0.9},
                      {0., -0.25, -1.},
                      {-0.5, -0.25, 0.1},
                      {0.5, 0.25, 0.5},
                      {0., 0.25, 0.704675578},
                      {-0.5, 0.25, -1.}});
}

TEST(GridConversionTest, GridOfOldFilesHasDefaultBounds) {
  proto::Grid2D stored = HandMadeGrid();
  stored.set_min_correspondence_cost(0.f);
  stored.set_max_correspondence_cost(0.f);
  const absl::StatusOr<OccupancyGrid> grid =
      MakeOccupancyGrid(stored, Rigid2(1.5, 0.25, 0.));
  ASSERT_TRUE(grid.ok());
  ExpectCells(*grid, {{0.25, 0.5, 0.9}, {0.25, -0.5, 0.1}});
}

TEST(GridConversionTest, OtherBounds) {
  proto::Grid2D stored = HandMadeGrid();
  stored.set_min_correspondence_cost(0.2f);
  stored.set_max_correspondence_cost(0.6f);
  const absl::StatusOr<OccupancyGrid> grid =
      MakeOccupancyGrid(stored, Rigid2(1.5, 0.25, 0.));
  ASSERT_TRUE(grid.ok());
  ExpectCells(*grid, {{0.25, 0.5, 0.8}, {0.25, -0.5, 0.4}, {-0.25, 0.5, 0.6}});
}

TEST(GridConversionTest, ThereAndBack) {
  for (const Rigid2& T_local_submap :
       {Rigid2(), Rigid2(1.5, 0.25, 0.), Rigid2(-7., 3., 1.)}) {
    const proto::Grid2D stored = HandMadeGrid();
    const absl::StatusOr<OccupancyGrid> grid =
        MakeOccupancyGrid(stored, T_local_submap);
    ASSERT_TRUE(grid.ok());
    const proto::Grid2D written = MakeGrid2D(*grid, T_local_submap);
    EXPECT_THAT(written.cells(), ElementsAreArray(stored.cells()));
    EXPECT_EQ(written.limits().resolution(), 0.5);
    EXPECT_NEAR(written.limits().max().x(), 2., kMetres);
    EXPECT_NEAR(written.limits().max().y(), 1., kMetres);
    EXPECT_EQ(written.limits().cell_limits().num_x_cells(), 3);
    EXPECT_EQ(written.limits().cell_limits().num_y_cells(), 2);
    EXPECT_EQ(written.min_correspondence_cost(), 0.1f);
    EXPECT_EQ(written.max_correspondence_cost(), 0.9f);
    EXPECT_TRUE(written.has_probability_grid_2d());
  }
}

TEST(GridConversionTest, EveryValueComesBack) {
  proto::Grid2D stored = HandMadeGrid();
  stored.mutable_limits()->mutable_cell_limits()->set_num_x_cells(128);
  stored.mutable_limits()->mutable_cell_limits()->set_num_y_cells(256);
  stored.clear_cells();
  for (int value = 0; value <= 32767; ++value) stored.add_cells(value);
  const absl::StatusOr<OccupancyGrid> grid =
      MakeOccupancyGrid(stored, Rigid2());
  ASSERT_TRUE(grid.ok());
  EXPECT_THAT(MakeGrid2D(*grid, Rigid2()).cells(),
              ElementsAreArray(stored.cells()));
}

TEST(GridConversionTest, KnownCellsBoxHoldsTheKnownCells) {
  proto::Grid2D stored = HandMadeGrid();
  for (int i = 0; i < 6; ++i) stored.set_cells(i, 0);
  const Rigid2 T_local_submap;
  EXPECT_FALSE(
      MakeGrid2D(*MakeOccupancyGrid(stored, T_local_submap), T_local_submap)
          .has_known_cells_box());
  // (x, y) of the host: (1, 0) and (2, 1).
  stored.set_cells(1, 5);
  stored.set_cells(5, 5);
  const proto::CellBox box =
      MakeGrid2D(*MakeOccupancyGrid(stored, T_local_submap), T_local_submap)
          .known_cells_box();
  EXPECT_EQ(box.min_x(), 1);
  EXPECT_EQ(box.max_x(), 2);
  EXPECT_EQ(box.min_y(), 0);
  EXPECT_EQ(box.max_y(), 1);
}

TEST(GridConversionTest, ProbabilitiesAreClamped) {
  OccupancyGrid grid =
      UnknownGrid(CellGeometry{Eigen::Array2i(2, 1), 0.05, Rigid2()});
  grid.known.setConstant(true);
  grid.probability(0, 0) = 0.999f;
  grid.probability(1, 0) = 0.001f;
  EXPECT_THAT(MakeGrid2D(grid, Rigid2()).cells(),
              ::testing::ElementsAre(32767, 1));
}

TEST(GridConversionTest, CannotWriteATurnedGrid) {
  const OccupancyGrid grid =
      UnknownGrid(CellGeometry{Eigen::Array2i(2, 1), 0.05, Rigid2()});
  EXPECT_DEATH((void)MakeGrid2D(grid, Rigid2(0., 0., 0.1)), "");
}

// One row of cells of 1 m with the given signed distances to the surface.
proto::Grid2D MakeTsdf(const std::vector<float>& distances,
                       const float truncation) {
  proto::Grid2D grid;
  grid.mutable_limits()->set_resolution(1.);
  grid.mutable_limits()->mutable_max()->set_x(1.);
  grid.mutable_limits()->mutable_cell_limits()->set_num_x_cells(
      static_cast<int>(distances.size()));
  grid.mutable_limits()->mutable_cell_limits()->set_num_y_cells(1);
  grid.mutable_tsdf_2d()->set_truncation_distance(truncation);
  grid.mutable_tsdf_2d()->set_max_weight(10.f);
  for (const float distance : distances) {
    grid.add_cells(static_cast<int>(std::lround((distance + truncation) *
                                                32766.f / (2.f * truncation))) +
                   1);
    grid.mutable_tsdf_2d()->add_weight_cells(100);
  }
  return grid;
}

// By the host's fast index.
double ProbabilityOf(const OccupancyGrid& grid, const int cell) {
  const int j = grid.geometry.size.y() - 1 - cell;
  return grid.known(0, j) ? static_cast<double>(grid.probability(0, j)) : -1.;
}

// Of distances in 32766 steps of 6 m, times a slope of 0.8 / 1.5 m.
constexpr double kTsdfTolerance = 1e-4;

TEST(GridConversionTest, TsdfImpliesOccupancy) {
  const absl::StatusOr<OccupancyGrid> grid = MakeOccupancyGrid(
      MakeTsdf({3.f, 1.5f, 0.75f, 0.4f, 0.f, -0.4f, -0.74f, -0.8f, -3.f}, 3.f),
      Rigid2());
  ASSERT_TRUE(grid.ok()) << grid.status();
  EXPECT_NEAR(ProbabilityOf(*grid, 0), 0.1, kTsdfTolerance);
  EXPECT_NEAR(ProbabilityOf(*grid, 1), 0.1, kTsdfTolerance);
  EXPECT_NEAR(ProbabilityOf(*grid, 2), 0.5, kTsdfTolerance);
  EXPECT_NEAR(ProbabilityOf(*grid, 3), 0.9 - 0.8 * 0.4 / 1.5, kTsdfTolerance);
  EXPECT_NEAR(ProbabilityOf(*grid, 4), 0.9, kTsdfTolerance);
  EXPECT_NEAR(ProbabilityOf(*grid, 5), 0.9 - 0.8 * 0.4 / 1.5, kTsdfTolerance);
  EXPECT_NEAR(ProbabilityOf(*grid, 6), 0.9 - 0.8 * 0.74 / 1.5, kTsdfTolerance);
  EXPECT_EQ(ProbabilityOf(*grid, 7), -1.);
  EXPECT_EQ(ProbabilityOf(*grid, 8), -1.);
}

TEST(GridConversionTest, TsdfWithoutWeightIsUnknown) {
  proto::Grid2D stored = MakeTsdf({0.f, 0.f, 0.f, 0.f}, 3.f);
  stored.mutable_tsdf_2d()->set_weight_cells(1, 0);
  stored.mutable_tsdf_2d()->set_weight_cells(2, 1);
  stored.set_cells(3, 0);
  const absl::StatusOr<OccupancyGrid> grid =
      MakeOccupancyGrid(stored, Rigid2());
  ASSERT_TRUE(grid.ok());
  EXPECT_NEAR(ProbabilityOf(*grid, 0), 0.9, kTsdfTolerance);
  EXPECT_EQ(ProbabilityOf(*grid, 1), -1.);
  EXPECT_EQ(ProbabilityOf(*grid, 2), -1.);
  EXPECT_EQ(ProbabilityOf(*grid, 3), -1.);
}

TEST(GridConversionTest, FreeSpaceOfATsdfTruncatedEarlyIsFree) {
  const absl::StatusOr<OccupancyGrid> grid =
      MakeOccupancyGrid(MakeTsdf({0.5f, 0.f}, 0.5f), Rigid2());
  ASSERT_TRUE(grid.ok());
  EXPECT_NEAR(ProbabilityOf(*grid, 0), 0.1, kTsdfTolerance);
  EXPECT_NEAR(ProbabilityOf(*grid, 1), 0.9, kTsdfTolerance);
}

// A wall of any direction and offset is an image without gaps: no 4-connected
// path leads from one side to the other.
TEST(GridConversionTest, WallsOfATsdfHaveNoGaps) {
  constexpr int kSize = 20;
  constexpr float kThreshold = 0.55f;
  for (int k = 0; k < 200; ++k) {
    const double angle = 0.1 * k;
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
    proto::Grid2D stored =
        MakeTsdf(std::vector<float>(size_t{kSize} * kSize, 0.f), 3.f);
    stored.mutable_limits()->mutable_cell_limits()->set_num_x_cells(kSize);
    stored.mutable_limits()->mutable_cell_limits()->set_num_y_cells(kSize);
    const auto distance = [&](const int i, const int j) {
      return normal.dot(Eigen::Vector2d(i - 10, j - 10)) + 0.037 * k;
    };
    for (int i = 0; i < kSize; ++i) {
      for (int j = 0; j < kSize; ++j) {
        const double clamped = std::min(3., std::max(-3., distance(i, j)));
        stored.set_cells(
            j + kSize * i,
            1 + static_cast<int>(std::lround((clamped + 3.) / 6. * 32766.)));
      }
    }
    const absl::StatusOr<OccupancyGrid> grid =
        MakeOccupancyGrid(stored, Rigid2());
    ASSERT_TRUE(grid.ok());
    const auto occupied = [&](const int i, const int j) {
      const int u = kSize - 1 - i;
      const int v = kSize - 1 - j;
      return grid->known(u, v) && grid->probability(u, v) > kThreshold;
    };
    for (int i = 0; i + 1 < kSize; ++i) {
      for (int j = 0; j + 1 < kSize; ++j) {
        for (const auto& [di, dj] : {std::pair{1, 0}, std::pair{0, 1}}) {
          if (distance(i, j) * distance(i + di, j + dj) < 0.) {
            EXPECT_TRUE(occupied(i, j) || occupied(i + di, j + dj))
                << i << " " << j << " at " << angle;
          }
        }
      }
    }
  }
}

std::string ErrorOf(const proto::Grid2D& grid) {
  return std::string(MakeOccupancyGrid(grid, Rigid2()).status().message());
}

TEST(GridConversionTest, RefusesInvalidGrids) {
  const auto error = [](const auto& change) {
    proto::Grid2D grid = HandMadeGrid();
    change(&grid);
    return ErrorOf(grid);
  };
  for (const double resolution : {0., -1., 1e-300, 1e300, double{kNaN}}) {
    EXPECT_THAT(error([&](proto::Grid2D* grid) {
                  grid->mutable_limits()->set_resolution(resolution);
                }),
                HasSubstr("with cells of"));
  }
  for (const double max : {1e300, double{kNaN}, double{kInfinity}}) {
    EXPECT_THAT(error([&](proto::Grid2D* grid) {
                  grid->mutable_limits()->mutable_max()->set_y(max);
                }),
                HasSubstr("corner that is not finite"));
  }
  // 65536^2 is 0 in 32 bits.
  for (const auto& [num_x, num_y] :
       {std::pair{2, 2}, std::pair{-3, -2}, std::pair{0, 0},
        std::pair{65536, 65536}}) {
    EXPECT_THAT(error([&, num_x = num_x, num_y = num_y](proto::Grid2D* grid) {
                  proto::CellLimits& limits =
                      *grid->mutable_limits()->mutable_cell_limits();
                  limits.set_num_x_cells(num_x);
                  limits.set_num_y_cells(num_y);
                }),
                HasSubstr("cells with 6 values"));
  }
  EXPECT_THAT(error([](proto::Grid2D* grid) { grid->clear_cells(); }),
              HasSubstr("3 x 2 cells with 0 values"));
  for (const int value : {-1, 32768, 65535, 1 << 30}) {
    EXPECT_THAT(error([&](proto::Grid2D* grid) { grid->set_cells(3, value); }),
                HasSubstr("invalid value"));
  }
  for (const auto& [min, max] :
       {std::pair{0.9f, 0.1f}, std::pair{0.5f, 0.5f}, std::pair{0.f, 0.9f},
        std::pair{0.1f, 1.f}, std::pair{kNaN, 0.9f}, std::pair{0.1f, kNaN}}) {
    EXPECT_THAT(error([&, min = min, max = max](proto::Grid2D* grid) {
                  grid->set_min_correspondence_cost(min);
                  grid->set_max_correspondence_cost(max);
                }),
                HasSubstr("correspondence costs from"));
  }
  EXPECT_THAT(
      error([](proto::Grid2D* grid) { grid->clear_probability_grid_2d(); }),
      HasSubstr("unknown type"));
}

TEST(GridConversionTest, RefusesInvalidTsdfs) {
  const auto error = [](const auto& change) {
    proto::Grid2D grid = MakeTsdf({1.f, 0.f}, 3.f);
    change(grid.mutable_tsdf_2d());
    return ErrorOf(grid);
  };
  EXPECT_THAT(error([](proto::Tsdf2D* tsdf) { tsdf->clear_weight_cells(); }),
              HasSubstr("2 distances and 0 weights"));
  EXPECT_THAT(
      error([](proto::Tsdf2D* tsdf) { tsdf->set_weight_cells(0, 32768); }),
      HasSubstr("invalid value"));
  for (const float bad : {0.f, -1.f, kNaN, kInfinity}) {
    EXPECT_THAT(
        error([&](proto::Tsdf2D* tsdf) { tsdf->set_truncation_distance(bad); }),
        HasSubstr("truncation distance"));
    EXPECT_THAT(error([&](proto::Tsdf2D* tsdf) { tsdf->set_max_weight(bad); }),
                HasSubstr("maximum weight"));
  }
}

}  // namespace
}  // namespace cartographer_sdf::grid_conversion_test
