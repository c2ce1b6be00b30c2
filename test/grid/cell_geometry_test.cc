// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/grid/cell_geometry.h"

#include <random>
#include <sstream>

#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "gtest/gtest.h"
#include "test/testing/random_number.h"

namespace cartographer_sdf::cell_geometry_test {
namespace {

using testing::Uniform;

constexpr double kExact = 1e-12;

CellGeometry TurnedGeometry() {
  CellGeometry geometry;
  geometry.size = {30, 20};
  geometry.resolution = 0.05;
  geometry.T_submap_grid = Rigid2(3., -7., 2.2);
  return geometry;
}

TEST(CellGeometryTest, TheCornerOfTheFirstCellIsTheOrigin) {
  CellGeometry geometry;
  geometry.resolution = 0.1;
  EXPECT_LT((geometry.CellCentre({0, 0}) - Eigen::Vector2d(0.05, 0.05)).norm(),
            kExact);
  EXPECT_LT((geometry.CellCentre({3, 1}) - Eigen::Vector2d(0.35, 0.15)).norm(),
            kExact);
  geometry.T_submap_grid = Rigid2(1., 2., M_PI_2);
  EXPECT_LT((geometry.CellCentre({3, 1}) - Eigen::Vector2d(0.85, 2.35)).norm(),
            kExact);
}

TEST(CellGeometryTest, CellAtInvertsCellCentre) {
  const CellGeometry geometry = TurnedGeometry();
  for (int j = -3; j < 23; ++j) {
    for (int i = -3; i < 33; ++i) {
      const Eigen::Array2i cell(i, j);
      EXPECT_TRUE((geometry.CellAt(geometry.CellCentre(cell)) == cell).all());
      EXPECT_EQ(geometry.Contains(cell), i >= 0 && j >= 0 && i < 30 && j < 20);
    }
  }
}

TEST(CellGeometryTest, CellsReachHalfAResolutionFromTheirCentres) {
  const CellGeometry geometry = TurnedGeometry();
  std::mt19937 engine(42);
  for (int k = 0; k < 1000; ++k) {
    const double x = Uniform(-0.5, 2., &engine);
    const Eigen::Vector2d p_grid(x, Uniform(-0.5, 2., &engine));
    const Eigen::Array2i cell =
        geometry.CellAt(geometry.T_submap_grid * p_grid);
    const Eigen::Vector2d from_centre =
        geometry.GridToCells(p_grid) - cell.matrix().cast<double>();
    EXPECT_LE(from_centre.cwiseAbs().maxCoeff(), 0.5 + kExact);
    EXPECT_LT(
        (geometry.CellsToGrid(geometry.GridToCells(p_grid)) - p_grid).norm(),
        kExact);
  }
}

// A side of 1/16 m is exact in binary.
TEST(CellGeometryTest, ABorderBelongsToTheCellBeyondIt) {
  CellGeometry geometry;
  geometry.resolution = 0.0625;
  geometry.size = {4, 4};
  EXPECT_TRUE((geometry.CellAt({0., 0.}) == Eigen::Array2i(0, 0)).all());
  EXPECT_TRUE((geometry.CellAt({0.0625, 0.125}) == Eigen::Array2i(1, 2)).all());
  EXPECT_TRUE((geometry.CellAt({0.25, 0.}) == Eigen::Array2i(4, 0)).all());
  EXPECT_FALSE(geometry.Contains(geometry.CellAt({0.25, 0.})));
  EXPECT_TRUE((geometry.CellAt({-1e-9, 0.}) == Eigen::Array2i(-1, 0)).all());
}

TEST(UnknownGridTest, KnowsNothing) {
  const OccupancyGrid grid = UnknownGrid(TurnedGeometry());
  EXPECT_EQ(grid.known.rows(), 30);
  EXPECT_EQ(grid.known.cols(), 20);
  EXPECT_EQ(grid.probability.rows(), 30);
  EXPECT_EQ(grid.probability.cols(), 20);
  EXPECT_FALSE(grid.known.any());
  EXPECT_EQ(UnknownGrid({}).known.size(), 0);
}

TEST(SubmapIdTest, OrdersByTrajectoryThenIndex) {
  EXPECT_LT((SubmapId{0, 7}), (SubmapId{1, 0}));
  EXPECT_LT((SubmapId{1, 2}), (SubmapId{1, 3}));
  EXPECT_FALSE((SubmapId{1, 2}) < (SubmapId{1, 2}));
  EXPECT_EQ((SubmapId{1, 2}), (SubmapId{1, 2}));
  EXPECT_NE((SubmapId{1, 2}), (SubmapId{2, 1}));
  std::ostringstream out;
  out << SubmapId{1, 2};
  EXPECT_EQ(out.str(), "1,2");
}

}  // namespace
}  // namespace cartographer_sdf::cell_geometry_test
