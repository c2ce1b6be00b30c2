// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/matching/pose_voter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "cartographer_sdf/geometry/distinct_poses.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/feature_sets.h"

namespace cartographer_sdf::pose_voter_test {
namespace {

using testing::Identity;
using testing::MakeMatchingProblem;
using testing::Moved;
using testing::RandomFeatures;
using testing::Shuffle;
using testing::Uniform;

using Problem = testing::MatchingProblem;

std::vector<Rigid2> Propose(const Problem& problem,
                            const HypothesisOptions& options = {}) {
  return ProposePoses(options, problem.reference, problem.query,
                      problem.correspondences);
}

// The number of the first hypothesis that is within the cell of the raster of
// the truth, where it matters: at the centroid of the query. -1: none.
int RankOf(const Rigid2& truth, const std::vector<Rigid2>& hypotheses,
           const double distance = 0.5, const double rotation = 0.1) {
  for (size_t k = 0; k < hypotheses.size(); ++k) {
    const Rigid2 error = truth.Inverse() * hypotheses[k];
    if (error.translation().norm() < distance &&
        std::abs(error.rotation()) < rotation) {
      return static_cast<int>(k);
    }
  }
  return -1;
}

TEST(ProposePosesTest, ExactCorrespondencesGiveThePose) {
  // Single precision of some 10 m.
  constexpr double kRounding = 1e-5;
  for (int degrees = -180; degrees <= 180; degrees += 5) {
    const Rigid2 truth(3.2, -1.1, degrees * M_PI / 180.);
    const std::vector<Rigid2> hypotheses =
        Propose(MakeMatchingProblem(truth, 20, 0));
    // Rounding may spread them over neighbouring cells.
    EXPECT_GE(RankOf(truth, hypotheses, kRounding, kRounding), 0) << degrees;
    EXPECT_EQ(RankOf(truth, hypotheses, kRounding, kRounding), 0) << degrees;
  }
}

TEST(ProposePosesTest, HalfATurnIsNotAveragedWithItsNegative) {
  // Along the axes a half turn is exact: votes of both +pi and -pi, and of
  // angles just beyond on either side.
  for (const double noise : {0., 1e-7, 1e-3, 0.02}) {
    const Rigid2 truth(2., 1., M_PI);
    const Problem problem = MakeMatchingProblem(truth, 40, 0, noise);
    const Rigid2 best = Propose(problem).front();
    EXPECT_GT(std::abs(best.rotation()), M_PI - 0.11) << noise;
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
  const std::vector<Rigid2> hypotheses = Propose(square);
  EXPECT_EQ(RankOf(Rigid2(0., 0., M_PI), hypotheses, 1e-5, 1e-5), 0);
  for (const Rigid2& pose : hypotheses) {
    EXPECT_GT(std::abs(pose.rotation()), 3.1);
  }
}

TEST(ProposePosesTest, ThePoseIsAmongTheFirstWithNinetyPercentOutliers) {
  for (int degrees = -180; degrees < 180; degrees += 20) {
    const Rigid2 truth(-4., 9., degrees * M_PI / 180.);
    const int rank =
        RankOf(truth, Propose(MakeMatchingProblem(truth, 50, 450, 0.05)));
    EXPECT_GE(rank, 0) << degrees;
    EXPECT_LT(rank, 3) << degrees;
  }
}

TEST(ProposePosesTest, ASymmetricPlaceYieldsBothPoses) {
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
  const std::vector<Rigid2> hypotheses = Propose(problem);
  for (const Rigid2& pose : {truth, truth * Rigid2(0., 0., M_PI)}) {
    const int rank = RankOf(pose, hypotheses, 0.01, 0.001);
    EXPECT_GE(rank, 0);
    EXPECT_LT(rank, 4);
  }
}

TEST(ProposePosesTest, NeedsAgreementInLengthOrientationAndBaseline) {
  const Rigid2 truth(0., 0., 3.1);  // near the cut of angles
  Problem pair = MakeMatchingProblem(truth, 2, 0);
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
  const PoseVotingOptions defaults;
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

TEST(ProposePosesTest, IgnoresTheOrderOfTheCorrespondences) {
  Problem problem = MakeMatchingProblem(Rigid2(1., 2., -3.), 40, 300, 0.05);
  const std::vector<Rigid2> expected = Propose(problem);
  std::mt19937 engine(7);
  for (int repetition = 0; repetition < 3; ++repetition) {
    Shuffle(&problem.correspondences, &engine);
    const std::vector<Rigid2> actual = Propose(problem);
    ASSERT_EQ(actual.size(), expected.size());
    for (size_t k = 0; k < expected.size(); ++k) {
      EXPECT_EQ(actual[k].translation(), expected[k].translation());
      EXPECT_EQ(actual[k].rotation(), expected[k].rotation());
    }
  }
}

TEST(ProposePosesTest, MovingTheQueryMovesThePosesInversely) {
  const Rigid2 truth(1., 2., 0.5);
  Problem problem = MakeMatchingProblem(truth, 40, 100, 0.03);
  const std::vector<Rigid2> before = Propose(problem);
  const FeatureSet query = problem.query;
  for (const Rigid2& T_new_old :
       {Rigid2(30., -70., 0.), Rigid2(0., 0., 1.), Rigid2(-5., 3., -2.8)}) {
    problem.query = Moved(T_new_old, query);
    const std::vector<Rigid2> after = Propose(problem);
    // The raster of rotations does not turn along: same pose, other votes.
    EXPECT_GE(RankOf(truth * T_new_old.Inverse(), after, 0.5, 0.1), 0);
    EXPECT_LT(RankOf(truth * T_new_old.Inverse(), after, 0.5, 0.1), 3);
    if (T_new_old.rotation() != 0.) continue;
    ASSERT_EQ(after.size(), before.size());
    const Rigid2 error = before[0].Inverse() * after[0] * T_new_old;
    EXPECT_LT(error.translation().norm(), 1e-3);
    EXPECT_LT(std::abs(error.rotation()), 1e-4);
  }
}

TEST(ProposePosesTest, NoneFromLessThanAPair) {
  EXPECT_TRUE(Propose(Problem()).empty());
  EXPECT_TRUE(Propose(MakeMatchingProblem({}, 1, 0)).empty());
  Problem same = MakeMatchingProblem({}, 3, 0);
  same.correspondences.assign(10, {1, 1, 0.1f});
  EXPECT_TRUE(Propose(same).empty());
}

TEST(ProposePosesTest, SurvivesPlacesThatAreAbsurdlyFar) {
  for (const double far : {1e6, 1e12, 1e30, -1e30}) {
    EXPECT_NO_FATAL_FAILURE(
        (void)Propose(MakeMatchingProblem(Rigid2(far, 0.5 * far, 1.), 5, 0)));
  }
}

// A mean over a bin of exact votes: the rounding of float alone.
constexpr double kExact = 1e-4;

std::vector<WeightedCorrespondence> TrueOnes(const Rigid2& T_reference_query,
                                             const int count,
                                             std::mt19937* const engine) {
  std::vector<WeightedCorrespondence> correspondences;
  for (int k = 0; k < count; ++k) {
    const double x = Uniform(-8., 8., engine);
    const Eigen::Vector2d p(x, Uniform(-8., 8., engine));
    correspondences.push_back(
        {(T_reference_query * p).cast<float>(), p.cast<float>(),
         static_cast<float>(T_reference_query.rotation()), 1.f});
  }
  return correspondences;
}

void ExpectNear(const Rigid2& pose, const Rigid2& truth) {
  EXPECT_LT((pose.translation() - truth.translation()).norm(), kExact);
  EXPECT_LT(std::abs(NormalizeAngle(pose.rotation() - truth.rotation())),
            kExact);
}

TEST(VotePosesTest, FindsThePoseThatAllAgreeOnHoweverItIsTurned) {
  std::mt19937 engine(42);
  for (const double rotation : {-M_PI, -3.1, -1., 0., 0.4, 3.1, M_PI}) {
    const Rigid2 truth(3.3, -12.1, rotation);
    const auto poses =
        VotePoses({}, 1, Eigen::Vector2d::Zero(), TrueOnes(truth, 20, &engine));
    ASSERT_EQ(poses.size(), 1u) << rotation;
    ExpectNear(poses[0].T_reference_query, truth);
    // All 190 pairs but those too near each other; rounding may spread exact
    // votes over the eight bins around a corner of the raster.
    EXPECT_LE(poses[0].weight, 190.);
    EXPECT_GE(poses[0].weight, 170. / 8.);
  }
}

TEST(VotePosesTest, FindsBothPosesOfAPlaceThatIsThereTwice) {
  std::mt19937 engine(42);
  const Rigid2 often(5., 1., 0.3), seldom(-9., 2., -2.5);
  auto correspondences = TrueOnes(often, 20, &engine);
  const auto others = TrueOnes(seldom, 12, &engine);
  correspondences.insert(correspondences.end(), others.begin(), others.end());
  // Bins beside each other may share the votes of one pose.
  const std::vector<VotedPose> poses = KeepDistinct(
      VotePoses({}, 16, Eigen::Vector2d::Zero(), correspondences),
      [](const VotedPose& pose) { return pose.T_reference_query; },
      Eigen::Vector2d::Zero(), {1., 0.3}, 2);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_GT(poses[0].weight, poses[1].weight);
  EXPECT_LT(
      (poses[0].T_reference_query.translation() - often.translation()).norm(),
      0.1);
  EXPECT_LT(
      (poses[1].T_reference_query.translation() - seldom.translation()).norm(),
      0.1);
}

TEST(VotePosesTest, HeavierCorrespondencesArePreferred) {
  std::mt19937 engine(42);
  const Rigid2 heavy(5., 1., 0.3), light(-9., 2., -2.5);
  auto correspondences = TrueOnes(light, 20, &engine);
  for (WeightedCorrespondence c : TrueOnes(heavy, 10, &engine)) {
    c.weight = 3.f;
    correspondences.push_back(c);
  }
  ASSERT_FALSE(
      VotePoses({}, 1, Eigen::Vector2d::Zero(), correspondences).empty());
  ExpectNear(VotePoses({}, 1, Eigen::Vector2d::Zero(), correspondences)[0]
                 .T_reference_query,
             heavy);
  // Where only so many may be paired, the light ones have no say at all.
  PoseVotingOptions options;
  options.max_num_correspondences = 10;
  std::stable_sort(
      correspondences.begin(), correspondences.end(),
      [](const auto& a, const auto& b) { return a.weight > b.weight; });
  for (const VotedPose& pose :
       VotePoses(options, 10, Eigen::Vector2d::Zero(), correspondences)) {
    ExpectNear(pose.T_reference_query, heavy);
  }
}

TEST(VotePosesTest, NoneWherePairsDoNotAgree) {
  std::mt19937 engine(42);
  EXPECT_TRUE(VotePoses({}, 3, Eigen::Vector2d::Zero(), {}).empty());
  EXPECT_TRUE(
      VotePoses({}, 3, Eigen::Vector2d::Zero(), TrueOnes({}, 1, &engine))
          .empty());
  const WeightedCorrespondence at{{0.f, 0.f}, {0.f, 0.f}, 0.f, 1.f};
  const auto pair = [&at](const float x_reference, const float x_query,
                          const float rotation) {
    return std::vector<WeightedCorrespondence>{
        at, {{x_reference, 0.f}, {x_query, 0.f}, rotation, 1.f}};
  };
  EXPECT_EQ(
      VotePoses({}, 1, Eigen::Vector2d::Zero(), pair(4.f, 4.f, 0.f)).size(),
      1u);
  EXPECT_EQ(
      VotePoses({}, 1, Eigen::Vector2d::Zero(), pair(4.f, 4.15f, 0.4f)).size(),
      1u);
  EXPECT_TRUE(VotePoses({}, 1, Eigen::Vector2d::Zero(), pair(4.f, 4.3f, 0.f))
                  .empty());  // length
  EXPECT_TRUE(VotePoses({}, 1, Eigen::Vector2d::Zero(), pair(4.f, 4.f, 0.5f))
                  .empty());  // rotation
  EXPECT_TRUE(VotePoses({}, 1, Eigen::Vector2d::Zero(), pair(-4.f, 4.f, 0.f))
                  .empty());  // turned
  EXPECT_TRUE(VotePoses({}, 1, Eigen::Vector2d::Zero(), pair(1.4f, 1.4f, 0.f))
                  .empty());  // too near
}

TEST(VotePosesTest, MeasuresFromTheCentroid) {
  // The same correspondences, seen from a query frame whose origin lies
  // elsewhere: its pose moves along, votes and weights stay.
  std::mt19937 engine(42);
  const Rigid2 truth(3.3, -12.1, 0.7);
  const auto correspondences = TrueOnes(truth, 20, &engine);
  const Eigen::Vector2d centroid(4., -2.);
  const auto at_centroid =
      VotePoses({}, 1, Eigen::Vector2d::Zero(), correspondences);
  const auto from_origin = VotePoses({}, 1, centroid, correspondences);
  ASSERT_EQ(at_centroid.size(), 1u);
  ASSERT_EQ(from_origin.size(), 1u);
  EXPECT_EQ(from_origin[0].weight, at_centroid[0].weight);
  ExpectNear(from_origin[0].T_reference_query * Rigid2(centroid, 0.),
             at_centroid[0].T_reference_query);
}

TEST(VotePosesTest, OrdersByWeight) {
  // Exact votes meet in one bin, here well within it.
  std::mt19937 engine(42);
  const Rigid2 truth(0.25, 0.25, 0.05);
  auto correspondences = TrueOnes(truth, 10, &engine);
  for (int k = 0; k < 100; ++k) {
    const Eigen::Vector2f p(static_cast<float>(Uniform(-8., 8., &engine)),
                            static_cast<float>(Uniform(-8., 8., &engine)));
    const Eigen::Vector2f q(static_cast<float>(Uniform(-8., 8., &engine)),
                            static_cast<float>(Uniform(-8., 8., &engine)));
    correspondences.push_back(
        {p, q, static_cast<float>(Uniform(-3., 3., &engine)), 1.f});
  }
  PoseVotingOptions options;
  options.min_baseline_meters = 1e-3;
  const auto poses =
      VotePoses(options, 60, Eigen::Vector2d::Zero(), correspondences);
  ASSERT_GT(poses.size(), 1u);
  for (size_t k = 1; k < poses.size(); ++k) {
    EXPECT_LE(poses[k].weight, poses[k - 1].weight);
  }
  EXPECT_GE(poses[0].weight, 10 * 9 / 2);
  // The best correspondences come first; the others are not paired.
  options.max_num_correspondences = 10;
  double total = 0.;
  for (const VotedPose& pose :
       VotePoses(options, 60, Eigen::Vector2d::Zero(), correspondences)) {
    total += pose.weight;
  }
  EXPECT_EQ(total, 10 * 9 / 2);
}

TEST(VotePosesTest, SurvivesPlacesThatAreAbsurdlyFar) {
  std::mt19937 engine(42);
  for (const float far :
       {1e6f, 1e20f, std::numeric_limits<float>::infinity(), std::nanf("")}) {
    auto correspondences = TrueOnes({}, 5, &engine);
    for (auto& c : correspondences) c.p_reference.x() += far;
    EXPECT_NO_FATAL_FAILURE(
        (void)VotePoses({}, 3, Eigen::Vector2d::Zero(), correspondences));
  }
}

TEST(HypothesisOptionsTest, ValidateNamesTheOption) {
  EXPECT_EQ(Validate(HypothesisOptions()), "");
  using ::testing::HasSubstr;
  HypothesisOptions none;
  none.max_num_hypotheses = 0;
  EXPECT_THAT(Validate(none), HasSubstr("max_num_hypotheses"));
  const auto error = [](const auto member, const auto value) {
    HypothesisOptions options;
    options.votes.*member = value;
    return Validate(options);
  };
  EXPECT_THAT(error(&PoseVotingOptions::max_num_correspondences, 1),
              HasSubstr("max_num_correspondences"));
  EXPECT_THAT(error(&PoseVotingOptions::max_orientation_difference, M_PI),
              HasSubstr("max_orientation_difference"));
  EXPECT_THAT(error(&PoseVotingOptions::max_length_difference_meters, 0.),
              HasSubstr("max_length_difference_meters"));
  EXPECT_THAT(error(&PoseVotingOptions::min_baseline_meters, 0.),
              HasSubstr("min_baseline_meters"));
  HypothesisOptions coarse;
  coarse.votes.bins.distance_meters = 0.;
  EXPECT_THAT(Validate(coarse), HasSubstr("distance_meters"));
  coarse.votes.bins = {0.5, std::nan("")};
  EXPECT_THAT(Validate(coarse), HasSubstr("rotation"));
}

}  // namespace
}  // namespace cartographer_sdf::pose_voter_test
