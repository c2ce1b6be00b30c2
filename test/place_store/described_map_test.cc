// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/place_store/described_map.h"

#include <string>

#include "cartographer_sdf/execution/parallel_for.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/open_counter.h"
#include "test/testing/small_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::described_map_test {
namespace {

using ::cartographer_sdf::testing::SmallMap;
using ::testing::IsEmpty;
using testing::IsPoseNear;

class DescribedMapTest : public ::testing::Test {
 protected:
  DescribedMapTest() {
    testing::WriteFile(path_, testing::Container(SmallMap().Records()));
  }

  RememberedMap Remember(const PointClouds point_clouds) const {
    absl::StatusOr<RememberedMap> map = RememberMap(
        PlaceOptions(), MatchOptions(), "options", path_,
        directory_.File("places"), MakeExecutor(2), {}, point_clouds);
    CHECK(map.ok()) << map.status();
    EXPECT_EQ(map->complaint, "");
    return *std::move(map);
  }

  const testing::TemporaryDirectory directory_;
  const std::string path_ = directory_.File("map.pbstream");
};

TEST_F(DescribedMapTest, KeepsPointCloudsWhereTheyAreWanted) {
  for (const PointClouds wanted : {PointClouds::kDrop, PointClouds::kKeep}) {
    testing::OpenCounter counter(path_);
    const absl::StatusOr<DescribedMap> map = DescribeMap(
        PlaceOptions(), MatchOptions(), path_, MakeExecutor(2), {}, wanted);
    ASSERT_TRUE(map.ok()) << map.status();
    EXPECT_EQ(counter.Count(), 1);
    EXPECT_EQ(map->state.pose_graph.nodes.size(), 4u);
    if (wanted == PointClouds::kDrop) {
      EXPECT_THAT(map->point_clouds, IsEmpty());
      continue;
    }
    const absl::StatusOr<std::map<NodeId, PointCloud2>> expected =
        ReadPointClouds(path_, {{SmallMap::kTrajectory, 0},
                                {SmallMap::kTrajectory, 1},
                                {SmallMap::kTrajectory, 2},
                                {SmallMap::kTrajectory, 3}});
    ASSERT_TRUE(expected.ok()) << expected.status();
    EXPECT_EQ(map->point_clouds, *expected);
  }
}

TEST_F(DescribedMapTest, PointCloudsComeWithRememberedPlaces) {
  const RememberedMap described = Remember(PointClouds::kKeep);
  EXPECT_FALSE(described.is_from_file);
  EXPECT_EQ(described.map.point_clouds.size(), 4u);
  const RememberedMap remembered = Remember(PointClouds::kKeep);
  EXPECT_TRUE(remembered.is_from_file);
  EXPECT_EQ(remembered.map.point_clouds, described.map.point_clouds);
  EXPECT_THAT(Remember(PointClouds::kDrop).map.point_clouds, IsEmpty());
}

TEST(OdometryPosesTest, TellsHowFarTheRobotHadDriven) {
  MapState state;
  // Along x, 2 m at a time; the second trajectory 3 m at a time, and one of its
  // nodes has no data of its own.
  for (int i = 0; i < 6; ++i) {
    Node& node = state.pose_graph.nodes[{0, i}];
    node.T_local_node = Rigid2(2. * i, 0., 0.);
    node.T_map_node = Rigid2(0., 7. * i, 1.);
  }
  for (int i = 0; i < 3; ++i) {
    Node& node = state.pose_graph.nodes[{1, i}];
    node.T_map_node = Rigid2(50. + 3. * i, 0., 0.);
    if (i != 1) node.T_local_node = node.T_map_node;
  }
  const auto insert = [&state](const SubmapId& submap, const NodeId& node) {
    state.pose_graph.constraints.push_back(
        {submap, node, Rigid2(), 1., 1., Constraint::Tag::kIntraSubmap});
  };
  for (int i = 0; i < 4; ++i) insert({0, 0}, {0, i});
  for (int i = 2; i < 6; ++i) insert({0, 1}, {0, i});
  for (int i = 0; i < 3; ++i) insert({1, 0}, {1, i});
  state.pose_graph.constraints.push_back(
      {{0, 0}, {1, 2}, Rigid2(), 1., 1., Constraint::Tag::kInterSubmap});
  state.submaps[{0, 0}].T_local_submap = Rigid2(1., 2., 3.);
  state.submaps[{0, 1}].T_local_submap = Rigid2(4., 5., 6.);
  state.submaps[{1, 0}];
  state.submaps[{1, 1}];  // without nodes

  const std::map<SubmapId, OdometryPose> poses = OdometryPoses(state);
  ASSERT_EQ(poses.size(), 4u);
  EXPECT_THAT(poses.at({0, 0}).T_local_submap,
              IsPoseNear(Rigid2(1., 2., 3.), 0., 0.));
  EXPECT_THAT(poses.at({0, 1}).T_local_submap,
              IsPoseNear(Rigid2(4., 5., 6.), 0., 0.));
  // Means of 0, 2, 4, 6 and of 4, 6, 8, 10.
  EXPECT_NEAR(poses.at({0, 0}).distance_driven, 3., 1e-12);
  EXPECT_NEAR(poses.at({0, 1}).distance_driven, 7., 1e-12);
  EXPECT_EQ(poses.at({1, 1}).distance_driven, 0.);
}

}  // namespace
}  // namespace cartographer_sdf::described_map_test
