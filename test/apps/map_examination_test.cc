// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/map_examination.h"

#include <map>

#include "cartographer_sdf/execution/parallel_for.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/visited_rooms.h"

namespace cartographer_sdf::map_examination_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::VisitedRooms;

MapExamination Examine(const DescribedMap& map) {
  return ExamineMap(LoopClosingOptions(), map, MakeExecutor(2));
}

TEST(ExamineMapTest, MeasuresAMap) {
  const VisitedRooms rooms;
  const MapExamination examination = Examine(rooms.map());
  EXPECT_EQ(examination.num_submaps, 4u);
  EXPECT_EQ(examination.num_places, 4u);
  EXPECT_FALSE(examination.is_closed);
  // Each room was seen twice, two submaps apart; local SLAM drifted by some
  // centimetres in between.
  EXPECT_EQ(examination.along_trajectories.num_pairs, 2u);
  EXPECT_GT(examination.along_trajectories.hit_ratio, 0.9);
  EXPECT_LT(examination.along_trajectories.contradiction_ratio, 0.01);
  EXPECT_THAT(examination.broken_links, IsEmpty());
  EXPECT_THAT(examination.torn_submaps, IsEmpty());
  // Furnished rooms.
  EXPECT_EQ(examination.num_self_similar, 0u);
  EXPECT_GT(examination.mean_area, 35.);
  EXPECT_LT(examination.mean_area, 60.);
}

TEST(ExamineMapTest, FindsWhereLocalSlamSlipped) {
  // The east room is 0.8 m off when it is seen again.
  const VisitedRooms rooms;
  DescribedMap map = rooms.map();
  Rigid2& again = map.odometry.at(VisitedRooms::kEastAgain).T_local_submap;
  again = Rigid2(0.5, 0.6, 0.1) * again;
  EXPECT_THAT(Examine(map).along_trajectories.contradiction_ratio,
              ::testing::Gt(0.03));
  EXPECT_THAT(Examine(VisitedRooms(Rigid2(0.5, 0.4, 0.1)).map()).torn_submaps,
              ::testing::SizeIs(1));
}

// A hall with two cupboards, each where the other is after half a turn.
TEST(ExamineMapTest, AHallMayResembleItself) {
  testing::Building hall = testing::BareRoom(14., 10.);
  hall.push_back(testing::Furniture(3., 2., 2., 1., 0.));
  hall.push_back(testing::Furniture(-3., -2., 2., 1., 0.));
  const OccupancyGrid grid = testing::SeeFrom(hall, {},
                                              {{0., 0.},
                                               {-5., 3.},
                                               {5., -3.},
                                               {0., -4.},
                                               {0., 4.},
                                               {6., 4.},
                                               {-6., -4.}});
  const std::map<SubmapId, OccupancyGrid> grids = {{{0, 0}, grid},
                                                   {{0, 1}, grid}};
  DescribedMap map;
  map.places =
      DescribePlaces(PlaceOptions(), MatchOptions(), grids, MakeExecutor(1));
  for (const auto& [id, unused] : grids) {
    map.state.submaps[id];
    map.state.pose_graph.submap_poses[id] = Rigid2();
    map.odometry[id];
  }
  const MapExamination examination = Examine(map);
  EXPECT_EQ(examination.num_self_similar, 2u);
  EXPECT_THAT(AdviseOnMap(examination),
              ElementsAre(HasSubstr("2 of 2 submaps resemble themselves")));
}

TEST(AdviseOnMapTest, SaysNothingOfAGoodMap) {
  MapExamination good;
  good.num_submaps = good.num_places = 100;
  good.is_closed = true;
  good.whole = {500, 0.96, 0.006, 0.04};
  good.along_trajectories = {80, 0.97, 0.004, 0.04};
  good.num_self_similar = 10;
  good.mean_area = 60.;
  EXPECT_THAT(AdviseOnMap(good), IsEmpty());
}

TEST(AdviseOnMapTest, SaysWhatIsWrong) {
  MapExamination map;
  map.num_submaps = 100;
  map.num_places = 90;
  map.whole = {500, 0.6, 0.2, 0.07};
  map.along_trajectories = {80, 0.9, 0.05, 0.05};
  map.torn_submaps[{0, 7}];
  map.num_self_similar = 60;
  map.mean_area = 12.;
  EXPECT_THAT(
      AdviseOnMap(map),
      ElementsAre(HasSubstr("1 submaps are torn"), HasSubstr("noisy: of"),
                  HasSubstr("no loop closures: run close_loops"),
                  HasSubstr("10 of 100 submaps show no wall"),
                  HasSubstr("12 m2"), HasSubstr("60 of 90 submaps resemble")));
  map.is_closed = true;
  EXPECT_THAT(AdviseOnMap(map)[2], HasSubstr("Run audit"));
  // As noisy as local SLAM: there is nothing to close.
  map.whole.contradiction_ratio = 0.1;
  map.torn_submaps.clear();
  map.num_places = 100;
  EXPECT_THAT(AdviseOnMap(map),
              ElementsAre(HasSubstr("noisy"), HasSubstr("12 m2"),
                          HasSubstr("60 of 100")));
}

}  // namespace
}  // namespace cartographer_sdf::map_examination_test
