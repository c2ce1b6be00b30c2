// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/matching/hypotheses.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/feature_sets.h"

namespace cartographer_sdf {
namespace {

using testing::AddOutliers;
using testing::Identity;
using testing::Moved;
using testing::RandomFeatures;
using testing::Shuffle;
using testing::Uniform;

struct Problem {
  FeatureSet reference, query;
  std::vector<Correspondence> correspondences;
};

// `noise` [m] of positions, and as many radians of orientations.
Problem MakeProblem(const Rigid2& T_reference_query, const int num_inliers,
                    const int num_outliers, const double noise = 0.) {
  std::mt19937 engine(42);
  Problem problem;
  problem.query = RandomFeatures(num_inliers, 20., 1, &engine);
  problem.reference = Moved(T_reference_query, problem.query);
  for (Feature& feature : problem.reference.features) {
    feature.keypoint.position.x() += Uniform(-noise, noise, &engine);
    feature.keypoint.position.y() += Uniform(-noise, noise, &engine);
    feature.orientation =
        NormalizeAngle(feature.orientation + Uniform(-noise, noise, &engine));
  }
  problem.correspondences = Identity(num_inliers);
  AddOutliers(num_outliers, num_inliers, &engine, &problem.correspondences);
  return problem;
}

std::vector<Hypothesis> Propose(const Problem& problem,
                                const HypothesisOptions& options = {}) {
  return ProposeHypotheses(options, problem.reference, problem.query,
                           problem.correspondences);
}

// The number of the first hypothesis that is within the cell of the raster of
// the truth, where it matters: at the middle of the query. -1: none.
int RankOf(const Rigid2& truth, const std::vector<Hypothesis>& hypotheses,
           const double distance = 0.5, const double rotation = 0.1) {
  for (size_t k = 0; k < hypotheses.size(); ++k) {
    const Rigid2 error = truth.Inverse() * hypotheses[k].T_reference_query;
    if (error.translation().norm() < distance &&
        std::abs(error.rotation()) < rotation) {
      return static_cast<int>(k);
    }
  }
  return -1;
}

TEST(ProposeHypothesesTest, ExactCorrespondencesGiveThePose) {
  // Single precision of some 10 m.
  constexpr double kRounding = 1e-5;
  for (int degrees = -180; degrees <= 180; degrees += 5) {
    const Rigid2 truth(3.2, -1.1, degrees * M_PI / 180.);
    const std::vector<Hypothesis> hypotheses =
        Propose(MakeProblem(truth, 20, 0));
    // Rounding may spread them over neighbouring cells.
    EXPECT_GE(RankOf(truth, hypotheses, kRounding, kRounding), 0) << degrees;
    EXPECT_EQ(RankOf(truth, hypotheses, kRounding, kRounding), 0) << degrees;
  }
}

TEST(ProposeHypothesesTest, HalfATurnIsNotAveragedWithItsNegative) {
  // Along the axes a half turn is exact: votes of both +pi and -pi, and of
  // angles just beyond on either side.
  for (const double noise : {0., 1e-7, 1e-3, 0.02}) {
    const Rigid2 truth(2., 1., M_PI);
    const Problem problem = MakeProblem(truth, 40, 0, noise);
    for (const Hypothesis& hypothesis : Propose(problem)) {
      if (hypothesis.num_votes < 20) continue;
      EXPECT_GT(std::abs(hypothesis.T_reference_query.rotation()), M_PI - 0.11)
          << noise;
    }
    EXPECT_EQ(RankOf(truth, Propose(problem)), 0) << noise;
  }
  Problem square;
  for (const auto& [x, y] : {std::pair(0., 0.), {4., 0.}, {0., 4.}, {4., 4.}}) {
    square.query.features.push_back(
        {{{x, y}, 1., KeypointKind::kMaximum, 1.}, 0.});
  }
  square.reference = square.query;
  for (Feature& feature : square.reference.features) {
    feature.keypoint.position = -feature.keypoint.position;
    feature.orientation = M_PI;
  }
  square.correspondences = Identity(4);
  const std::vector<Hypothesis> hypotheses = Propose(square);
  EXPECT_EQ(RankOf(Rigid2(0., 0., M_PI), hypotheses, 1e-5, 1e-5), 0);
  for (const Hypothesis& hypothesis : hypotheses) {
    EXPECT_GT(std::abs(hypothesis.T_reference_query.rotation()), 3.1);
  }
}

TEST(ProposeHypothesesTest, ThePoseIsAmongTheFirstWithNinetyPercentOutliers) {
  for (int degrees = -180; degrees < 180; degrees += 20) {
    const Rigid2 truth(-4., 9., degrees * M_PI / 180.);
    const int rank = RankOf(truth, Propose(MakeProblem(truth, 50, 450, 0.05)));
    EXPECT_GE(rank, 0) << degrees;
    EXPECT_LT(rank, 3) << degrees;
  }
}

TEST(ProposeHypothesesTest, ASymmetricPlaceYieldsBothPoses) {
  std::mt19937 engine(42);
  // Each half is the other turned by half a turn, features included.
  FeatureSet half = RandomFeatures(20, 12., 1, &engine);
  const FeatureSet other = Moved(Rigid2(0., 0., M_PI), half);
  FeatureSet place = half;
  place.features.insert(place.features.end(), other.features.begin(),
                        other.features.end());
  const Rigid2 truth(1., 2., 0.6);
  Problem problem{Moved(truth, place), place, Identity(40)};
  for (int k = 0; k < 40; ++k) {
    problem.correspondences.push_back({(k + 20) % 40, k, 0.1f});
  }
  const std::vector<Hypothesis> hypotheses = Propose(problem);
  for (const Rigid2& pose : {truth, truth * Rigid2(0., 0., M_PI)}) {
    const int rank = RankOf(pose, hypotheses, 0.01, 0.001);
    EXPECT_GE(rank, 0);
    EXPECT_LT(rank, 4);
  }
}

TEST(ProposeHypothesesTest, CountsPairsMostFirst) {
  // Exact votes meet in one cell of the raster, here well within it.
  const Rigid2 truth(0.25, 0.25, 0.05);
  Problem problem = MakeProblem(truth, 10, 300);
  HypothesisOptions options;
  options.min_baseline_meters = 1e-3;
  const std::vector<Hypothesis> hypotheses = Propose(problem, options);
  ASSERT_GT(hypotheses.size(), 1u);
  for (size_t k = 1; k < hypotheses.size(); ++k) {
    EXPECT_LE(hypotheses[k].num_votes, hypotheses[k - 1].num_votes);
  }
  EXPECT_GE(hypotheses[0].num_votes, 10 * 9 / 2);
  options.max_num_hypotheses = 1;
  EXPECT_EQ(Propose(problem, options).size(), 1u);
  // The least descriptor distances are those of the true ones.
  options.max_num_correspondences = 10;
  options.max_num_hypotheses = 60;
  double total = 0.;
  for (const Hypothesis& hypothesis : Propose(problem, options)) {
    total += hypothesis.num_votes;
  }
  EXPECT_EQ(total, 10 * 9 / 2);
}

TEST(ProposeHypothesesTest, NeedsAgreementInLengthOrientationAndBaseline) {
  const Rigid2 truth(0., 0., 3.1);  // near the cut of angles
  Problem pair = MakeProblem(truth, 2, 0);
  const auto place = [&](const double query, const double reference,
                         const double turn) {
    pair.query.features[0].keypoint.position = {0., 0.};
    pair.query.features[1].keypoint.position = {query, 0.};
    pair.reference = Moved(truth, pair.query);
    pair.reference.features[1].keypoint.position =
        truth * Eigen::Vector2d(reference, 0.);
    pair.reference.features[1].orientation += turn;
    return Propose(pair).size();
  };
  const HypothesisOptions defaults;
  const double length = defaults.max_length_difference_meters;
  const double turn = defaults.max_orientation_difference;
  EXPECT_EQ(place(5., 5., 0.), 1u);
  EXPECT_EQ(place(5., 5. + 0.99 * length, 0.), 1u);
  EXPECT_EQ(place(5., 5. + 1.01 * length, 0.), 0u);
  EXPECT_EQ(place(5., 5., 0.99 * turn), 1u);
  EXPECT_EQ(place(5., 5., -0.99 * turn), 1u);
  EXPECT_EQ(place(5., 5., 1.01 * turn), 0u);
  EXPECT_EQ(place(5., 5., -1.01 * turn), 0u);
  EXPECT_EQ(place(1.01 * defaults.min_baseline_meters,
                  1.01 * defaults.min_baseline_meters, 0.),
            1u);
  EXPECT_EQ(place(0.99 * defaults.min_baseline_meters,
                  0.99 * defaults.min_baseline_meters, 0.),
            0u);
}

TEST(ProposeHypothesesTest, IgnoresTheOrderOfTheCorrespondences) {
  Problem problem = MakeProblem(Rigid2(1., 2., -3.), 40, 300, 0.05);
  const std::vector<Hypothesis> expected = Propose(problem);
  std::mt19937 engine(7);
  for (int repetition = 0; repetition < 3; ++repetition) {
    Shuffle(&problem.correspondences, &engine);
    const std::vector<Hypothesis> actual = Propose(problem);
    ASSERT_EQ(actual.size(), expected.size());
    for (size_t k = 0; k < expected.size(); ++k) {
      EXPECT_EQ(actual[k].num_votes, expected[k].num_votes);
      EXPECT_EQ(actual[k].T_reference_query.translation(),
                expected[k].T_reference_query.translation());
      EXPECT_EQ(actual[k].T_reference_query.rotation(),
                expected[k].T_reference_query.rotation());
    }
  }
}

TEST(ProposeHypothesesTest, MovingTheQueryMovesThePosesInversely) {
  const Rigid2 truth(1., 2., 0.5);
  Problem problem = MakeProblem(truth, 40, 100, 0.03);
  const std::vector<Hypothesis> before = Propose(problem);
  const FeatureSet query = problem.query;
  for (const Rigid2& T_new_old :
       {Rigid2(30., -70., 0.), Rigid2(0., 0., 1.), Rigid2(-5., 3., -2.8)}) {
    problem.query = Moved(T_new_old, query);
    const std::vector<Hypothesis> after = Propose(problem);
    // The raster of rotations does not turn along: same pose, other votes.
    EXPECT_GE(RankOf(truth * T_new_old.Inverse(), after, 0.5, 0.1), 0);
    EXPECT_LT(RankOf(truth * T_new_old.Inverse(), after, 0.5, 0.1), 3);
    if (T_new_old.rotation() != 0.) continue;
    ASSERT_EQ(after.size(), before.size());
    const Rigid2 error = before[0].T_reference_query.Inverse() *
                         after[0].T_reference_query * T_new_old;
    EXPECT_LT(error.translation().norm(), 1e-3);
    EXPECT_LT(std::abs(error.rotation()), 1e-4);
  }
}

TEST(ProposeHypothesesTest, NoneFromLessThanAPair) {
  EXPECT_TRUE(Propose(Problem()).empty());
  EXPECT_TRUE(Propose(MakeProblem({}, 1, 0)).empty());
  Problem same = MakeProblem({}, 3, 0);
  same.correspondences.assign(10, {1, 1, 0.1f});
  EXPECT_TRUE(Propose(same).empty());
}

TEST(ProposeHypothesesTest, SurvivesPlacesThatAreAbsurdlyFar) {
  for (const double far : {1e6, 1e12, 1e30, -1e30}) {
    EXPECT_NO_FATAL_FAILURE(
        (void)Propose(MakeProblem(Rigid2(far, 0.5 * far, 1.), 5, 0)));
  }
}

TEST(HypothesisOptionsTest, ValidateNamesTheOption) {
  EXPECT_EQ(Validate(HypothesisOptions()), "");
  const auto error = [](const auto member, const auto value) {
    HypothesisOptions options;
    options.*member = value;
    return Validate(options);
  };
  using ::testing::HasSubstr;
  EXPECT_THAT(error(&HypothesisOptions::max_num_hypotheses, 0),
              HasSubstr("max_num_hypotheses"));
  EXPECT_THAT(error(&HypothesisOptions::max_num_correspondences, 1),
              HasSubstr("max_num_correspondences"));
  EXPECT_THAT(error(&HypothesisOptions::max_orientation_difference, M_PI),
              HasSubstr("max_orientation_difference"));
  EXPECT_THAT(error(&HypothesisOptions::max_length_difference_meters, 0.),
              HasSubstr("max_length_difference_meters"));
  EXPECT_THAT(error(&HypothesisOptions::min_baseline_meters, 0.),
              HasSubstr("min_baseline_meters"));
  EXPECT_THAT(error(&HypothesisOptions::cluster_distance_meters, 0.),
              HasSubstr("cluster_distance_meters"));
  EXPECT_THAT(error(&HypothesisOptions::cluster_rotation, std::nan("")),
              HasSubstr("cluster_rotation"));
}

}  // namespace
}  // namespace cartographer_sdf
