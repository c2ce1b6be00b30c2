// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/place/surface_model.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"

namespace cartographer_sdf::surface_model_test {
namespace {

// A row of known cells with these probabilities, of 0.05 m, at the given place.
OccupancyGrid Row(const std::vector<float>& probabilities,
                  const Rigid2& T_submap_grid = Rigid2()) {
  CellGeometry geometry;
  geometry.size = {static_cast<int>(probabilities.size()), 1};
  geometry.T_submap_grid = T_submap_grid;
  OccupancyGrid grid = UnknownGrid(geometry);
  grid.known.setConstant(true);
  for (size_t i = 0; i < probabilities.size(); ++i) {
    grid.probability(static_cast<int>(i), 0) = probabilities[i];
  }
  return grid;
}

OccupancyGrid WestRoom() {
  return testing::SeeFrom(testing::TwoRooms(), Rigid2(3., 2., 0.3),
                          testing::WestRoomViewpoints());
}

TEST(SurfaceModelTest, WeighsWallsByProbability) {
  const Rigid2 T_submap_grid(3., -1., 0.7);
  const std::optional<SurfaceModel> model = MakeSurfaceModel(
      FieldOptions(), Row({0.55f, 0.605f, 0.73f, 0.9f, 0.2f}, T_submap_grid));
  ASSERT_TRUE(model.has_value());
  std::map<int, double> weights;
  for (const SurfacePoint& wall : model->walls) {
    const Eigen::Vector2d p_grid = T_submap_grid.Inverse() * wall.position;
    EXPECT_NEAR(p_grid.y(), 0.025, 1e-9);
    weights[static_cast<int>(std::floor(p_grid.x() / 0.05))] = wall.weight;
  }
  ASSERT_EQ(weights.size(), 4u);
  EXPECT_NEAR(weights[0], 0.28, 1e-6);
  EXPECT_NEAR(weights[1], 0.5, 1e-6);
  EXPECT_NEAR(weights[2], 1., 1e-6);
  EXPECT_EQ(weights[3], 1.);
}

TEST(SurfaceModelTest, KnowsHowSurelyCellsAreFree) {
  FieldOptions options;
  options.padding_meters = 0.1;  // two cells
  OccupancyGrid grid = Row({0.9f, 0.5f, 0.49f, 0.375f, 0.25f, 0.1f, 0.1f});
  grid.known(6, 0) = false;
  const std::optional<SurfaceModel> model = MakeSurfaceModel(options, grid);
  ASSERT_TRUE(model.has_value());
  const PinnedCells cells = model->cells.Pin();
  ASSERT_EQ(cells->rows(), 11);
  ASSERT_EQ(cells->cols(), 5);
  // Of 255; wall, undecided, seen free once, half sure, sure, surer, unknown.
  const std::vector<int> expected = {0, 0, 10, 128, 255, 255, 0};
  int sum = 0;
  for (int i = 0; i < 7; ++i) {
    EXPECT_EQ((*cells)(i + 2, 2).free, expected[i]) << i;
    sum += expected[i];
  }
  int total = 0;
  for (const SurfaceCell& cell : cells->reshaped()) total += cell.free;
  EXPECT_EQ(total, sum) << "the padding is unknown";
}

TEST(SurfaceModelTest, MixesWallsWithoutLossAndAlwaysAlike) {
  const OccupancyGrid grid = WestRoom();
  const std::optional<SurfaceModel> model =
      MakeSurfaceModel(FieldOptions(), grid);
  const std::optional<SurfaceModel> again =
      MakeSurfaceModel(FieldOptions(), grid);
  ASSERT_TRUE(model.has_value() && again.has_value());
  std::vector<std::pair<double, double>> mixed, sorted, cells;
  for (const SurfacePoint& wall : model->walls) {
    mixed.emplace_back(wall.position.x(), wall.position.y());
  }
  for (int j = 0; j < grid.geometry.size.y(); ++j) {
    for (int i = 0; i < grid.geometry.size.x(); ++i) {
      if (!grid.known(i, j) || grid.probability(i, j) < 0.5f) continue;
      const Eigen::Vector2d centre = grid.geometry.CellCentre({i, j});
      cells.emplace_back(centre.x(), centre.y());
    }
  }
  EXPECT_NE(mixed, cells) << "not mixed";
  sorted = mixed;
  std::sort(sorted.begin(), sorted.end());
  std::sort(cells.begin(), cells.end());
  EXPECT_EQ(sorted, cells);
  ASSERT_EQ(again->walls.size(), model->walls.size());
  for (size_t k = 0; k < mixed.size(); ++k) {
    ASSERT_EQ(again->walls[k].position, model->walls[k].position);
  }
}

TEST(SurfaceModelTest, FirstPointsAreAFairSample) {
  const std::optional<SurfaceModel> model =
      MakeSurfaceModel(FieldOptions(), WestRoom());
  ASSERT_TRUE(model.has_value());
  ASSERT_GT(model->walls.size(), 600u);
  const auto mean_of_first = [&model](const size_t count) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (size_t k = 0; k < count; ++k) sum += model->walls[k].position;
    return Eigen::Vector2d(sum / static_cast<double>(count));
  };
  // 150 of points that spread by some 3 m: 0.25 m of standard deviation.
  EXPECT_LT((mean_of_first(150) - mean_of_first(model->walls.size())).norm(),
            0.75);
}

TEST(SurfaceModelTest, ObservedPointsStandForTheObservedArea) {
  const OccupancyGrid grid = WestRoom();
  const std::optional<SurfaceModel> model =
      MakeSurfaceModel(FieldOptions(), grid);
  ASSERT_TRUE(model.has_value());
  for (const Eigen::Vector2d& point : model->observed_points) {
    const Eigen::Array2i cell = grid.geometry.CellAt(point);
    ASSERT_TRUE(grid.known(cell.x(), cell.y()));
  }
  const double area = static_cast<double>(grid.known.count()) * 0.05 * 0.05;
  EXPECT_NEAR(static_cast<double>(model->observed_points.size()) *
                  model->area_per_observed_point,
              area, 0.003 * area);
}

TEST(SurfaceModelTest, NoneWithoutWalls) {
  OccupancyGrid grid = WestRoom();
  grid.probability = grid.probability.min(0.4f);
  EXPECT_FALSE(MakeSurfaceModel(FieldOptions(), grid).has_value());
  EXPECT_FALSE(
      MakeSurfaceModel(FieldOptions(), UnknownGrid(grid.geometry)).has_value());
  EXPECT_FALSE(MakeSurfaceModel(FieldOptions(), OccupancyGrid()).has_value());
}

}  // namespace
}  // namespace cartographer_sdf::surface_model_test
