// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/verification/hypothesis_ranking.h"

#include <cmath>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"

namespace cartographer_sdf::hypothesis_ranking_test {
namespace {

using ::testing::IsEmpty;
using testing::IsPoseNear;
using ::testing::SizeIs;

constexpr double kDegree = M_PI / 180.;

// Two views of the west room.
class RankingTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<Rigid2> Rank(
      const std::vector<Rigid2>& hypotheses) const {
    return RankHypotheses(options_, reference_, query_, hypotheses,
                          ObservedCentroid(query_));
  }
  // The query, moved and turned about its centroid.
  [[nodiscard]] Rigid2 Off(const double x, const double y,
                           const double yaw) const {
    const Rigid2 T_query_centroid(ObservedCentroid(query_), 0.);
    return truth_ * T_query_centroid * Rigid2(x, y, yaw) *
           T_query_centroid.Inverse();
  }

  const Rigid2 T_world_reference_{3., 2., 0.4};
  const Rigid2 T_world_query_{4., 3., -1.};
  const Rigid2 truth_ = T_world_reference_.Inverse() * T_world_query_;
  const SurfaceModel reference_ = testing::SurfaceSeenFrom(
      testing::TwoRooms(), T_world_reference_, testing::WestRoomViewpoints());
  const SurfaceModel query_ =
      testing::SurfaceSeenFrom(testing::TwoRooms(), T_world_query_,
                               {{2.2, 2.4}, {4.4, 3.2}, {6.3, 4.2}, {2., 1.}});
  RankingOptions options_;
};

TEST_F(RankingTest, TheRightPoseIsFirst) {
  const std::vector<Rigid2> ranked =
      Rank({Off(2., 1., 1.), Off(0.1, -0.05, 2. * kDegree), Off(0., 0., M_PI)});
  ASSERT_FALSE(ranked.empty());
  EXPECT_THAT(ranked.front(), IsPoseNear(truth_, 0.3, 3. * kDegree));
}

TEST_F(RankingTest, PosesThatDoNotAgreeAreDropped) {
  EXPECT_THAT(Rank({Off(2., 1., 1.), Off(-1.5, 2., -2.)}), IsEmpty());
  EXPECT_THAT(Rank({}), IsEmpty());
}

TEST_F(RankingTest, NearlyEqualPosesAreOne) {
  const std::vector<Rigid2> ranked =
      Rank({Off(0.01, 0., 0.), Off(0., 0.01, 0.), Off(0., 0., 0.),
            Off(0.01, 0.01, 0.), Off(-0.01, 0., 0.)});
  // Polishing may turn one of them away from the others, once to either side.
  ASSERT_FALSE(ranked.empty());
  for (size_t k = 1; k < ranked.size(); ++k) {
    EXPECT_GT(
        std::abs(NormalizeAngle(ranked[k].rotation() - ranked[0].rotation())),
        3. * kDegree);
  }
}

TEST_F(RankingTest, DoesNotDependOnTheOrder) {
  std::vector<Rigid2> hypotheses = {Off(0.1, 0.1, 0.), Off(0., 0., 0.),
                                    Off(0.6, 0., 0.), Off(0., -0.6, 0.)};
  options_.min_fine_score = -1e9;
  options_.min_coarse_score = -1e9;
  options_.max_fine_score_gap = 1e9;
  const std::vector<Rigid2> ranked = Rank(hypotheses);
  EXPECT_THAT(ranked.size(), ::testing::Gt(1u));
  std::swap(hypotheses[0], hypotheses[3]);
  std::swap(hypotheses[1], hypotheses[2]);
  const std::vector<Rigid2> again = Rank(hypotheses);
  ASSERT_EQ(again.size(), ranked.size());
  for (size_t k = 0; k < ranked.size(); ++k) {
    EXPECT_THAT(again[k], IsPoseNear(ranked[k], 1e-12, 1e-12)) << k;
  }
}

TEST_F(RankingTest, KeepsNoMoreThanIsWanted) {
  options_.min_fine_score = -1e9;
  options_.min_coarse_score = -1e9;
  options_.max_fine_score_gap = 1e9;
  options_.num_refined = 2;
  EXPECT_THAT(Rank({Off(0., 0., 0.), Off(1., 0., 0.), Off(2., 0., 0.),
                    Off(0., 1., 0.)}),
              SizeIs(2));
}

TEST_F(RankingTest, PolishingTurnsBack) {
  for (const double degrees : {-6., 4.}) {
    const Rigid2 polished = PolishRotation(options_, reference_, query_,
                                           Off(0., 0., degrees * kDegree),
                                           ObservedCentroid(query_));
    EXPECT_LT(std::abs(NormalizeAngle(polished.rotation() - truth_.rotation())),
              0.5 * std::abs(degrees) * kDegree + 1e-9)
        << degrees;
  }
}

}  // namespace
}  // namespace cartographer_sdf::hypothesis_ranking_test
