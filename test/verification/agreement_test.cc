// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/agreement.h"

#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "gtest/gtest.h"
#include "test/testing/building.h"

namespace cartographer_sdf::agreement_test {
namespace {

constexpr double kCell = 0.04;

// A wall at cell 0 of a row; free cells at 1 to 29, of which those from 20 on
// were hardly seen (certainty 0.2); unknown from there to 49. The distance at
// cell i is (i - 0.5) cells.
SurfaceModel WallAtTheBeginningOfARow() {
  CellGeometry geometry;
  geometry.resolution = kCell;
  geometry.size = {50, 1};
  OccupancyGrid grid = UnknownGrid(geometry);
  for (int i = 0; i < 30; ++i) {
    grid.known(i, 0) = true;
    grid.probability(i, 0) = i == 0 ? 0.9f : i < 20 ? 0.1f : 0.45f;
  }
  std::optional<SurfaceModel> model = MakeSurfaceModel(FieldOptions(), grid);
  CHECK(model.has_value());
  return *std::move(model);
}

SurfacePoint PointInCell(const int i, const double weight = 1.) {
  return {{(i + 0.5) * kCell, 0.5 * kCell}, weight};
}

DirectedAgreement Measure(const std::vector<SurfacePoint>& points) {
  return MeasureAgreement(AgreementOptions(), WallAtTheBeginningOfARow(),
                          points, Rigid2());
}

TEST(OverlapsEnoughTest, TwoFifthsOfTheAreaAreEnough) {
  // A room of 8 m x 5 m, seen from its middle.
  const SurfaceModel room =
      testing::SurfaceSeenFrom(testing::BareRoom(8., 5.), {}, {{0., 0.}});
  // Shifted by 4.8 m, 3.2 m of 8 m are common. A cell of 5 cm is 0.006.
  EXPECT_TRUE(OverlapsEnough(room, room, Rigid2(4.7, 0., 0.)));
  EXPECT_FALSE(OverlapsEnough(room, room, Rigid2(4.9, 0., 0.)));
  EXPECT_TRUE(OverlapsEnough(room, room, Rigid2(0., 2.9, 0.)));
  EXPECT_FALSE(OverlapsEnough(room, room, Rigid2(0., 3.1, 0.)));
}

TEST(AgreementTest, PointsOnAWallAreHits) {
  // At -0.5, 0.5 and 3.5 cells from the wall's edge; the limit is at 3.75.
  const DirectedAgreement agreement =
      Measure({PointInCell(0), PointInCell(1), PointInCell(4, 0.5)});
  EXPECT_NEAR(agreement.num_points, 2.5, 1e-6);
  EXPECT_NEAR(agreement.hits, 2.5, 1e-6);
  EXPECT_EQ(agreement.contradictions, 0.);
  EXPECT_NEAR(agreement.HitRatio(), 1., 1e-6);
  EXPECT_NEAR(agreement.squared_distance,
              kCell * kCell * (0.25 + 0.25 + 0.5 * 3.5 * 3.5), 1e-6);
}

TEST(AgreementTest, PointsBetweenTheLimitsAreNeither) {
  // At 4.5 and 5.5 cells; contradictions begin at 6.25.
  const DirectedAgreement agreement = Measure({PointInCell(5), PointInCell(6)});
  EXPECT_NEAR(agreement.num_points, 2., 1e-6);
  EXPECT_EQ(agreement.hits, 0.);
  EXPECT_EQ(agreement.contradictions, 0.);
}

TEST(AgreementTest, PointsInFreeSpaceAreContradictions) {
  const DirectedAgreement agreement =
      Measure({PointInCell(7), PointInCell(15, 0.5), PointInCell(19)});
  EXPECT_NEAR(agreement.num_points, 2.5, 1e-6);
  EXPECT_EQ(agreement.hits, 0.);
  EXPECT_NEAR(agreement.contradictions, 2.5, 1e-6);
  EXPECT_NEAR(agreement.ContradictionRatio(), 1., 1e-6);
}

TEST(AgreementTest, UncertainFreeSpaceContradictsLess) {
  const DirectedAgreement agreement = Measure({PointInCell(25)});
  EXPECT_NEAR(agreement.num_points, 1., 1e-6);
  EXPECT_NEAR(agreement.contradictions, 0.2, 1e-6);
}

TEST(AgreementTest, CertaintyCanBeIgnored) {
  AgreementOptions options;
  options.weigh_by_certainty = false;
  const DirectedAgreement agreement = MeasureAgreement(
      options, WallAtTheBeginningOfARow(),
      {PointInCell(0, 0.5), PointInCell(25, 0.25), PointInCell(15)}, Rigid2());
  EXPECT_EQ(agreement.num_points, 3.);
  EXPECT_EQ(agreement.hits, 1.);
  EXPECT_EQ(agreement.contradictions, 2.);
}

TEST(TileAgreementTest, EachPlaceCountsOnce) {
  // A room 20 m long, and the same with a box in one place.
  const testing::Building room = testing::BareRoom(20., 4.);
  testing::Building with_box = room;
  with_box.push_back(testing::Furniture(8., 0., 1., 1., 0.));
  const testing::Viewpoints viewpoints = {{-8., 1.}, {-4., -1.}, {0., 1.},
                                          {4., -1.}, {8., 1.5},  {8., -1.5}};
  const SurfaceModel a = testing::SurfaceSeenFrom(room, Rigid2(), viewpoints);
  const SurfaceModel b =
      testing::SurfaceSeenFrom(with_box, Rigid2(), viewpoints);
  const TileAgreement same =
      MeasurePairAgreement(AgreementOptions(), a, a, Rigid2()).tiles;
  EXPECT_NEAR(same.mean_hit_ratio, 1., 1e-9);
  // 48 m of wall.
  EXPECT_NEAR(same.num_tiles, 24., 1.);
  const TileAgreement different =
      MeasurePairAgreement(AgreementOptions(), a, b, Rigid2()).tiles;
  EXPECT_LT(different.mean_hit_ratio, 1. - 0.5 / different.num_tiles);
  // Either way round, but for where the squares begin.
  const TileAgreement swapped =
      MeasurePairAgreement(AgreementOptions(), b, a, Rigid2()).tiles;
  EXPECT_NEAR(swapped.mean_hit_ratio, different.mean_hit_ratio, 0.01);
  // A sample stands for all.
  AgreementOptions few_points;
  few_points.max_num_points = 400;
  const TileAgreement sampled =
      MeasurePairAgreement(few_points, a, b, Rigid2()).tiles;
  EXPECT_NEAR(sampled.num_tiles, different.num_tiles, 1.);
  EXPECT_NEAR(sampled.mean_hit_ratio, different.mean_hit_ratio, 0.002);
  // Far away they share nothing.
  const TileAgreement none =
      MeasurePairAgreement(AgreementOptions(), a, b, Rigid2(500., 0., 0.))
          .tiles;
  EXPECT_EQ(none.num_tiles, 0.);
  EXPECT_EQ(none.mean_hit_ratio, 0.);
}

TEST(AgreementTest, UnknownSaysNothing) {
  // Unknown, in the padding, and outside of the grid on either side.
  const DirectedAgreement agreement = Measure(
      {PointInCell(40), PointInCell(55), PointInCell(1000), PointInCell(-99)});
  EXPECT_EQ(agreement.num_points, 0.);
  EXPECT_EQ(agreement.HitRatio(), 0.);
  EXPECT_EQ(agreement.ContradictionRatio(), 0.);
}

TEST(AgreementTest, WallsBorderOnTheUnknown) {
  // One cell behind the wall, in the padding.
  EXPECT_NEAR(Measure({PointInCell(-1)}).hits, 1., 1e-6);
}

TEST(AgreementTest, TakesPointsIntoTheModel) {
  // Points on a line away from the wall, turned by 90 degrees onto it.
  const std::vector<SurfacePoint> points = {{{0., 0.3}, 1.}, {{0., 0.8}, 1.}};
  const Rigid2 T_model_points(0.32, 0.02, M_PI_2);
  const DirectedAgreement agreement = MeasureAgreement(
      AgreementOptions(), WallAtTheBeginningOfARow(), points, T_model_points);
  // (0.02, 0.02) is the wall's centre, (-0.48, 0.02) is unknown.
  EXPECT_NEAR(agreement.num_points, 1., 1e-6);
  EXPECT_NEAR(agreement.hits, 1., 1e-6);
}

TEST(AgreementTest, MeasuresTheFirstPointsAlone) {
  AgreementOptions options;
  options.max_num_points = 2;
  const DirectedAgreement agreement = MeasureAgreement(
      options, WallAtTheBeginningOfARow(),
      {PointInCell(0), PointInCell(10), PointInCell(0)}, Rigid2());
  EXPECT_NEAR(agreement.num_points, 2., 1e-6);
  EXPECT_NEAR(agreement.hits, 1., 1e-6);
}

TEST(AgreementTest, TrueViewsOfOneBuildingAgree) {
  const testing::Building building = testing::TwoRooms();
  const Rigid2 T_world_reference(3., 2., 0.4), T_world_query(5., 3., -1.);
  const SurfaceModel reference = testing::SurfaceSeenFrom(
      building, T_world_reference, testing::WestRoomViewpoints());
  const SurfaceModel query = testing::SurfaceSeenFrom(
      building, T_world_query, {{2.2, 2.4}, {4.4, 3.2}, {6.3, 4.2}});
  const Rigid2 truth = T_world_reference.Inverse() * T_world_query;
  const DirectedAgreement agreement =
      MeasureAgreement(AgreementOptions(), reference, query.walls, truth);
  EXPECT_GT(agreement.HitRatio(), 0.97);
  EXPECT_LT(agreement.ContradictionRatio(), 0.001);
  const DirectedAgreement shifted = MeasureAgreement(
      AgreementOptions(), reference, query.walls, Rigid2(1., 0.5, 0.) * truth);
  EXPECT_LT(shifted.HitRatio(), 0.25);
  EXPECT_GT(shifted.ContradictionRatio(), 0.6);
}

// Counts all cells.
double BruteForceOverlapArea(const OccupancyGrid& reference,
                             const OccupancyGrid& query,
                             const Rigid2& T_reference_query) {
  int count = 0;
  for (int j = 0; j < query.geometry.size.y(); ++j) {
    for (int i = 0; i < query.geometry.size.x(); ++i) {
      const Eigen::Array2i cell = reference.geometry.CellAt(
          T_reference_query * query.geometry.CellCentre({i, j}));
      count += query.known(i, j) && reference.geometry.Contains(cell) &&
               reference.known(cell.x(), cell.y());
    }
  }
  return count * 0.05 * 0.05;
}

TEST(OverlapAreaTest, IsTheBruteForceOne) {
  const testing::Building building = testing::TwoRooms();
  const Rigid2 T_world_reference(3., 2., 0.4), T_world_query(5., 3., -1.);
  const OccupancyGrid reference_grid = testing::SeeFrom(
      building, T_world_reference, testing::WestRoomViewpoints());
  const OccupancyGrid query_grid =
      testing::SeeFrom(building, T_world_query, {{5.5, 6.}, {5.4, 4.}});
  const SurfaceModel reference =
      *MakeSurfaceModel(FieldOptions(), reference_grid);
  const SurfaceModel query = *MakeSurfaceModel(FieldOptions(), query_grid);
  const Rigid2 truth = T_world_reference.Inverse() * T_world_query;
  for (const Rigid2& pose :
       {truth, Rigid2(2., -1., 0.5) * truth, Rigid2(1., 0.5, 2.) * truth}) {
    const double expected =
        BruteForceOverlapArea(reference_grid, query_grid, pose);
    ASSERT_GT(expected, 5.);
    // One point for 0.06 m^2: some 100 to 400 of them.
    const double area = OverlapArea(reference, query, pose);
    EXPECT_NEAR(area, expected, 0.025 * expected);
    // The same answer, whatever the rounding, without a look at all points.
    const double huge = std::numeric_limits<double>::max();
    for (const double bound :
         {0., 0.3 * area, std::nextafter(area, 0.), area,
          std::nextafter(area, huge), 1.1 * area, 1e6, huge}) {
      EXPECT_EQ(OverlapsBy(bound, reference, query, pose), area >= bound)
          << bound;
      EXPECT_EQ(OverlapsBy(bound, reference, query, pose, 70),
                OverlapArea(reference, query, pose, 70) >= bound)
          << bound;
    }
  }
  EXPECT_TRUE(OverlapsBy(0., reference, query, Rigid2(100., 0., 0.)));
  EXPECT_FALSE(OverlapsBy(1e-9, reference, query, Rigid2(100., 0., 0.)));
  EXPECT_EQ(OverlapArea(reference, query, Rigid2(100., 0., 0.)), 0.);
}

TEST(OverlapTilesTest, AreWhereBothHaveSeenInTheGivenFrame) {
  // The row is seen from 0 to 1.2 m, the query's from 0.8 to 2 m.
  const SurfaceModel row = WallAtTheBeginningOfARow();
  const Rigid2 T_row_query(0.8, 0., 0.);
  EXPECT_EQ(OverlapTiles(row, row, T_row_query, Rigid2(), 0.5),
            (std::set<TileIndex>{{1, 0}, {2, 0}}));
  EXPECT_EQ(OverlapTiles(row, row, T_row_query, Rigid2(-10., 5., 0.), 0.5),
            (std::set<TileIndex>{{-19, 10}, {-18, 10}}));
  EXPECT_TRUE(
      OverlapTiles(row, row, Rigid2(1.3, 0., 0.), Rigid2(), 0.5).empty());
}

}  // namespace
}  // namespace cartographer_sdf::agreement_test
