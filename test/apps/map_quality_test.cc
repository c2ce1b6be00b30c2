// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/map_quality.h"

#include "cartographer_sdf/execution/parallel_for.h"
#include "gtest/gtest.h"
#include "test/testing/visited_rooms.h"

namespace cartographer_sdf::map_quality_test {
namespace {

using testing::VisitedRooms;

// Two rooms, each visited twice, at their true poses.
class MapQualityTest : public ::testing::Test {
 protected:
  MapQualityTest() : graph_(rooms_.map().state.pose_graph) {
    for (auto& [id, pose] : graph_.submap_poses) {
      pose = rooms_.T_world_submap(id);
    }
  }

  [[nodiscard]] std::vector<PlacePair> Pairs(const int min_index_gap) const {
    return FindOverlappingPairs(min_index_gap, rooms_.map().places, graph_,
                                MakeExecutor(2));
  }
  [[nodiscard]] MapQuality Measure() const {
    return MeasureMapQuality(AgreementOptions(), 2, rooms_.map().places, graph_,
                             MakeExecutor(2));
  }

  const VisitedRooms rooms_;
  PoseGraph graph_;
};

TEST_F(MapQualityTest, TheTwoVisitsOfARoomOverlap) {
  const std::vector<PlacePair> pairs = Pairs(2);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].reference->id, VisitedRooms::kWestFirst);
  EXPECT_EQ(pairs[0].query->id, VisitedRooms::kWestAgain);
  EXPECT_THAT(pairs[0].T_reference_query,
              testing::IsPoseNear(rooms_.TruePose(VisitedRooms::kWestFirst,
                                                  VisitedRooms::kWestAgain),
                                  1e-9, 1e-9));
  EXPECT_EQ(pairs[1].reference->id, VisitedRooms::kEastFirst);
  EXPECT_EQ(pairs[1].query->id, VisitedRooms::kEastAgain);
  // None that share scans.
  EXPECT_TRUE(Pairs(3).empty());
}

TEST_F(MapQualityTest, WallsThatAreWhereTheyShouldBeAgree) {
  const MapQuality quality = Measure();
  EXPECT_EQ(quality.num_pairs, 2u);
  EXPECT_GT(quality.hit_ratio, 0.98);
  EXPECT_LT(quality.contradiction_ratio, 0.002);
  // Within a cell.
  EXPECT_LT(quality.wall_distance, 0.05);
}

TEST_F(MapQualityTest, ARoomThatIsLaidWrongContradicts) {
  const MapQuality aligned = Measure();
  Rigid2& west = graph_.submap_poses.at(VisitedRooms::kWestAgain);
  west = Rigid2(0.1, 0., 0.) * west;
  const MapQuality near = Measure();
  // By 0.1 m, of the walls across in one of the two rooms.
  EXPECT_GT(near.wall_distance, aligned.wall_distance + 0.01);
  EXPECT_LT(near.contradiction_ratio, 0.005);
  west = Rigid2(0.6, 0.5, 0.) * west;
  const MapQuality far = Measure();
  EXPECT_EQ(far.num_pairs, 2u);
  EXPECT_GT(far.contradiction_ratio, 0.05);
  // Of half of all walls, few still agree.
  EXPECT_LT(far.hit_ratio, 0.75 * aligned.hit_ratio);
}

TEST_F(MapQualityTest, NothingSeenTwiceSaysNothing) {
  graph_.submap_poses.at(VisitedRooms::kWestAgain) = Rigid2(100., 0., 0.);
  graph_.submap_poses.erase(VisitedRooms::kEastAgain);
  const MapQuality quality = Measure();
  EXPECT_EQ(quality.num_pairs, 0u);
  EXPECT_EQ(quality.hit_ratio, 0.);
  EXPECT_EQ(quality.contradiction_ratio, 0.);
  EXPECT_EQ(quality.wall_distance, 0.);
}

}  // namespace
}  // namespace cartographer_sdf::map_quality_test
