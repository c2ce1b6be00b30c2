// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/verification.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"

namespace cartographer_sdf::verification_test {
namespace {

using testing::BareRoom;
using testing::Box;
using testing::Building;
using testing::Furniture;
using testing::IsPoseNear;
using testing::SurfaceSeenFrom;

constexpr double kDegree = M_PI / 180.;

// Two submaps with a known pose.
struct Pair {
  SurfaceModel reference;
  SurfaceModel query;
  Rigid2 truth;  // T_reference_query
};

Pair MakePair(const Building& reference_building,
              const testing::Viewpoints& reference_viewpoints,
              const Building& query_building,
              const testing::Viewpoints& query_viewpoints,
              const Rigid2& T_world_reference = Rigid2(0.3, -0.2, 0.),
              const Rigid2& T_world_query = Rigid2(-0.4, 0.6, 0.)) {
  return {SurfaceSeenFrom(reference_building, T_world_reference,
                          reference_viewpoints),
          SurfaceSeenFrom(query_building, T_world_query, query_viewpoints),
          T_world_reference.Inverse() * T_world_query};
}

// The west room of the two.
Pair WestRoom() {
  const Building building = testing::TwoRooms();
  return MakePair(building, testing::WestRoomViewpoints(), building,
                  {{2.2, 2.4}, {4.4, 3.2}, {6.3, 4.2}, {2., 1.}},
                  Rigid2(3., 2., 0.4), Rigid2(4., 3., -1.));
}

// The truth, a little off, among wrong poses.
std::vector<Rigid2> Hypotheses(const Rigid2& truth) {
  return {truth * Rigid2(3., 1., 2.), truth * Rigid2(-1.5, 0., 0.),
          truth * Rigid2(0.2, -0.1, 0.05), truth * Rigid2(0., 0., M_PI),
          truth * Rigid2(0., 2., -1.6)};
}

std::optional<VerifiedPose> Verify(const Pair& pair,
                                   const std::vector<Rigid2>& hypotheses) {
  return VerifyHypotheses(VerificationOptions(), pair.reference, pair.query,
                          hypotheses);
}

std::string VerdictOf(const std::optional<VerifiedPose>& verification) {
  return verification ? VerdictName(verification->verdict) : "none";
}

Building Joined(Building a, const Building& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(VerifyHypothesesTest, AcceptsTheRightPose) {
  const Pair pair = WestRoom();
  const std::optional<VerifiedPose> verification =
      Verify(pair, Hypotheses(pair.truth));
  ASSERT_EQ(VerdictOf(verification), "accepted");
  EXPECT_THAT(verification->T_reference_query,
              IsPoseNear(pair.truth, 0.02, 0.3 * kDegree));
  EXPECT_GE(verification->score, JudgementOptions().min_score);
  EXPECT_GT(verification->evidence.query_in_reference.HitRatio(), 0.95);
  EXPECT_GT(verification->evidence.reference_in_query.HitRatio(), 0.9);
  EXPECT_GT(verification->evidence.overlap, 0.9);
  EXPECT_NEAR(verification->evidence.overlap_area, 35., 1.5);
  EXPECT_EQ(verification->margin, kMaxMargin);
}

TEST(VerifyHypothesesTest, NoneWithoutAHypothesisWorthRefining) {
  const Pair pair = WestRoom();
  EXPECT_FALSE(Verify(pair, {}).has_value());
  EXPECT_FALSE(Verify(pair, {Rigid2(100., 0., 0.)}).has_value());
  EXPECT_FALSE(Verify(pair, {pair.truth * Rigid2(2., 1., 0.8)}).has_value());
}

TEST(VerifyHypothesesTest, TooLittleOverlap) {
  // A closet of 7 m^2, all of it seen.
  const Building closet =
      Joined(BareRoom(2.9, 2.6), {Furniture(0.7, 0.5, 0.8, 0.3, 0.2)});
  const Pair pair = MakePair(closet, {{-0.5, 0.}}, closet, {{0., -0.6}});
  const std::optional<VerifiedPose> verification = Verify(pair, {pair.truth});
  EXPECT_EQ(VerdictOf(verification), "too_little_overlap");
  EXPECT_LT(verification->evidence.overlap_area, 10.);
}

TEST(VerifyHypothesesTest, ContradictedByAWallInFreeSpace) {
  const Building room = BareRoom(8., 6.);
  const Building with_cupboard = Joined(
      room,
      {Furniture(1., 0.5, 1.6, 1.6, 0.), Furniture(-1.6, -0.3, 1.6, 1.6, 0.)});
  const testing::Viewpoints viewpoints = {{-3., -2.}, {3., 2.}, {-2., 2.}};
  const Pair pair = MakePair(room, viewpoints, with_cupboard, viewpoints);
  const std::optional<VerifiedPose> verification = Verify(pair, {pair.truth});
  EXPECT_EQ(VerdictOf(verification), "contradicted");
  EXPECT_THAT(verification->T_reference_query,
              IsPoseNear(pair.truth, 0.03, 0.5 * kDegree));
  EXPECT_GT(verification->evidence.query_in_reference.ContradictionRatio(),
            0.1);
  EXPECT_NEAR(verification->evidence.reference_in_query.ContradictionRatio(),
              0., 0.001);
}

TEST(VerifyHypothesesTest, UnlikelyWhereLittleAgrees) {
  // As above, but with less in the way: no gate is hit, yet the sum speaks
  // against it.
  const Building hall =
      Joined(BareRoom(14., 2.4), {Furniture(-6., 0.8, 1.2, 0.6, 0.)});
  const Building with_box = Joined(hall, {Furniture(2., 0., 0.7, 0.7, 0.)});
  const testing::Viewpoints viewpoints = {{-5., -0.7}, {5., 0.7}, {0., 0.}};
  const Pair pair = MakePair(hall, viewpoints, with_box, viewpoints);
  const std::optional<VerifiedPose> verification = Verify(pair, {pair.truth});
  EXPECT_EQ(VerdictOf(verification), "unlikely");
  EXPECT_LT(verification->score, JudgementOptions().min_score);
}

TEST(VerifyHypothesesTest, DegenerateInACorridor) {
  const Building corridor = BareRoom(60., 2.);
  const Pair pair =
      MakePair(corridor, {{-1., 0.}, {1., 0.}}, corridor, {{0., 0.}, {2., 0.}});
  const std::optional<VerifiedPose> verification = Verify(pair, {pair.truth});
  EXPECT_EQ(VerdictOf(verification), "degenerate");
  EXPECT_GT(verification->evidence.query_in_reference.HitRatio(), 0.95);
}

// Alike after a half turn.
Building SymmetricRoom() {
  return Joined(BareRoom(8., 6.), {Furniture(2., 1., 1., 0.6, 0.3),
                                   Furniture(-2., -1., 1., 0.6, 0.3)});
}

TEST(VerifyHypothesesTest, AmbiguousInASymmetricRoom) {
  const testing::Viewpoints viewpoints = {{-3., 2.}, {3., -2.}, {0., 0.}};
  const Pair pair =
      MakePair(SymmetricRoom(), viewpoints, SymmetricRoom(), viewpoints,
               Rigid2(0., 0., 0.2), Rigid2(0., 0., -0.1));
  const Rigid2 turned = pair.truth * Rigid2(0., 0., M_PI);
  const std::optional<VerifiedPose> verification =
      Verify(pair, {pair.truth, turned});
  EXPECT_EQ(VerdictOf(verification), "ambiguous");
  EXPECT_LT(verification->margin, 0.1);
  // The half turn is tried even where nobody proposed it.
  EXPECT_EQ(VerdictOf(Verify(pair, {pair.truth})), "ambiguous");
  EXPECT_EQ(VerdictOf(Verify(pair, {turned})), "ambiguous");
}

TEST(VerifyHypothesesTest, SelfSimilarPosesAreRivalsThatNobodyProposed) {
  // Two equal rooms side by side, farther apart than any slide is tried.
  const Rigid2 next_door(9., 0., 0.);
  const Building room = Joined(
      BareRoom(8., 6.),
      {Furniture(2., 1., 1., 0.6, 0.3), Furniture(-1., -2., 1.4, 0.5, 0.)});
  Building both = room;
  for (Box box : room) {
    box.T_world_box = next_door * box.T_world_box;
    both.push_back(box);
  }
  const testing::Viewpoints inside = {{-3., 2.}, {3., -2.}, {0., 0.}};
  testing::Viewpoints inside_both = inside;
  for (const Eigen::Vector2d& p : inside) {
    inside_both.push_back(next_door * p);
  }
  for (const bool of_reference : {true, false}) {
    Pair pair = of_reference ? MakePair(both, inside_both, room, inside,
                                        Rigid2(), Rigid2(0.2, 0.1, 0.3))
                             : MakePair(room, inside, both, inside_both,
                                        Rigid2(0.2, 0.1, 0.3), Rigid2());
    ASSERT_EQ(VerdictOf(Verify(pair, {pair.truth})), "accepted");
    (of_reference ? pair.reference : pair.query).self_similar_poses = {
        next_door};
    const std::optional<VerifiedPose> verification = Verify(pair, {pair.truth});
    EXPECT_EQ(VerdictOf(verification), "ambiguous");
    EXPECT_LT(verification->margin, 0.1);
  }
}

TEST(FindSelfSimilarPosesTest, FindsTheHalfTurnOfASymmetricRoom) {
  const SurfaceModel model = SurfaceSeenFrom(
      SymmetricRoom(), Rigid2(1., 2., 0.2), {{-3., 2.}, {3., -2.}, {0., 0.}});
  const Rigid2 half_turn = Rigid2(1., 2., 0.2).Inverse() *
                           Rigid2(0., 0., M_PI) * Rigid2(1., 2., 0.2);
  const std::vector<Rigid2> poses = FindSelfSimilarPoses(
      VerificationOptions(), model,
      {Rigid2(), Rigid2(0.1, 0., 0.02), half_turn * Rigid2(0.2, 0.1, 0.05)});
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_THAT(poses[0], IsPoseNear(half_turn, 0.03, 0.5 * kDegree));
}

TEST(FindSelfSimilarPosesTest, NoneWhereNothingIsAlike) {
  const Pair pair = WestRoom();
  EXPECT_TRUE(FindSelfSimilarPoses(VerificationOptions(), pair.reference,
                                   Hypotheses(Rigid2()))
                  .empty());
  EXPECT_TRUE(
      FindSelfSimilarPoses(VerificationOptions(), pair.reference, {}).empty());
}

TEST(VerifyHypothesesTest, OneThingBreaksASymmetry) {
  const testing::Viewpoints viewpoints = {{-3., 2.}, {3., -2.}, {0., 0.}};
  const Building room =
      Joined(SymmetricRoom(), {Furniture(2.6, -1.6, 0.9, 0.9, 0.2)});
  const Pair pair = MakePair(room, viewpoints, room, viewpoints);
  const std::optional<VerifiedPose> verification =
      Verify(pair, {pair.truth * Rigid2(0., 0., M_PI), pair.truth});
  EXPECT_EQ(VerdictOf(verification), "accepted");
  EXPECT_THAT(verification->T_reference_query,
              IsPoseNear(pair.truth, 0.03, 0.5 * kDegree));
}

void ExpectSame(const VerifiedPose& a, const VerifiedPose& b) {
  EXPECT_EQ(a.verdict, b.verdict);
  EXPECT_EQ(a.T_reference_query.translation(),
            b.T_reference_query.translation());
  EXPECT_EQ(a.T_reference_query.rotation(), b.T_reference_query.rotation());
  EXPECT_EQ(a.score, b.score);
  EXPECT_EQ(a.margin, b.margin);
}

TEST(VerifyHypothesesTest, DoesNotDependOnTheOrderOfHypotheses) {
  // A grid of poses of which many score the same: the room is seen twice by
  // the same grid, so that shifts to either side are equally bad.
  const testing::Viewpoints viewpoints = {{-3., 2.}, {3., -2.}, {0., 0.}};
  const Pair pair = MakePair(SymmetricRoom(), viewpoints, SymmetricRoom(),
                             viewpoints, Rigid2(), Rigid2());
  std::vector<Rigid2> hypotheses;
  for (const double yaw : {0., M_PI}) {
    for (int x = -5; x <= 5; ++x) {
      for (int y = -5; y <= 5; ++y) {
        hypotheses.emplace_back(0.35 * x, 0.35 * y, yaw);
      }
    }
  }
  const std::optional<VerifiedPose> expected = Verify(pair, hypotheses);
  ASSERT_TRUE(expected.has_value());
  ExpectSame(*expected, *Verify(pair, hypotheses));
  for (size_t shift = 0; shift < hypotheses.size(); shift += 40) {
    std::vector<Rigid2> permuted = hypotheses;
    std::rotate(permuted.begin(), permuted.begin() + shift, permuted.end());
    if (shift % 80 == 0) std::reverse(permuted.begin(), permuted.end());
    const std::optional<VerifiedPose> verification = Verify(pair, permuted);
    ASSERT_TRUE(verification.has_value());
    ExpectSame(*expected, *verification);
  }
}

TEST(PairEvidenceTest, GrowsWithTheNumberOfTilesThatAgree) {
  PairEvidence agreement;
  EXPECT_EQ(agreement.WallEvidence(), 0.);
  agreement.tiles = {16., 0.95};
  EXPECT_NEAR(agreement.WallEvidence(), 4. * 0.35, 1e-12);
  // Fewer than by chance.
  agreement.tiles = {16., 0.5};
  EXPECT_NEAR(agreement.WallEvidence(), -4. * 0.1, 1e-12);
}

TEST(ScoreTest, IsLinearInItsTerms) {
  PairEvidence agreement;
  agreement.query_in_reference = {100., 90., 2., 0.};
  agreement.reference_in_query = {50., 40., 2., 0.};
  agreement.tiles = {16., 0.95};
  agreement.overlap = 0.7;
  agreement.normal_scatter.diagonal() << 0.84, 0.16;
  const ScoreWeights weights{10., 3., 2., 5., 7., -4.};
  EXPECT_NEAR(Score(weights, agreement, 0.1),
              10. * std::log(0.05) + 3. * std::log(0.75) + 2. * 1.4 + 5. * 0.4 +
                  0.7 - 4.,
              1e-12);
}

TEST(VerdictTest, HasANameForEach) {
  EXPECT_STREQ(VerdictName(Verdict::kAccepted), "accepted");
  EXPECT_STREQ(VerdictName(Verdict::kTooLittleOverlap), "too_little_overlap");
  EXPECT_STREQ(VerdictName(Verdict::kContradicted), "contradicted");
  EXPECT_STREQ(VerdictName(Verdict::kUnlikely), "unlikely");
  EXPECT_STREQ(VerdictName(Verdict::kDegenerate), "degenerate");
  EXPECT_STREQ(VerdictName(Verdict::kAmbiguous), "ambiguous");
}

TEST(VerificationOptionsTest, AreValidated) {
  EXPECT_EQ(Validate(VerificationOptions()), "");
  const auto error = [](const std::function<void(VerificationOptions*)>& set) {
    VerificationOptions options;
    set(&options);
    return Validate(options);
  };
  EXPECT_NE(error([](auto* o) { o->agreement.max_num_points = 0; }), "");
  EXPECT_NE(error([](auto* o) { o->ranking.num_refined = 0; }), "");
  EXPECT_NE(error([](auto* o) { o->ranking.hit_distance_meters = 0.6; }), "");
  EXPECT_NE(error([](auto* o) { o->agreement.hit_distance_meters = NAN; }), "");
  EXPECT_NE(error([](auto* o) { o->judgement.min_margin = -1.; }), "");
  EXPECT_NE(error([](auto* o) { o->registration.num_iterations = 0; }), "");
}

}  // namespace
}  // namespace cartographer_sdf::verification_test
