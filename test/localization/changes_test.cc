// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/changes.h"

#include <map>
#include <vector>

#include "cartographer_sdf/execution/parallel_for.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"

namespace cartographer_sdf::changes_test {
namespace {

using testing::Building;
using testing::Furniture;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// A map of one room, 10 m x 8 m, that is seen in two submaps, each from the
// four corners of the room; what stands in it is given for each.
struct RoomMap {
  explicit RoomMap(const std::vector<Building>& furniture) {
    PoseGraph graph;
    std::map<SubmapId, OdometryPose> odometry;
    for (size_t k = 0; k < furniture.size(); ++k) {
      Building building = testing::BareRoom(10., 8.);
      building.insert(building.end(), furniture[k].begin(), furniture[k].end());
      const SubmapId id{0, static_cast<int>(k)};
      const Rigid2 T_world_submap(0.4 * static_cast<double>(k), 0.2, 0.7);
      places.emplace(
          id,
          *DescribePlace(
              PlaceOptions(), id,
              testing::SeeFrom(building, T_world_submap,
                               {{-4., -3.}, {-4., 3.}, {4., -3.}, {4., 3.}})));
      graph.submap_poses[id] = T_world_submap;
      odometry[id] = {T_world_submap, static_cast<double>(k)};
    }
    layout = MakeMapLayout(graph, odometry, places);
  }
  [[nodiscard]] PlacedMap Placed() const { return {&places, &layout}; }

  std::map<SubmapId, Place> places;
  MapLayout layout{{}, {}, {}, DrivenDistances({}, {})};
};

// All pairs of submaps agree, each off by `error`.
std::vector<Change> Find(const RoomMap& map, const RoomMap& query,
                         const Rigid2& error = Rigid2()) {
  std::vector<PairPose> pairs;
  for (const auto& [reference, T_map_reference] : map.layout.T_map_submap) {
    for (const auto& [other, T_query_other] : query.layout.T_map_submap) {
      pairs.push_back({reference, other,
                       T_map_reference.Inverse() * T_query_other * error, 9.});
    }
  }
  return FindChanges(map.Placed(), query.Placed(), pairs, MakeExecutor(2));
}

// Two cells of the outline.
constexpr double kMeters = 0.2;

void ExpectBox(const Change& change, const Eigen::Vector2d& min,
               const Eigen::Vector2d& max) {
  EXPECT_LT((change.box.min() - min).cwiseAbs().maxCoeff(), kMeters)
      << change.box.min().transpose();
  EXPECT_LT((change.box.max() - max).cwiseAbs().maxCoeff(), kMeters)
      << change.box.max().transpose();
}

const Building kCupboard = {Furniture(1., 0.5, 1.6, 0.8, 0.)};
const Building kTable = {Furniture(-2., -1., 1., 1., 0.)};
const Building kBin = {Furniture(-2., 1., 0.15, 0.15, 0.)};

TEST(FindChangesTest, NothingChangedIsNothing) {
  const RoomMap room({kCupboard, kCupboard});
  EXPECT_THAT(Find(room, room), IsEmpty());
  // Nor where the pose is off by some centimetres.
  EXPECT_THAT(Find(room, room, Rigid2(0.05, -0.05, 0.01)), IsEmpty());
}

TEST(FindChangesTest, FurnitureAppearsAndVanishes) {
  const RoomMap bare({{}, {}}), furnished({kCupboard, kCupboard});
  const std::vector<Change> appeared = Find(bare, furnished);
  ASSERT_THAT(appeared, SizeIs(1));
  EXPECT_EQ(appeared[0].kind, ChangeKind::kAppeared);
  ExpectBox(appeared[0], {0.2, 0.1}, {1.8, 0.9});
  // The outline, in cells of 0.1 m on either side of which it may lie.
  EXPECT_GT(appeared[0].wall_area, 0.1 * 4.);
  EXPECT_LT(appeared[0].wall_area, 0.2 * 6.);
  EXPECT_GT(ChangedArea(appeared), 1.6 * 0.8 - 1e-9);
  EXPECT_LT(ChangedArea(appeared), (1.6 + kMeters) * (0.8 + kMeters) + 1e-9);
  const std::vector<Change> vanished = Find(furnished, bare);
  ASSERT_THAT(vanished, SizeIs(1));
  EXPECT_EQ(vanished[0].kind, ChangeKind::kVanished);
  ExpectBox(vanished[0], {0.2, 0.1}, {1.8, 0.9});
}

TEST(FindChangesTest, TheLargestComesFirst) {
  Building both = kTable;
  both.insert(both.end(), kCupboard.begin(), kCupboard.end());
  const std::vector<Change> changes =
      Find(RoomMap({{}, {}}), RoomMap({both, both}));
  ASSERT_THAT(changes, SizeIs(2));
  ExpectBox(changes[0], {0.2, 0.1}, {1.8, 0.9});
  ExpectBox(changes[1], {-2.5, -1.5}, {-1.5, -0.5});
}

TEST(FindChangesTest, WhatIsSmallerThanAPieceOfFurnitureIsLeftOut) {
  EXPECT_THAT(Find(RoomMap({{}, {}}), RoomMap({kBin, kBin})), IsEmpty());
}

TEST(FindChangesTest, MorePairsMustSeeItThanSeeItUnchanged) {
  // One submap of the map had the cupboard, and so has the query.
  EXPECT_THAT(Find(RoomMap({{}, kCupboard}), RoomMap({kCupboard, kCupboard})),
              IsEmpty());
}

TEST(FindChangesTest, WithoutPairsIsNothing) {
  const RoomMap room({kCupboard, kCupboard});
  EXPECT_THAT(FindChanges(room.Placed(), room.Placed(), {}, MakeExecutor(1)),
              IsEmpty());
  EXPECT_EQ(ChangedArea({}), 0.);
}

TEST(DescribeChangesTest, CountsAndShowsTheLargest) {
  EXPECT_EQ(DescribeChanges({}), "nothing has changed");
  const Eigen::AlignedBox2d large(Eigen::Vector2d(1., 2.),
                                  Eigen::Vector2d(3., 5.));
  const Eigen::AlignedBox2d small(Eigen::Vector2d(7., 2.),
                                  Eigen::Vector2d(8., 3.));
  EXPECT_EQ(DescribeChanges({{ChangeKind::kVanished, large, 1.},
                             {ChangeKind::kAppeared, small, 0.4},
                             {ChangeKind::kAppeared, small, 0.4}}),
            "2 objects have appeared and 1 vanished, 7.0 m2 together; the "
            "largest, 2.0 m x 3.0 m at (2.0, 3.5) m, has vanished");
}

TEST(ChangedAreaTest, CountsOverlapsOnce) {
  const Eigen::AlignedBox2d box(Eigen::Vector2d(1., 2.),
                                Eigen::Vector2d(2., 3.));
  const Eigen::AlignedBox2d beside(Eigen::Vector2d(1.5, 2.),
                                   Eigen::Vector2d(2.5, 3.));
  EXPECT_NEAR(ChangedArea({{ChangeKind::kAppeared, box, 0.4},
                           {ChangeKind::kVanished, beside, 0.4}}),
              1.5, 1e-9);
}

}  // namespace
}  // namespace cartographer_sdf::changes_test
