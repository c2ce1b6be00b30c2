// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/geometry/alignment.h"

#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer_sdf::alignment_test {
namespace {

using Points = std::vector<Eigen::Vector2d>;

// Exact data are recovered up to the rounding of coordinates of some 10 m.
constexpr double kExact = 1e-12;

double Uniform(std::mt19937* const engine) {
  return static_cast<double>((*engine)()) / 4294967296. - 0.5;
}

Points RandomPoints(const int count, const double extent,
                    std::mt19937* const engine) {
  Points points;
  for (int k = 0; k != count; ++k) {
    const double x = extent * Uniform(engine);
    points.emplace_back(x, extent * Uniform(engine));
  }
  return points;
}

Points Transform(const Rigid2& T_a_b, const Points& p_b) {
  Points p_a;
  for (const Eigen::Vector2d& p : p_b) {
    p_a.push_back(T_a_b * p);
  }
  return p_a;
}

double Cost(const Rigid2& T_reference_query, const Points& p_reference,
            const Points& p_query, const std::vector<double>& weights) {
  double cost = 0.;
  for (size_t k = 0; k != p_query.size(); ++k) {
    cost += (weights.empty() ? 1. : weights[k]) *
            (p_reference[k] - T_reference_query * p_query[k]).squaredNorm();
  }
  return cost;
}

void ExpectNear(const Rigid2& actual, const Rigid2& expected,
                const double tolerance) {
  EXPECT_NEAR(actual.translation().x(), expected.translation().x(), tolerance);
  EXPECT_NEAR(actual.translation().y(), expected.translation().y(), tolerance);
  EXPECT_NEAR(NormalizeAngle(actual.rotation() - expected.rotation()), 0.,
              tolerance);
}

TEST(AlignPointPairsTest, RecoversAnyRotationExactly) {
  std::mt19937 engine(42);
  for (int degrees = -180; degrees <= 180; degrees += 15) {
    const Points p_query = RandomPoints(5, 10., &engine);
    const Rigid2 expected(3., -7., degrees * M_PI / 180.);
    const std::optional<Rigid2> actual =
        AlignPointPairs(Transform(expected, p_query), p_query);
    ASSERT_TRUE(actual.has_value());
    ExpectNear(*actual, expected, kExact);
  }
}

TEST(AlignPointPairsTest, TwoPairsKeepTheMidpointAndTheDirection) {
  // Lengths 2 and 4: no rigid motion fits, the midpoints must meet.
  const std::optional<Rigid2> actual =
      AlignPointPairs({{0., 0.}, {0., 4.}}, {{1., 0.}, {3., 0.}});
  ASSERT_TRUE(actual.has_value());
  ExpectNear(*actual, Rigid2(0., 0., M_PI_2), kExact);
}

TEST(AlignPointPairsTest, NoNeighbouringPoseIsBetter) {
  std::mt19937 engine(42);
  const Points p_query = RandomPoints(20, 10., &engine);
  const Points p_reference = RandomPoints(20, 10., &engine);
  std::vector<double> weights;
  for (int k = 0; k != 20; ++k) {
    weights.push_back(Uniform(&engine) + 0.5);
  }
  const std::optional<Rigid2> best =
      AlignPointPairs(p_reference, p_query, weights);
  ASSERT_TRUE(best.has_value());
  const double cost = Cost(*best, p_reference, p_query, weights);
  for (int degrees = 0; degrees != 360; ++degrees) {
    const double angle = degrees * M_PI / 180.;
    for (const Rigid2& other :
         {Rigid2(best->translation(), best->rotation() + angle),
          Rigid2(best->translation() +
                     1e-4 * Eigen::Vector2d(std::cos(angle), std::sin(angle)),
                 best->rotation() + (degrees % 2 == 0 ? 1e-5 : -1e-5))}) {
      EXPECT_GE(Cost(other, p_reference, p_query, weights), cost);
    }
  }
}

TEST(AlignPointPairsTest, ZeroWeightRemovesAnOutlier) {
  const Rigid2 expected(1., 2., 0.3);
  const Points p_query = {{0., 0.}, {4., 1.}, {-2., 3.}, {5., 5.}};
  Points p_reference = Transform(expected, p_query);
  p_reference[3] += Eigen::Vector2d(100., -50.);
  const std::optional<Rigid2> actual =
      AlignPointPairs(p_reference, p_query, {1., 1., 1., 0.});
  ASSERT_TRUE(actual.has_value());
  ExpectNear(*actual, expected, kExact);
}

TEST(AlignPointPairsTest, IntegerWeightsAreRepetitions) {
  const Points p_reference = {{0., 1.}, {2., 1.}, {5., -1.}};
  const Points p_query = {{1., 0.}, {1., 2.5}, {-1., 5.}};
  const std::optional<Rigid2> weighted =
      AlignPointPairs(p_reference, p_query, {2., 1., 3.});
  const std::optional<Rigid2> repeated = AlignPointPairs(
      {{0., 1.}, {0., 1.}, {2., 1.}, {5., -1.}, {5., -1.}, {5., -1.}},
      {{1., 0.}, {1., 0.}, {1., 2.5}, {-1., 5.}, {-1., 5.}, {-1., 5.}});
  ASSERT_TRUE(weighted.has_value());
  ASSERT_TRUE(repeated.has_value());
  ExpectNear(*weighted, *repeated, kExact);
}

TEST(AlignPointPairsTest, SwappingTheFramesInvertsTheAnswer) {
  std::mt19937 engine(42);
  const Points p_query = RandomPoints(7, 10., &engine);
  const Points p_reference = RandomPoints(7, 10., &engine);
  const std::optional<Rigid2> forward = AlignPointPairs(p_reference, p_query);
  const std::optional<Rigid2> backward = AlignPointPairs(p_query, p_reference);
  ASSERT_TRUE(forward.has_value());
  ASSERT_TRUE(backward.has_value());
  ExpectNear(*backward, forward->Inverse(), kExact);
}

TEST(AlignPointPairsTest, NoneWhereTheRotationIsUndetermined) {
  EXPECT_FALSE(AlignPointPairs({}, {}).has_value());
  EXPECT_FALSE(AlignPointPairs({{1., 2.}}, {{3., 4.}}).has_value());
  EXPECT_FALSE(
      AlignPointPairs({{1., 2.}, {1., 2.}}, {{3., 4.}, {5., 6.}}).has_value());
  EXPECT_FALSE(AlignPointPairs({{1., 2.}, {5., 2.}}, {{0.1, 0.7}, {0.1, 0.7}})
                   .has_value());
  EXPECT_FALSE(
      AlignPointPairs({{0., 0.}, {1., 0.}}, {{0., 0.}, {1., 0.}}, {0., 1.})
          .has_value());
  EXPECT_FALSE(
      AlignPointPairs({{0., 0.}, {1., 0.}}, {{0., 0.}, {1., 0.}}, {0., 0.})
          .has_value());
  // A square against its mirror image: every rotation fits equally badly.
  EXPECT_FALSE(AlignPointPairs({{1., 0.}, {0., 1.}, {-1., 0.}, {0., -1.}},
                               {{1., 0.}, {0., -1.}, {-1., 0.}, {0., 1.}})
                   .has_value());
}

TEST(AlignPointPairsTest, WorksFarFromTheOrigin) {
  const Points p_query = {{1e6, 1e6}, {1e6 + 1., 1e6}, {1e6, 1e6 + 2.}};
  const Rigid2 expected(0., 0., 1.);
  const std::optional<Rigid2> actual =
      AlignPointPairs(Transform(expected, p_query), p_query);
  ASSERT_TRUE(actual.has_value());
  // Coordinates of 1e6 m round at 1e-10 m, over a lever of 1 m.
  EXPECT_NEAR(actual->rotation(), expected.rotation(), 1e-9);
}

}  // namespace
}  // namespace cartographer_sdf::alignment_test
