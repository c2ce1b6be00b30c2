// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/field/distance_field.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "gtest/gtest.h"
#include "test/testing/ascii_grid.h"
#include "test/testing/random_number.h"
#include "test/testing/world.h"

namespace cartographer_sdf::distance_field_test {
namespace {

using testing::AsciiGrid;
using testing::CentredGeometry;
using testing::Rasterise;
using testing::Uniform;
using testing::World;

constexpr double kResolution = 0.05;
// A cell is what its centre is. The occupied centre nearest to a cell is thus
// no nearer than the wall, and no farther than the wall plus one diagonal of a
// cell (to where every centre around is inside, for walls that bend little);
// the field then takes half a cell off.
constexpr double kLowerBound = -0.5 * kResolution;
constexpr double kUpperBound = (M_SQRT2 - 0.5) * kResolution;
// Single precision of some metres.
constexpr double kRounding = 1e-6;

FieldOptions WithPadding(const double padding_meters) {
  FieldOptions options;
  options.padding_meters = padding_meters;
  return options;
}

DistanceField FieldOf(const OccupancyGrid& grid, const double padding = 0.) {
  std::optional<DistanceField> field =
      MakeDistanceField(WithPadding(padding), grid);
  EXPECT_TRUE(field.has_value());
  return *std::move(field);
}

void ExpectDistancesOf(const World& world, const double angle) {
  const DistanceField field = FieldOf(Rasterise(
      world, CentredGeometry(80, kResolution, angle), {}, {10., 10.}));
  // The walls that are nearest to the cells in the middle lie within the grid.
  for (int j = 20; j < 60; ++j) {
    for (int i = 20; i < 60; ++i) {
      const double truth = world(field.geometry.CellCentre({i, j}));
      const double error = field.distance(i, j) - truth;
      // Inside walls the roles of free and occupied are swapped.
      const double outward = truth > 0. ? error : -error;
      EXPECT_GE(outward, kLowerBound - kRounding) << truth;
      EXPECT_LE(outward, kUpperBound + kRounding) << truth;
      EXPECT_EQ(field.distance(i, j) > 0.f, truth > 0.);
    }
  }
}

TEST(DistanceFieldTest, IsThatOfAHalfPlane) {
  for (int degrees = 0; degrees < 360; degrees += 25) {
    ExpectDistancesOf(testing::SolidHalfPlane(degrees * M_PI / 180., 0.123),
                      0.3);
  }
}

TEST(DistanceFieldTest, IsThatOfADisc) {
  for (const double angle : {0., 0.4, -2.}) {
    ExpectDistancesOf(testing::SolidDisc({0.21, -0.34}, 0.8), angle);
  }
}

TEST(DistanceFieldTest, IsExactForWallsAlongTheCells) {
  const World corridor = testing::Corridor(2.);
  const DistanceField field =
      FieldOf(Rasterise(corridor, CentredGeometry(80), {}, {10., 10.}));
  for (int j = 0; j < 80; ++j) {
    for (int i = 0; i < 80; ++i) {
      EXPECT_NEAR(field.distance(i, j),
                  corridor(field.geometry.CellCentre({i, j})), kRounding);
    }
  }
}

// From walls of one cell to blocks that are farther across than is looked for
// nearby, some of them cut by the rim of the grid.
TEST(DistanceFieldTest, IsExactInsideWallsOfAnyThickness) {
  std::mt19937 engine(1);
  for (const int largest : {1, 3, 8, 20}) {
    constexpr int kSize = 40;
    OccupancyGrid grid = Rasterise(testing::SolidDisc({0., 0.}, 0.),
                                   CentredGeometry(kSize), {}, {10., 10.});
    BoolArray wall = BoolArray::Constant(kSize, kSize, false);
    for (int k = 0; k < 12; ++k) {
      const int side = 1 + static_cast<int>(engine() % largest);
      const int i = static_cast<int>(engine() % kSize);
      const int j = static_cast<int>(engine() % kSize);
      wall.block(i, j, std::min(side, kSize - i), std::min(side, kSize - j))
          .setConstant(true);
    }
    grid.known.setConstant(true);
    grid.probability =
        wall.select(Eigen::ArrayXXf::Constant(kSize, kSize, 0.9f),
                    Eigen::ArrayXXf::Constant(kSize, kSize, 0.1f));
    const DistanceField field = FieldOf(grid);
    for (int j = 0; j < kSize; ++j) {
      for (int i = 0; i < kSize; ++i) {
        double nearest = 2. * kSize;  // [cells]
        for (int b = 0; b < kSize; ++b) {
          for (int a = 0; a < kSize; ++a) {
            if (wall(a, b) != wall(i, j)) {
              nearest = std::min(nearest, std::hypot(a - i, b - j));
            }
          }
        }
        EXPECT_NEAR(field.distance(i, j),
                    kResolution * (wall(i, j) ? 0.5 - nearest : nearest - 0.5),
                    kRounding)
            << i << " " << j;
      }
    }
  }
}

TEST(DistanceFieldTest, IsZeroOnTheEdgesOfCells) {
  const DistanceField field = FieldOf(AsciiGrid({"..##"}));
  const DistanceField upright = FieldOf(AsciiGrid({"..", "..", "##", "##"}));
  EXPECT_FLOAT_EQ(field.distance(0, 0), 1.5f * 0.05f);
  EXPECT_FLOAT_EQ(field.distance(1, 0), 0.5f * 0.05f);
  EXPECT_FLOAT_EQ(field.distance(2, 0), -0.5f * 0.05f);
  EXPECT_FLOAT_EQ(field.distance(3, 0), -1.5f * 0.05f);
  const std::optional<FieldSample> edge = SampleField(upright, {0.05, 0.1});
  ASSERT_TRUE(edge.has_value());
  EXPECT_NEAR(edge->distance, 0., kRounding);
  EXPECT_NEAR(edge->gradient.x(), 0., kRounding);
  EXPECT_NEAR(edge->gradient.y(), 1., kRounding);
}

TEST(DistanceFieldTest, OnlyKnownCellsAboveTheThresholdAreWalls) {
  OccupancyGrid grid = AsciiGrid({"...... "});
  grid.probability << 0.1f, 0.5f, 0.6f, 0.7f, 0.1f, 0.1f, 0.9f;
  FieldOptions options = WithPadding(0.);
  options.occupied_probability = 0.6;
  const std::optional<DistanceField> field = MakeDistanceField(options, grid);
  ASSERT_TRUE(field.has_value());
  for (int i = 0; i < 7; ++i) {
    EXPECT_FLOAT_EQ(field->distance(i, 0),
                    i == 3
                        ? -0.025f
                        : 0.05f * static_cast<float>(std::abs(i - 3)) - 0.025f);
    EXPECT_EQ(field->observed(i, 0), i < 6);
  }
}

TEST(DistanceFieldTest, NoneWithoutAWall) {
  EXPECT_FALSE(MakeDistanceField({}, AsciiGrid({})).has_value());
  EXPECT_FALSE(MakeDistanceField({}, AsciiGrid({" "})).has_value());
  EXPECT_FALSE(MakeDistanceField({}, AsciiGrid({"...", ". ."})).has_value());
  EXPECT_FALSE(
      MakeDistanceField({}, UnknownGrid(CentredGeometry(30))).has_value());
}

TEST(DistanceFieldTest, IsFiniteWhereAllIsWall) {
  const DistanceField field = FieldOf(AsciiGrid({"###", "###"}));
  EXPECT_TRUE(field.distance.isFinite().all());
  EXPECT_TRUE((field.distance < 0.f).all());
}

TEST(DistanceFieldTest, PaddingChangesNothingButTheSize) {
  const OccupancyGrid grid = Rasterise(testing::SolidDisc({0.1, 0.2}, 0.5),
                                       CentredGeometry(60, 0.05, 0.7));
  const DistanceField bare = FieldOf(grid), padded = FieldOf(grid, 0.6);
  constexpr int kMargin = 12;
  EXPECT_EQ(padded.geometry.size.x(), 60 + 2 * kMargin);
  EXPECT_EQ(padded.geometry.size.y(), 60 + 2 * kMargin);
  EXPECT_LT((padded.geometry.CellCentre({kMargin, kMargin}) -
             bare.geometry.CellCentre({0, 0}))
                .norm(),
            1e-12);
  EXPECT_TRUE(
      (padded.distance.block(kMargin, kMargin, 60, 60) == bare.distance).all());
  EXPECT_TRUE(
      (padded.observed.block(kMargin, kMargin, 60, 60) == bare.observed).all());
  EXPECT_EQ(padded.observed.count(), bare.observed.count());
}

TEST(DistanceFieldTest, ObservesWhatIsKnown) {
  const OccupancyGrid grid = Rasterise(testing::SolidDisc({0., 0.}, 0.5),
                                       CentredGeometry(60), {}, {0.1, 0.7});
  ASSERT_GT(grid.known.count(), 0);
  ASSERT_LT(grid.known.count(), grid.known.size());
  EXPECT_TRUE((FieldOf(grid).observed == grid.known).all());
}

TEST(DistanceFieldTest, MovesWithTheSubmap) {
  const World world = testing::SolidDisc({0.1, -0.3}, 0.6);
  const Rigid2 T_new_old(3., -4., 2.5);
  CellGeometry moved = CentredGeometry(50);
  moved.T_submap_grid = T_new_old * moved.T_submap_grid;
  const DistanceField field = FieldOf(Rasterise(world, CentredGeometry(50)));
  const DistanceField other =
      FieldOf(Rasterise(testing::Moved(T_new_old, world), moved));
  EXPECT_TRUE((field.distance == other.distance).all());
  EXPECT_LT((T_new_old * field.geometry.CellCentre({7, 9}) -
             other.geometry.CellCentre({7, 9}))
                .norm(),
            1e-12);
}

TEST(FieldOptionsTest, ValidateNamesTheOption) {
  EXPECT_EQ(Validate(FieldOptions()), "");
  FieldOptions options;
  options.occupied_probability = 1.;
  EXPECT_NE(Validate(options).find("occupied_probability"), std::string::npos);
  EXPECT_NE(Validate(WithPadding(std::nan(""))).find("padding_meters"),
            std::string::npos);
}

DistanceField LinearField(const Eigen::Vector2d& slope) {
  DistanceField field;
  field.geometry.size = {20, 30};
  field.geometry.resolution = kResolution;
  field.distance.resize(20, 30);
  for (int j = 0; j < 30; ++j) {
    for (int i = 0; i < 20; ++i) {
      field.distance(i, j) = static_cast<float>(
          1. + slope.dot(field.geometry.CellsToGrid(Eigen::Vector2d(i, j))));
    }
  }
  return field;
}

TEST(SampleFieldTest, IsExactForLinearFields) {
  const Eigen::Vector2d slope(0.6, -0.8);
  const DistanceField field = LinearField(slope);
  std::mt19937 engine(42);
  for (int k = 0; k < 1000; ++k) {
    const Eigen::Vector2d p_grid(Uniform(0.03, 0.97, &engine),
                                 Uniform(0.03, 1.47, &engine));
    const std::optional<FieldSample> sample = SampleField(field, p_grid);
    ASSERT_TRUE(sample.has_value());
    EXPECT_NEAR(sample->distance, 1. + slope.dot(p_grid), kRounding);
    // A difference over one cell.
    EXPECT_LT((sample->gradient - slope).norm(), 4. * kRounding / kResolution);
  }
}

TEST(SampleFieldTest, GradientIsThatOfTheInterpolation) {
  const DistanceField field = FieldOf(testing::OfficeGrid(100));
  std::mt19937 engine(42);
  constexpr double kStep = 1e-7;
  int num_compared = 0;
  for (int k = 0; k < 1000; ++k) {
    const Eigen::Vector2d p_grid(Uniform(0.1, 4.9, &engine),
                                 Uniform(0.1, 4.9, &engine));
    const Eigen::Vector2d cells = field.geometry.GridToCells(p_grid);
    const Eigen::Array2d within = cells.array() - cells.array().floor();
    // On its seams the interpolation has no gradient.
    if (within.minCoeff() < 1e-3 || within.maxCoeff() > 1. - 1e-3) continue;
    ++num_compared;
    const auto distance = [&](const double dx, const double dy) {
      return SampleField(field, p_grid + Eigen::Vector2d(dx, dy))->distance;
    };
    const Eigen::Vector2d gradient = SampleField(field, p_grid)->gradient;
    EXPECT_NEAR(gradient.x(),
                (distance(kStep, 0.) - distance(-kStep, 0.)) / (2. * kStep),
                1e-6);
    EXPECT_NEAR(gradient.y(),
                (distance(0., kStep) - distance(0., -kStep)) / (2. * kStep),
                1e-6);
  }
  EXPECT_GT(num_compared, 900);
}

TEST(SampleFieldTest, NoneOutsideTheCentresOfTheOutermostCells) {
  const DistanceField field = LinearField({1., 0.});
  constexpr double kHalf = 0.5 * kResolution, kEpsilon = 1e-9;
  const double right = 20 * kResolution - kHalf, top = 30 * kResolution - kHalf;
  EXPECT_TRUE(SampleField(field, {kHalf + kEpsilon, kHalf + kEpsilon}));
  EXPECT_TRUE(SampleField(field, {right - kEpsilon, top - kEpsilon}));
  EXPECT_FALSE(SampleField(field, {kHalf - kEpsilon, 0.5}));
  EXPECT_FALSE(SampleField(field, {0.5, kHalf - kEpsilon}));
  EXPECT_FALSE(SampleField(field, {right + kEpsilon, 0.5}));
  EXPECT_FALSE(SampleField(field, {0.5, top + kEpsilon}));
  EXPECT_FALSE(SampleField(field, {std::nan(""), 0.5}));
  EXPECT_FALSE(SampleField(field, {1e300, 0.5}));
  EXPECT_FALSE(SampleField(DistanceField(), {0., 0.}));
}

}  // namespace
}  // namespace cartographer_sdf::distance_field_test
