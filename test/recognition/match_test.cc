// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/match.h"

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"

namespace cartographer_sdf::match_test {
namespace {

using testing::IsPoseNear;

constexpr double kDegree = M_PI / 180.;

const testing::Viewpoints& OtherWestRoomViewpoints() {
  static const auto* const kViewpoints =
      new testing::Viewpoints{{2.2, 2.4}, {4.4, 3.2}, {6.3, 4.2}, {2., 1.}};
  return *kViewpoints;
}

Place See(const Rigid2& T_world_submap, const testing::Viewpoints& viewpoints,
          const SubmapId& id) {
  std::optional<Place> place = DescribePlace(
      PlaceOptions(), id,
      testing::SeeFrom(testing::TwoRooms(), T_world_submap, viewpoints));
  CHECK(place.has_value());
  return *std::move(place);
}

class MatchPlacesTest : public ::testing::TestWithParam<Method> {
 protected:
  [[nodiscard]] static MatchOptions Options() {
    if (GetParam() == Method::kPaper) return PaperMatchOptions();
    return MatchOptions();
  }
};
INSTANTIATE_TEST_SUITE_P(Methods, MatchPlacesTest,
                         ::testing::Values(Method::kSdf, Method::kPaper),
                         [](const auto& test) {
                           return test.param == Method::kSdf ? "Sdf" : "Paper";
                         });

TEST_P(MatchPlacesTest, FindsTheOtherViewWhateverTheFrames) {
  const Rigid2 T_world_reference(3., 2., 0.4);
  const Place reference =
      See(T_world_reference, testing::WestRoomViewpoints(), {0, 1});
  for (const Rigid2& T_world_query :
       {Rigid2(3., 2., 0.4), Rigid2(4., 3., -1.), Rigid2(5., 1., 2.),
        Rigid2(-20., 7., -2.7)}) {
    const Place query = See(T_world_query, OtherWestRoomViewpoints(), {0, 7});
    const std::optional<Match> match = MatchPlaces(Options(), reference, query);
    ASSERT_TRUE(match.has_value());
    EXPECT_STREQ(VerdictName(match->verdict), "accepted") << T_world_query;
    // At the room's middle.
    const Rigid2 T_world_room(3.5, 2.5, 0.);
    EXPECT_THAT(T_world_reference * match->pair.T_reference_query *
                    T_world_query.Inverse() * T_world_room,
                IsPoseNear(T_world_room, 0.1, kDegree))
        << T_world_query;
  }
}

TEST_P(MatchPlacesTest, RoomsThatDifferDoNotMatch) {
  const Place west =
      See(Rigid2(3., 2., 0.4), testing::WestRoomViewpoints(), {0, 1});
  const Place east =
      See(Rigid2(12., 2., 1.4), testing::EastRoomViewpoints(), {0, 7});
  for (const auto& [reference, query] :
       {std::pair(&west, &east), std::pair(&east, &west)}) {
    const std::optional<Match> match =
        MatchPlaces(Options(), *reference, *query);
    EXPECT_TRUE(!match || match->verdict != Verdict::kAccepted)
        << match->pair.score;
  }
}

TEST_P(MatchPlacesTest, FillsInTheEvidence) {
  const Rigid2 T_world_reference(3., 2., 0.4), T_world_query(4., 3., -1.);
  const Place reference =
      See(T_world_reference, testing::WestRoomViewpoints(), {0, 1});
  const Place query = See(T_world_query, OtherWestRoomViewpoints(), {3, 7});
  const std::optional<Match> match = MatchPlaces(Options(), reference, query);
  ASSERT_TRUE(match.has_value());
  EXPECT_EQ(match->pair.reference, (SubmapId{0, 1}));
  EXPECT_EQ(match->pair.query, (SubmapId{3, 7}));
  const PairEvidence& evidence = match->evidence;
  EXPECT_GE(match->inliers.size(), 12u);
  for (const auto& [p_reference, p_query] : match->inliers) {
    EXPECT_LT(
        (T_world_reference * p_reference - T_world_query * p_query).norm(),
        0.4);
  }
  if (GetParam() == Method::kPaper) {
    EXPECT_EQ(match->pair.score, match->inliers.size());
    EXPECT_EQ(evidence.overlap_area, 0.);
    return;
  }
  EXPECT_GT(match->pair.score, 3.);
  EXPECT_NEAR(evidence.overlap_area, 36., 1.);
  EXPECT_GT(evidence.overlap, 0.9);
  EXPECT_GT(evidence.HitRatio(), 0.9);
  EXPECT_LE(evidence.HitRatio(), 1.);
  EXPECT_LT(evidence.ContradictionRatio(), 0.004);
  EXPECT_GT(evidence.WallDistance(), 0.);
  EXPECT_LT(evidence.WallDistance(), 0.05);
  EXPECT_EQ(match->pair.score, match->pair_score);
  EXPECT_EQ(match->pair.score,
            Score(ScoreWeights(), match->evidence, match->margin));
  EXPECT_EQ(match->verdict, Judge(JudgementOptions(), match->evidence,
                                  match->pair.score, match->margin));
  EXPECT_FALSE(match->neighbourhood.has_value());
}

TEST_P(MatchPlacesTest, IsDeterministic) {
  const Place reference =
      See(Rigid2(3., 2., 0.4), testing::WestRoomViewpoints(), {0, 1});
  const Place query =
      See(Rigid2(4., 3., -1.), OtherWestRoomViewpoints(), {0, 7});
  const std::optional<Match> one = MatchPlaces(Options(), reference, query);
  const std::optional<Match> other = MatchPlaces(Options(), reference, query);
  ASSERT_TRUE(one.has_value() && other.has_value());
  EXPECT_EQ(one->pair.T_reference_query.translation(),
            other->pair.T_reference_query.translation());
  EXPECT_EQ(one->pair.T_reference_query.rotation(),
            other->pair.T_reference_query.rotation());
  EXPECT_EQ(one->pair.score, other->pair.score);
  EXPECT_EQ(one->inliers, other->inliers);
}

// The same cells in another submap frame.
TEST_P(MatchPlacesTest, MovesWithTheSubmapFrame) {
  const Place reference =
      See(Rigid2(3., 2., 0.4), testing::WestRoomViewpoints(), {0, 1});
  OccupancyGrid grid = testing::SeeFrom(
      testing::TwoRooms(), Rigid2(4., 3., -1.), OtherWestRoomViewpoints());
  const std::optional<Place> query =
      DescribePlace(PlaceOptions(), {0, 7}, grid);
  const Rigid2 T_moved_query(12., -7., 2.1);
  grid.geometry.T_submap_grid = T_moved_query * grid.geometry.T_submap_grid;
  const std::optional<Place> moved =
      DescribePlace(PlaceOptions(), {0, 7}, grid);
  ASSERT_TRUE(query.has_value() && moved.has_value());
  const std::optional<Match> there = MatchPlaces(Options(), reference, *query);
  const std::optional<Match> here = MatchPlaces(Options(), reference, *moved);
  ASSERT_TRUE(there.has_value() && here.has_value());
  // Only rounding differs; the clusters of hypotheses may feel it.
  EXPECT_THAT(here->pair.T_reference_query * T_moved_query,
              IsPoseNear(there->pair.T_reference_query, 5e-3, 1e-3));
}

TEST_P(MatchPlacesTest, NoneForPlacesWithoutFeatures) {
  const Place room =
      See(Rigid2(3., 2., 0.4), testing::WestRoomViewpoints(), {0, 1});
  CellGeometry geometry;
  geometry.size = {40, 30};
  OccupancyGrid grid = UnknownGrid(geometry);
  grid.known(20, 15) = true;
  grid.known(0, 0) = true;
  grid.probability(20, 15) = 0.8f;
  const std::optional<Place> post = DescribePlace(PlaceOptions(), {0, 7}, grid);
  ASSERT_TRUE(post.has_value());
  EXPECT_FALSE(MatchPlaces(Options(), room, *post).has_value());
  EXPECT_FALSE(MatchPlaces(Options(), *post, room).has_value());
  EXPECT_FALSE(MatchPlaces(Options(), *post, *post).has_value());
}

TEST(FindSelfSimilaritiesTest, MakeTwinsAmbiguous) {
  // Alike after a half turn.
  testing::Building building = testing::BareRoom(9., 6.);
  for (const double sign : {-1., 1.}) {
    building.push_back(testing::Furniture(sign * 2.5, sign * 1., 1., 0.6, 0.3));
    building.push_back(
        testing::Furniture(sign * 1.1, -sign * 1.7, 0.5, 1.2, -0.5));
  }
  const testing::Viewpoints viewpoints = {{-3., 2.}, {3., -2.}, {0., 0.}};
  std::optional<Place> reference = DescribePlace(
      PlaceOptions(), {0, 1},
      testing::SeeFrom(building, Rigid2(0.3, 0.1, 0.4), viewpoints));
  const std::optional<Place> query = DescribePlace(
      PlaceOptions(), {0, 7},
      testing::SeeFrom(building, Rigid2(-0.2, 0.5, -1.), viewpoints));
  ASSERT_TRUE(reference.has_value() && query.has_value());
  FindSelfSimilarities(MatchOptions(), &*reference);
  EXPECT_FALSE(reference->surface.self_similar_poses.empty());
  const std::optional<Match> match =
      MatchPlaces(MatchOptions(), *reference, *query);
  ASSERT_TRUE(match.has_value());
  EXPECT_STREQ(VerdictName(match->verdict), "ambiguous");
}

TEST(MatchOptionsTest, AreValidated) {
  EXPECT_EQ(Validate(MatchOptions()), "");
  EXPECT_EQ(Validate(PaperMatchOptions()), "");
  const auto error = [](const std::function<void(MatchOptions*)>& set) {
    MatchOptions options;
    set(&options);
    return Validate(options);
  };
  EXPECT_NE(error([](auto* o) { o->correspondence.num_neighbours = 0; }), "");
  EXPECT_NE(error([](auto* o) { o->hypotheses.max_num_hypotheses = 0; }), "");
  EXPECT_NE(error([](auto* o) { o->verification.judgement.min_margin = -1.; }),
            "");
  EXPECT_NE(error([](auto* o) { o->ransac.max_num_iterations = 0; }), "");
  EXPECT_NE(error([](auto* o) { o->inlier_distance_meters = 0.; }), "");
  EXPECT_NE(error([](auto* o) { o->min_num_inliers = 1; }), "");
}

}  // namespace
}  // namespace cartographer_sdf::match_test
