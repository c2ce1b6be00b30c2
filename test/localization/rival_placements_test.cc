// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/rival_placements.h"

#include <vector>

#include "cartographer_sdf/execution/parallel_for.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/row_of_rooms.h"

namespace cartographer_sdf::rival_placements_test {
namespace {

using testing::Building;
using ::testing::Contains;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::kRoom;
using testing::MapOfRow;
using ::testing::Not;
using testing::RowOfRooms;
using testing::SeeRooms;

Contest FindRivals(const MapOfRow& map, const MapOfRow& query) {
  const PlacementOptions placement;
  const ConsistencyOptions consistency;
  const MatchOptions match;
  return FindRivalPlacements({placement,
                              consistency,
                              match,
                              {&map.places, &map.layout},
                              {&query.places, &query.layout}},
                             {{{0, 0}, {0, 0}, Rigid2(), 9.}}, 50,
                             MakeExecutor(1));
}

// By how far a placement moves the query, which is where it is.
std::vector<double> Shifts(const std::vector<MeasuredPlacement>& placements) {
  std::vector<double> shifts;
  for (const MeasuredPlacement& placement : placements) {
    shifts.push_back(placement.placement.T_map_query.translation().x());
  }
  return shifts;
}

TEST(RivalPlacementsTest, EqualRoomsNextDoorDoAsWell) {
  const Building row = RowOfRooms();
  const MapOfRow map = SeeRooms(row, -7., 7.), query = SeeRooms(row, -3., 3.);
  const Contest contest = FindRivals(map, query);
  EXPECT_THAT(Shifts({contest.placement}), ElementsAre(DoubleNear(0., 0.05)));
  EXPECT_THAT(Shifts(contest.rivals), Contains(DoubleNear(kRoom, 0.05)));
  EXPECT_THAT(Shifts(contest.rivals), Contains(DoubleNear(-kRoom, 0.05)));
  for (const MeasuredPlacement& rival : contest.rivals) {
    EXPECT_GT(rival.placement.score, 0.5 * contest.placement.placement.score);
    EXPECT_LE(rival.placement.score, contest.rivals[0].placement.score);
    EXPECT_THAT(rival.placement.votes, Not(IsEmpty()));
    for (const size_t vote : rival.placement.votes) {
      EXPECT_LT(vote, rival.confirmation.agreeing.size());
    }
  }
  // Whichever of the two is the map.
  EXPECT_THAT(Shifts(FindRivals(query, map).rivals),
              Contains(DoubleNear(kRoom, 0.05)));
}

TEST(RivalPlacementsTest, RoomsThatDifferHaveNone) {
  const Building row = RowOfRooms(1.2);
  MapOfRow map = SeeRooms(row, -7., 7.);
  const MapOfRow query = SeeRooms(row, -3., 3.);
  EXPECT_THAT(FindRivals(map, query).rivals, IsEmpty());
  // Nor do walls lie where a place is wrongly said to resemble itself.
  map.places.begin()->second.surface.self_similar_poses = {
      Rigid2(kRoom, 0., 0.)};
  EXPECT_THAT(FindRivals(map, query).rivals, IsEmpty());
}

}  // namespace
}  // namespace cartographer_sdf::rival_placements_test
