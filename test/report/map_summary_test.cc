// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/map_summary.h"

#include <limits>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_sdf::map_summary_test {
namespace {

using ::testing::HasSubstr;

constexpr int64_t kSecond = 10000000;
// 2019-05-23 14:00:01 UTC.
constexpr int64_t kBegin = (62135596800 + 1558620001) * kSecond;

MapState TestMap() {
  MapState map;
  map.format_version = 2;
  map.trajectories = {0, 1};
  map.num_records = {{"node", 4}, {"submap", 1}};
  SubmapSummary submap;
  submap.finished = true;
  submap.geometry.size = {10, 10};
  submap.geometry.resolution = 0.1;
  submap.num_known_cells = 50;
  map.submaps[{0, 0}] = submap;
  map.pose_graph.submap_poses[{0, 0}] = Rigid2();
  map.pose_graph.submap_poses[{1, 0}] = Rigid2();
  map.num_unrecorded_submaps = 1;
  map.num_unrecorded_nodes = 2;
  // An L of 3 m and 4 m, with a pause of 20 s; then another trajectory.
  const auto add_node = [&map](const NodeId& id, const double seconds,
                               const Rigid2& pose) {
    Node& node = map.pose_graph.nodes[id];
    node.time = kBegin + static_cast<int64_t>(seconds * kSecond);
    node.T_map_node = pose;
  };
  add_node({0, 0}, 0., Rigid2(0., 0., 0.));
  add_node({0, 1}, 2., Rigid2(3., 0., 1.));
  add_node({0, 5}, 22., Rigid2(3., 4., 1.));
  add_node({1, 0}, 5000., Rigid2(100., 4., 1.));
  map.pose_graph.nodes[{0, 1}].T_previous_node_by_odometry = Rigid2();
  Constraint constraint;
  constraint.submap = {0, 0};
  constraint.node = {1, 0};
  constraint.tag = Constraint::Tag::kInterSubmap;
  map.pose_graph.constraints.push_back(constraint);
  return map;
}

TEST(MapSummaryTest, SummarizesTrajectories) {
  const std::map<int, TrajectorySummary> trajectories =
      SummarizeTrajectories(TestMap());
  ASSERT_EQ(trajectories.size(), 2u);
  const TrajectorySummary& first = trajectories.at(0);
  EXPECT_EQ(first.num_submaps, 1);
  EXPECT_EQ(first.num_nodes, 3);
  EXPECT_NEAR(first.length, 7., 1e-9);
  EXPECT_NEAR(first.duration_seconds, 22., 1e-3);
  EXPECT_EQ(first.num_nodes_with_odometry, 1);
  EXPECT_EQ(first.num_gaps, 1);
  EXPECT_NEAR(first.longest_gap_seconds, 20., 1e-3);
  const TrajectorySummary& second = trajectories.at(1);
  EXPECT_EQ(second.num_nodes, 1);
  EXPECT_EQ(second.length, 0.);
  EXPECT_EQ(second.num_gaps, 0);
}

TEST(MapSummaryTest, DescribesTheMap) {
  const std::string text = DescribeMap("a.pbstream", TestMap());
  for (const std::string part :
       {"a.pbstream\n", "format version  2\n",
        "1 (1 finished), and 1 poses without a submap\n",
        "4, 2 of them without data: the file was cut\n",
        "1 probability, cells of 0.1 m\n", "0.5 m2",
        "0 intra-submap, 1 inter-submap (1 between trajectories)\n", "7.0 m",
        "33 % of nodes", "1, up to 20.0 s", "2019-05-23 14:00:01 UTC"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
}

TEST(MapSummaryTest, SurvivesEmptyAndHostileMaps) {
  EXPECT_THAT(DescribeMap("empty", MapState()), HasSubstr("none"));
  MapState map = TestMap();
  map.pose_graph.nodes[{0, 0}].time = std::numeric_limits<int64_t>::min();
  map.pose_graph.nodes[{0, 1}].time = std::numeric_limits<int64_t>::max();
  EXPECT_THAT(DescribeMap("hostile", map), HasSubstr("hostile"));
}

TEST(FormatUniversalTimeTest, CoversTheYears) {
  EXPECT_EQ(FormatUniversalTime(0), "0001-01-01 00:00:00 UTC");
  EXPECT_EQ(FormatUniversalTime(62135596800 * kSecond + kSecond - 1),
            "1970-01-01 00:00:00 UTC");
  EXPECT_EQ(FormatUniversalTime(-1), "-");
  EXPECT_EQ(FormatUniversalTime(std::numeric_limits<int64_t>::max()), "-");
}

}  // namespace
}  // namespace cartographer_sdf::map_summary_test
