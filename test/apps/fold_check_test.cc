// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/fold_check.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/execution/parallel_for.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/visited_rooms.h"

namespace cartographer_sdf::fold_check_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Key;
using ::testing::SizeIs;
using testing::VisitedRooms;

using Overlaps = std::map<std::pair<size_t, size_t>, SessionOverlap>;

// Walls of the east room stand in its free space.
const Rigid2 kMisplaced(1.4, 1.2, 0.05);

// Trajectory 0 is the first visit, trajectory 1 the second one.
class CheckOverlapsTest : public ::testing::Test {
 protected:
  CheckOverlapsTest() {
    for (const auto& [id, place] : rooms_.map().places) {
      const int trajectory = id < VisitedRooms::kWestAgain ? 0 : 1;
      Place renamed = place;
      renamed.id = {trajectory, id.index};
      joined_.places.emplace(renamed.id, renamed);
      merged_.submap_poses[renamed.id] = rooms_.T_world_submap(id);
    }
    joined_.state.pose_graph = merged_;
    joined_.session_of_trajectory = {{0, 0}, {1, 1}};
  }

  [[nodiscard]] Overlaps Check() const {
    return CheckOverlaps(FoldCheckOptions(), RecognitionOptions(), joined_,
                         merged_, MakeExecutor(1));
  }

  const VisitedRooms rooms_;
  const SubmapId east_again_{1, VisitedRooms::kEastAgain.index};
  JoinedSessions joined_;
  PoseGraph merged_;
};

TEST_F(CheckOverlapsTest, RoomsThatAreLaidRightAgree) {
  const Overlaps overlaps = Check();
  ASSERT_THAT(overlaps, ElementsAre(Key(std::pair<size_t, size_t>(0, 1))));
  EXPECT_EQ(overlaps.begin()->second.num_overlapping, 2);
  EXPECT_THAT(overlaps.begin()->second.contradictions, IsEmpty());
}

TEST_F(CheckOverlapsTest, ARoomThatIsLaidWrongContradicts) {
  merged_.submap_poses[east_again_] =
      kMisplaced * merged_.submap_poses[east_again_];
  const SessionOverlap overlap = Check().at({0, 1});
  EXPECT_EQ(overlap.num_overlapping, 2);
  ASSERT_THAT(overlap.contradictions, SizeIs(1));
  EXPECT_EQ(overlap.contradictions[0].pair.reference, VisitedRooms::kEastFirst);
  EXPECT_EQ(overlap.contradictions[0].pair.query, east_again_);
  EXPECT_GT(overlap.contradictions[0].evidence.MeanContradictionRatio(),
            FoldCheckOptions().max_contradiction_ratio);
}

TEST_F(CheckOverlapsTest, WhatASessionContradictedBeforeIsNotCounted) {
  joined_.session_of_trajectory[1] = 0;
  merged_.submap_poses[east_again_] =
      kMisplaced * merged_.submap_poses[east_again_];
  EXPECT_THAT(Check().at({0, 0}).contradictions, SizeIs(1));
  joined_.state.pose_graph = merged_;
  EXPECT_EQ(Check().at({0, 0}).num_overlapping, 2);
  EXPECT_THAT(Check().at({0, 0}).contradictions, IsEmpty());
  // Between sessions it is, wherever they were before.
  joined_.session_of_trajectory[1] = 1;
  EXPECT_THAT(Check().at({0, 1}).contradictions, SizeIs(1));
}

TEST_F(CheckOverlapsTest, SubmapsThatShareScansAreNotCompared) {
  // As neighbours of one trajectory.
  std::map<SubmapId, Place> places;
  PoseGraph graph;
  for (const int index : {0, 1, 5}) {
    Place place = joined_.places.begin()->second;
    place.id = {0, index};
    places.emplace(place.id, place);
    graph.submap_poses[place.id] = Rigid2();
  }
  joined_.places = places;
  joined_.state.pose_graph = merged_ = graph;
  EXPECT_EQ(Check().at({0, 0}).num_overlapping, 2);
}

SessionOverlap Overlap(const int num_overlapping,
                       const size_t num_contradictions) {
  SessionOverlap overlap{num_overlapping, {}};
  overlap.contradictions.resize(num_contradictions);
  for (Match& match : overlap.contradictions) {
    match.pair.reference = {0, 4};
    match.pair.query = {1, 7};
  }
  return overlap;
}

TEST(FindFoldTest, JudgesEachPairOfSessionsApart) {
  const Session a{"a", {}, {}}, b{"b", {}, {}};
  const std::vector<const Session*> sessions = {&a, &b};
  const FoldCheckOptions options;
  EXPECT_FALSE(FindFold(options, {}, sessions));
  // As much as is allowed.
  EXPECT_FALSE(FindFold(options, {{{0, 1}, Overlap(10, 2)}}, sessions));
  const std::optional<MergingFault> fault =
      FindFold(options, {{{0, 0}, Overlap(1000, 0)}, {{0, 1}, Overlap(10, 3)}},
               sessions);
  ASSERT_TRUE(fault);
  EXPECT_EQ(
      fault->reason,
      "the merged map would be folded: of 10 pairs of submaps of a and b that "
      "it lays over each other 3 have walls in each other's free space, such "
      "as 0,4 and 1,7");
  // The later one.
  EXPECT_EQ(fault->session, 1u);
}

TEST(FindFoldTest, AtFaultIsTheSessionThatIsFoldedWithMostOthers) {
  const Session a{"a", {}, {}}, b{"b", {}, {}}, c{"c", {}, {}};
  const std::vector<const Session*> sessions = {&a, &b, &c};
  const std::optional<MergingFault> fault = FindFold(FoldCheckOptions(),
                                                     {{{0, 1}, Overlap(10, 4)},
                                                      {{0, 2}, Overlap(10, 0)},
                                                      {{1, 2}, Overlap(10, 4)}},
                                                     sessions);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->session, 1u);
}

TEST(FoldCheckOptionsTest, SaysWhatIsWrong) {
  EXPECT_EQ(Validate(FoldCheckOptions()), "");
  EXPECT_THAT(Validate(FoldCheckOptions{0., 0.2}),
              HasSubstr("max_contradiction_ratio"));
  EXPECT_THAT(Validate(FoldCheckOptions{1.1, 0.2}),
              HasSubstr("max_contradiction_ratio"));
  EXPECT_THAT(Validate(FoldCheckOptions{0.05, 1.1}),
              HasSubstr("max_folded_fraction"));
}

}  // namespace
}  // namespace cartographer_sdf::fold_check_test
