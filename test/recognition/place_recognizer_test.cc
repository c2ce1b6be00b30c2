// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/place_recognizer.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"

namespace cartographer_sdf::place_recognizer_test {
namespace {

using testing::IsPoseNear;

constexpr double kDegree = M_PI / 180.;
const Rigid2 kWorldWest(3., 2., 0.4);
const Rigid2 kWorldQuery(4., 3., -1.);

Place See(const Rigid2& T_world_submap, const testing::Viewpoints& viewpoints,
          const SubmapId& id) {
  std::optional<Place> place = DescribePlace(
      PlaceOptions(), id,
      testing::SeeFrom(testing::TwoRooms(), T_world_submap, viewpoints));
  CHECK(place.has_value());
  return *std::move(place);
}

std::vector<Place> Rooms() {
  return {See(kWorldWest, testing::WestRoomViewpoints(), {0, 0}),
          See(Rigid2(12., 2., 1.4), testing::EastRoomViewpoints(), {0, 1}),
          See(Rigid2(2., 2., 3.), testing::WestRoomViewpoints(), {1, 5})};
}

Place Query() {
  return See(kWorldQuery, {{2.2, 2.4}, {4.4, 3.2}, {6.3, 4.2}, {2., 1.}},
             {2, 0});
}

std::vector<SubmapId> Accepted(const std::vector<Match>& matches) {
  std::vector<SubmapId> references;
  for (const Match& match : matches) {
    if (match.verdict == Verdict::kAccepted) {
      references.push_back(match.pair.reference);
    }
  }
  return references;
}

TEST(PlaceRecognizerTest, RecognisesWhatItRemembers) {
  PlaceRecognizer recognizer{RetrievalOptions(), MatchOptions()};
  const Place query = Query();
  EXPECT_TRUE(recognizer.Recognize(query).matches.empty());
  for (Place& room : Rooms()) recognizer.Remember(std::move(room));
  EXPECT_EQ(recognizer.places().size(), 3u);

  const std::vector<Match> matches = recognizer.Recognize(query).matches;
  EXPECT_THAT(Accepted(matches),
              ::testing::UnorderedElementsAre(SubmapId{0, 0}, SubmapId{1, 5}));
  for (size_t k = 0; k < matches.size(); ++k) {
    if (k > 0) {
      EXPECT_LT(matches[k - 1].pair.reference, matches[k].pair.reference);
    }
    EXPECT_EQ(matches[k].pair.query, query.id);
    if (matches[k].pair.reference != (SubmapId{0, 0})) continue;
    // At the room's middle.
    const Rigid2 T_world_room(3.5, 2.5, 0.);
    EXPECT_THAT(kWorldWest * matches[k].pair.T_reference_query *
                    kWorldQuery.Inverse() * T_world_room,
                IsPoseNear(T_world_room, 0.1, kDegree));
  }
}

TEST(PlaceRecognizerTest, MatchesAsManyCandidatesAsAsked) {
  PlaceRecognizer recognizer{RetrievalOptions(), MatchOptions()};
  for (Place& room : Rooms()) recognizer.Remember(std::move(room));
  const auto one = recognizer.RecognizeAmongBest(Query(), 1);
  EXPECT_EQ(one.num_candidates, 1u);
  // The best candidate is one of the two views of the room.
  EXPECT_THAT(Accepted(one.matches), ::testing::SizeIs(1));
  EXPECT_EQ(recognizer.RecognizeAmongBest(Query(), 100).num_candidates, 3u);
}

TEST(PlaceRecognizerTest, ForgottenAndExcludedPlacesAreNotMatched) {
  PlaceRecognizer recognizer{RetrievalOptions(), MatchOptions()};
  for (Place& room : Rooms()) recognizer.Remember(std::move(room));
  const Place query = Query();
  EXPECT_THAT(Accepted(recognizer
                           .Recognize(query,
                                      [](const SubmapId& id) {
                                        return id.trajectory == 0;
                                      })
                           .matches),
              ::testing::ElementsAre(SubmapId{1, 5}));
  EXPECT_TRUE(recognizer.Forget({1, 5}));
  EXPECT_FALSE(recognizer.Forget({1, 5}));
  EXPECT_THAT(Accepted(recognizer.Recognize(query).matches),
              ::testing::ElementsAre(SubmapId{0, 0}));
  EXPECT_TRUE(recognizer.Forget({0, 0}));
  EXPECT_TRUE(recognizer.Forget({0, 1}));
  EXPECT_TRUE(recognizer.places().empty());
  EXPECT_TRUE(recognizer.Recognize(query).matches.empty());
  recognizer.Remember(Rooms()[2]);
  EXPECT_THAT(Accepted(recognizer.Recognize(query).matches),
              ::testing::ElementsAre(SubmapId{1, 5}));
}

TEST(PlaceRecognizerTest, OrderOfRememberingDoesNotMatter) {
  PlaceRecognizer forward{RetrievalOptions(), MatchOptions()};
  PlaceRecognizer backward{RetrievalOptions(), MatchOptions()};
  std::vector<Place> rooms = Rooms();
  for (size_t k = 0; k < rooms.size(); ++k) {
    forward.Remember(rooms[k]);
    backward.Remember(rooms[rooms.size() - 1 - k]);
  }
  const auto a = forward.Recognize(Query()).matches;
  const auto b = backward.Recognize(Query()).matches;
  ASSERT_EQ(a.size(), b.size());
  ASSERT_FALSE(a.empty());
  for (size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].pair.reference, b[k].pair.reference);
    EXPECT_EQ(a[k].pair.score, b[k].pair.score);
  }
}

TEST(PlaceRecognizerDeathTest, KnowsEachIdOnce) {
  PlaceRecognizer recognizer{RetrievalOptions(), MatchOptions()};
  const Place room = Rooms()[0];
  recognizer.Remember(room);
  EXPECT_DEATH(recognizer.Remember(room), "0,0 is known already");
}

}  // namespace
}  // namespace cartographer_sdf::place_recognizer_test
