// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/field/distance_transform.h"

#include <algorithm>
#include <limits>
#include <random>

#include "gtest/gtest.h"
#include "test/testing/random_number.h"

namespace cartographer_sdf::distance_transform_test {
namespace {

using testing::Uniform;
using testing::UniformInt;

Eigen::ArrayXXi BruteForce(const BoolArray& sites) {
  const int rows = static_cast<int>(sites.rows());
  const int cols = static_cast<int>(sites.cols());
  Eigen::ArrayXXi squared =
      Eigen::ArrayXXi::Constant(rows, cols, std::numeric_limits<int>::max());
  for (int b = 0; b < cols; ++b) {
    for (int a = 0; a < rows; ++a) {
      if (!sites(a, b)) continue;
      for (int j = 0; j < cols; ++j) {
        for (int i = 0; i < rows; ++i) {
          squared(i, j) =
              std::min(squared(i, j), (i - a) * (i - a) + (j - b) * (j - b));
        }
      }
    }
  }
  return squared;
}

BoolArray RandomSites(const int rows, const int cols, const double density,
                      std::mt19937* const engine) {
  BoolArray sites(rows, cols);
  for (Eigen::Index k = 0; k < sites.size(); ++k) {
    sites(k) = Uniform(0., 1., engine) < density;
  }
  sites(UniformInt(static_cast<int>(sites.size()), engine)) = true;
  return sites;
}

void ExpectExact(const BoolArray& sites) {
  EXPECT_TRUE((SquaredDistanceTransform(sites) == BruteForce(sites)).all())
      << sites;
}

TEST(SquaredDistanceTransformTest, EqualsBruteForce) {
  std::mt19937 engine(42);
  const Eigen::Array2i shapes[] = {{1, 1},   {1, 2},   {2, 1},  {1, 57},
                                   {57, 1},  {2, 2},   {3, 40}, {40, 3},
                                   {31, 17}, {16, 32}, {25, 25}};
  for (const Eigen::Array2i& shape : shapes) {
    for (const double density : {0., 0.003, 0.03, 0.2, 0.5, 0.9, 1.}) {
      for (int repetition = 0; repetition < 10; ++repetition) {
        ExpectExact(RandomSites(shape.x(), shape.y(), density, &engine));
      }
    }
  }
}

TEST(SquaredDistanceTransformTest, EqualsBruteForceForAnySingleSite) {
  for (int k = 0; k < 7 * 5; ++k) {
    BoolArray sites = BoolArray::Constant(7, 5, false);
    sites(k) = true;
    ExpectExact(sites);
  }
}

TEST(SquaredDistanceTransformTest, EqualsBruteForceForStructures) {
  BoolArray border = BoolArray::Constant(20, 30, true);
  border.block(1, 1, 18, 28) = false;
  ExpectExact(border);
  ExpectExact(!border);
  BoolArray diagonal = BoolArray::Constant(30, 30, false);
  for (int k = 0; k < 30; ++k) diagonal(k, k) = true;
  ExpectExact(diagonal);
  ExpectExact(!diagonal);
  BoolArray column = BoolArray::Constant(30, 20, false);
  column.col(19) = true;
  ExpectExact(column);
  BoolArray row = BoolArray::Constant(30, 20, false);
  row.row(0) = true;
  ExpectExact(row);
}

TEST(SquaredDistanceTransformTest, IsExactAcrossTheLargestGrid) {
  constexpr int kSide = 32767;
  BoolArray sites = BoolArray::Constant(kSide, 3, false);
  sites(0, 0) = sites(0, 2) = true;
  const Eigen::ArrayXXi squared = SquaredDistanceTransform(sites);
  EXPECT_EQ(squared(kSide - 1, 0), (kSide - 1) * (kSide - 1));
  EXPECT_EQ(squared(kSide - 1, 1), (kSide - 1) * (kSide - 1) + 1);
  EXPECT_TRUE(
      (SquaredDistanceTransform(sites.transpose()) == squared.transpose())
          .all());
}

TEST(SquaredDistanceTransformDeathTest, NeedsASite) {
  EXPECT_DEATH(
      { (void)SquaredDistanceTransform(BoolArray::Constant(3, 3, false)); },
      "undefined");
}

}  // namespace
}  // namespace cartographer_sdf::distance_transform_test
