// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/retrieval/pose_votes.h"

#include <cmath>
#include <limits>
#include <random>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/feature_sets.h"

namespace cartographer_sdf {
namespace {

using ::testing::HasSubstr;
using testing::Uniform;

// A mean over a bin of exact votes: the rounding of float alone.
constexpr double kExact = 1e-4;

std::vector<WeightedCorrespondence> TrueOnes(const Rigid2& T_reference_middle,
                                             const int count,
                                             std::mt19937* const engine) {
  std::vector<WeightedCorrespondence> correspondences;
  for (int k = 0; k < count; ++k) {
    const double x = Uniform(-8., 8., engine);
    const Eigen::Vector2d p(x, Uniform(-8., 8., engine));
    correspondences.push_back(
        {(T_reference_middle * p).cast<float>(), p.cast<float>(),
         static_cast<float>(T_reference_middle.rotation()), 1.f});
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
    const auto poses = VotePoses({}, 1, TrueOnes(truth, 20, &engine));
    ASSERT_EQ(poses.size(), 1u) << rotation;
    ExpectNear(poses[0].T_reference_middle, truth);
    // All 190 pairs but those too near each other, and at least an eighth of
    // each in the fullest bin.
    EXPECT_LE(poses[0].weight, 190.);
    EXPECT_GE(poses[0].weight, 180. / 8.);
  }
}

TEST(VotePosesTest, FindsBothPosesOfAPlaceThatIsThereTwice) {
  std::mt19937 engine(42);
  const Rigid2 often(5., 1., 0.3), seldom(-9., 2., -2.5);
  auto correspondences = TrueOnes(often, 20, &engine);
  const auto others = TrueOnes(seldom, 12, &engine);
  correspondences.insert(correspondences.end(), others.begin(), others.end());
  const auto poses = VotePoses({}, 2, correspondences);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_GT(poses[0].weight, poses[1].weight);
  EXPECT_LT(
      (poses[0].T_reference_middle.translation() - often.translation()).norm(),
      0.1);
  EXPECT_LT(
      (poses[1].T_reference_middle.translation() - seldom.translation()).norm(),
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
  ASSERT_FALSE(VotePoses({}, 1, correspondences).empty());
  ExpectNear(VotePoses({}, 1, correspondences)[0].T_reference_middle, heavy);
  // Where only so many may be paired, the light ones have no say at all.
  PoseVoteOptions options;
  options.max_num_correspondences = 10;
  EXPECT_EQ(VotePoses(options, 10, correspondences).size(), 1u);
}

TEST(VotePosesTest, NoneWherePairsDoNotAgree) {
  std::mt19937 engine(42);
  EXPECT_TRUE(VotePoses({}, 3, {}).empty());
  EXPECT_TRUE(VotePoses({}, 3, TrueOnes({}, 1, &engine)).empty());
  const WeightedCorrespondence at{{0.f, 0.f}, {0.f, 0.f}, 0.f, 1.f};
  const auto pair = [&at](const float x_reference, const float x_query,
                          const float rotation) {
    return std::vector<WeightedCorrespondence>{
        at, {{x_reference, 0.f}, {x_query, 0.f}, rotation, 1.f}};
  };
  EXPECT_EQ(VotePoses({}, 1, pair(4.f, 4.f, 0.f)).size(), 1u);
  EXPECT_EQ(VotePoses({}, 1, pair(4.f, 4.2f, 0.3f)).size(), 1u);
  EXPECT_TRUE(VotePoses({}, 1, pair(4.f, 4.3f, 0.f)).empty());   // length
  EXPECT_TRUE(VotePoses({}, 1, pair(4.f, 4.f, 0.4f)).empty());   // rotation
  EXPECT_TRUE(VotePoses({}, 1, pair(-4.f, 4.f, 0.f)).empty());   // turned
  EXPECT_TRUE(VotePoses({}, 1, pair(0.9f, 0.9f, 0.f)).empty());  // too near
}

TEST(VotePosesTest, SurvivesPlacesThatAreAbsurdlyFar) {
  std::mt19937 engine(42);
  for (const float far :
       {1e6f, 1e20f, std::numeric_limits<float>::infinity(), std::nanf("")}) {
    auto correspondences = TrueOnes({}, 5, &engine);
    for (auto& c : correspondences) c.p_reference.x() += far;
    EXPECT_NO_FATAL_FAILURE((void)VotePoses({}, 3, correspondences));
  }
}

TEST(PoseVoteOptionsTest, ValidateNamesTheOption) {
  EXPECT_EQ(Validate(PoseVoteOptions()), "");
  const auto error = [](const auto member, const auto value) {
    PoseVoteOptions options;
    options.*member = value;
    return Validate(options);
  };
  EXPECT_THAT(error(&PoseVoteOptions::max_num_correspondences, 1),
              HasSubstr("max_num_correspondences"));
  EXPECT_THAT(error(&PoseVoteOptions::max_length_difference_meters, 0.),
              HasSubstr("max_length_difference_meters"));
  EXPECT_THAT(error(&PoseVoteOptions::max_orientation_difference, M_PI),
              HasSubstr("max_orientation_difference"));
  EXPECT_THAT(error(&PoseVoteOptions::min_baseline_meters, 0.),
              HasSubstr("min_baseline_meters"));
  EXPECT_THAT(error(&PoseVoteOptions::bin_distance_meters, std::nan("")),
              HasSubstr("bin_distance_meters"));
  EXPECT_THAT(error(&PoseVoteOptions::bin_rotation, 0.),
              HasSubstr("bin_rotation"));
}

}  // namespace
}  // namespace cartographer_sdf
