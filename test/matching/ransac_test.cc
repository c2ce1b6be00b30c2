// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/matching/ransac.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/feature_sets.h"

namespace cartographer_sdf::ransac_test {
namespace {

using testing::Identity;
using testing::Moved;
using testing::RandomFeatures;
using testing::Shuffle;

constexpr double kExact = 1e-9;
const Rigid2 kPose(7., -4., 2.9);  // T_reference_query

using Problem = testing::MatchingProblem;

Problem MakeProblem(const int num_inliers, const int num_outliers,
                    const double noise = 0.) {
  return testing::MakeMatchingProblem(kPose, num_inliers, num_outliers, noise);
}

std::optional<Alignment> Align(const Problem& problem,
                               const RansacOptions& options = {},
                               const uint64_t seed = 42) {
  return AlignByRansac(options, problem.reference, problem.query,
                       problem.correspondences, seed);
}

void ExpectPose(const std::optional<Alignment>& alignment,
                const double tolerance) {
  ASSERT_TRUE(alignment.has_value());
  const Rigid2 error = kPose.Inverse() * alignment->T_reference_query;
  EXPECT_LT(error.translation().norm(), tolerance);
  EXPECT_LT(std::abs(error.rotation()), tolerance);
}

TEST(AlignByRansacTest, RecoversThePoseAmongOutliers) {
  // 30 of 60 are true; each drawn pair is with a probability of 1 / 4.
  for (const int max_num_iterations : {1770, 200}) {
    const Problem problem = MakeProblem(30, 30);
    RansacOptions options;
    options.max_num_iterations = max_num_iterations;
    const std::optional<Alignment> alignment = Align(problem, options);
    ExpectPose(alignment, kExact);
    EXPECT_EQ(alignment->inliers.size(), 30u);
    for (const Correspondence& inlier : alignment->inliers) {
      EXPECT_EQ(inlier.reference, inlier.query);
    }
  }
}

TEST(AlignByRansacTest, AveragesNoise) {
  const std::optional<Alignment> alignment = Align(MakeProblem(50, 50, 0.1));
  // 0.1 m uniform noise has a deviation of 0.06 m in each axis, of which a
  // seventh remains; 0.03 are three deviations.
  ExpectPose(alignment, 0.03);
  EXPECT_EQ(alignment->inliers.size(), 50u);
}

TEST(AlignByRansacTest, TriesAllPairsWhereThereAreFew) {
  // Only one pair of 190 agrees; it must be found, whatever the seed.
  std::mt19937 engine(42);
  Problem problem;
  problem.reference = RandomFeatures(20, 2000., 1, &engine);
  problem.query = RandomFeatures(20, 2000., 1, &engine);
  for (const int k : {7, 15}) {
    problem.query.features[k].keypoint.position =
        kPose.Inverse() * problem.reference.features[k].keypoint.position;
  }
  problem.correspondences = Identity(20);
  RansacOptions options;
  options.max_num_iterations = 190;
  for (int seed = 0; seed < 20; ++seed) {
    const std::optional<Alignment> alignment = Align(problem, options, seed);
    ExpectPose(alignment, kExact);
    EXPECT_EQ(alignment->inliers.size(), 2u);
  }
  // One pair fewer allowed: they are drawn, and most draws miss it.
  options.max_num_iterations = 50;
  int num_found = 0;
  for (int seed = 0; seed < 100; ++seed) {
    num_found += Align(problem, options, seed).has_value();
  }
  // 50 draws of one in 190: 23 expected, with a deviation of 4.2.
  EXPECT_GT(num_found, 23 - 13);
  EXPECT_LT(num_found, 23 + 13);
}

TEST(AlignByRansacTest, DependsOnTheSeedAlone) {
  const Problem problem = MakeProblem(20, 180, 0.2);
  RansacOptions options;
  options.max_num_iterations = 100;
  std::set<double> rotations;
  for (int seed = 0; seed < 10; ++seed) {
    const std::optional<Alignment> first = Align(problem, options, seed);
    const std::optional<Alignment> second = Align(problem, options, seed);
    ASSERT_EQ(first.has_value(), second.has_value());
    if (!first) continue;
    EXPECT_EQ(first->T_reference_query.translation(),
              second->T_reference_query.translation());
    EXPECT_EQ(first->T_reference_query.rotation(),
              second->T_reference_query.rotation());
    rotations.insert(first->T_reference_query.rotation());
  }
  EXPECT_GT(rotations.size(), 1u);
}

TEST(AlignByRansacTest, TheOrderDoesNotMatterWhereOnePoseIsBest) {
  Problem problem = MakeProblem(30, 30);
  std::mt19937 engine(7);
  for (int repetition = 0; repetition < 5; ++repetition) {
    Shuffle(&problem.correspondences, &engine);
    const std::optional<Alignment> alignment = Align(problem);
    ExpectPose(alignment, kExact);
    EXPECT_EQ(alignment->inliers.size(), 30u);
  }
}

TEST(AlignByRansacTest, SwappingTheSubmapsInvertsThePose) {
  const Problem problem = MakeProblem(30, 20);
  Problem swapped{problem.query, problem.reference, problem.correspondences};
  for (Correspondence& c : swapped.correspondences) {
    std::swap(c.reference, c.query);
  }
  const std::optional<Alignment> alignment = Align(swapped);
  ASSERT_TRUE(alignment.has_value());
  const Rigid2 error = kPose * alignment->T_reference_query;
  EXPECT_LT(error.translation().norm(), kExact);
  EXPECT_LT(std::abs(error.rotation()), kExact);
}

TEST(AlignByRansacTest, EachKeypointCountsOnce) {
  Problem problem = MakeProblem(10, 0);
  const std::vector<Correspondence> once = problem.correspondences;
  problem.correspondences.insert(problem.correspondences.end(), once.begin(),
                                 once.end());
  // The same query keypoint, seen from a second direction.
  problem.query.features.push_back(problem.query.features[3]);
  problem.correspondences.push_back({3, 10, 0.1f});
  const std::optional<Alignment> alignment = Align(problem);
  ExpectPose(alignment, kExact);
  EXPECT_EQ(alignment->inliers.size(), 10u);
}

TEST(AlignByRansacTest, CollinearPointsFixThePose) {
  Problem problem = MakeProblem(10, 0);
  for (int k = 0; k < 10; ++k) {
    const Eigen::Vector2d p(1.5 * k * k / 10., 0.);
    problem.query.features[k].keypoint.position = p;
    problem.reference.features[k].keypoint.position = kPose * p;
  }
  ExpectPose(Align(problem), kExact);
}

TEST(AlignByRansacTest, NoneWhereNoTwoAgree) {
  EXPECT_FALSE(Align(Problem()).has_value());
  EXPECT_FALSE(Align(MakeProblem(1, 0)).has_value());
  Problem near = MakeProblem(2, 0);
  near.query.features[0].keypoint.position = {0., 0.};
  near.query.features[1].keypoint.position = {0.9, 0.};
  near.reference = Moved(kPose, near.query);
  EXPECT_FALSE(Align(near).has_value());
  near.query.features[1].keypoint.position = {1.1, 0.};
  near.reference = Moved(kPose, near.query);
  EXPECT_TRUE(Align(near).has_value());
  // Lengths that differ by more than both ends allow.
  near.reference.features[1].keypoint.position =
      kPose * Eigen::Vector2d(1.1 + 0.61, 0.);
  EXPECT_FALSE(Align(near).has_value());
  // All the same correspondence.
  Problem same = MakeProblem(3, 0);
  same.correspondences.assign(5, {0, 0, 0.1f});
  EXPECT_FALSE(Align(same).has_value());
}

TEST(RansacOptionsTest, ValidateNamesTheOption) {
  EXPECT_EQ(Validate(RansacOptions()), "");
  const auto error = [](const auto member, const auto value) {
    RansacOptions options;
    options.*member = value;
    return Validate(options);
  };
  using ::testing::HasSubstr;
  EXPECT_THAT(error(&RansacOptions::max_num_iterations, 0),
              HasSubstr("max_num_iterations"));
  EXPECT_THAT(error(&RansacOptions::inlier_distance_meters, 0.),
              HasSubstr("inlier_distance_meters"));
  EXPECT_THAT(error(&RansacOptions::min_baseline_meters, std::nan("")),
              HasSubstr("min_baseline_meters"));
}

}  // namespace
}  // namespace cartographer_sdf::ransac_test
