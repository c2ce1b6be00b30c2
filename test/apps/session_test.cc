// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/session.h"

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/two_offices.h"

namespace cartographer_sdf::session_test {
namespace {

using ::testing::HasSubstr;
using testing::ThreadExecutor;

// What maps of 100 m of driving bend [m].
constexpr double kMaxDrift = 0.6;

class LocalizeInTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    offices_ = new testing::TwoOffices;
    morning_ = new DescribedMap(Describe(offices_->Morning()).map);
    evening_ = new DescribedMap(Describe(offices_->Evening()).map);
    elsewhere_ = new DescribedMap(Describe(offices_->Elsewhere()).map);
  }
  static void TearDownTestSuite() {
    delete offices_;
    delete morning_;
    delete evening_;
    delete elsewhere_;
  }
  static Session Describe(const std::string& path,
                          const std::optional<TimeWindow>& window = {}) {
    absl::StatusOr<Session> query =
        DescribeSession(LoopClosingOptions(), ScanPlaceOptions(), path, window,
                        ThreadExecutor(2));
    CHECK(query.ok()) << query.status();
    return *std::move(query);
  }
  static Localization Find(const DescribedMap& map, const DescribedMap& query,
                           const int num_threads = 2) {
    return LocalizeIn(LocalizationOptions(), LoopClosingOptions(), map, query,
                      ThreadExecutor(num_threads));
  }

  static testing::TwoOffices* offices_;
  static DescribedMap* morning_;
  static DescribedMap* evening_;
  static DescribedMap* elsewhere_;
};
testing::TwoOffices* LocalizeInTest::offices_;
DescribedMap* LocalizeInTest::morning_;
DescribedMap* LocalizeInTest::evening_;
DescribedMap* LocalizeInTest::elsewhere_;

// (map <- world), by the map's first submap with a truth.
Rigid2 MapFromWorld(const Truth& truth, const DescribedMap& map) {
  const auto& [id, T_world_submap] = *truth.T_world_submap.begin();
  return map.state.pose_graph.submap_poses.at(id) * T_world_submap.Inverse();
}

TEST_F(LocalizeInTest, FindsAWholeSession) {
  const Localization result = Find(*morning_, *evening_);
  ASSERT_EQ(result.verdict, LocalizationVerdict::kLocalized) << result.reason;
  ASSERT_TRUE(result.T_map_query.has_value());
  EXPECT_GE(*result.score, PlacementOptions().min_score);
  EXPECT_GE(result.num_agreeing, 3);
  const Truth morning = offices_->TruthOf(offices_->Morning());
  const Truth evening = offices_->TruthOf(offices_->Evening());
  EXPECT_THAT(
      *result.T_map_query,
      testing::IsPoseNear(MapFromWorld(morning, *morning_) *
                              MapFromWorld(evening, *evening_).Inverse(),
                          kMaxDrift, 0.05));
  for (const size_t vote : result.placements.front().votes) {
    const PairPose& closure = result.matches[vote].pair;
    const Rigid2 error =
        offices_->ErrorOf(closure, offices_->Morning(), offices_->Evening());
    EXPECT_LT(error.translation().norm(), 0.5)
        << closure.reference << " " << closure.query;
    EXPECT_LT(std::abs(error.rotation()), 0.09);
  }
}

TEST_F(LocalizeInTest, SaysWhatIsTheMatterWithAMap) {
  DescribedMap bare;
  const Localization result = Find(bare, *evening_);
  EXPECT_EQ(result.verdict, LocalizationVerdict::kNothingAlike);
  EXPECT_THAT(result.reason, HasSubstr("the map has no submaps: drive"));
  // One submap, of which little is seen.
  bare.state.submaps.insert(*elsewhere_->state.submaps.begin());
  EXPECT_THAT(Find(bare, *evening_).reason,
              HasSubstr("the map shows too little: 0 m2, 20 are needed"));
}

TEST_F(LocalizeInTest, SaysThatSubmapsShowTooLittle) {
  DescribedMap tiny;
  tiny.state.submaps.insert(*elsewhere_->state.submaps.begin());
  // Of a room of 2 m by 3 m: together more than a map needs.
  for (int index = 0; index < 5; ++index) {
    const SubmapId id{0, index};
    std::optional<Place> place = DescribePlace(
        PlaceOptions(), id,
        testing::SeeFrom(testing::BareRoom(3., 2.), {}, {{0., 0.}}));
    ASSERT_TRUE(place.has_value());
    tiny.places.emplace(id, *std::move(place));
    tiny.state.pose_graph.submap_poses[id] = Rigid2();
    tiny.odometry[id] = OdometryPose();
  }
  const std::string reason = Find(tiny, *evening_).reason;
  EXPECT_THAT(reason, HasSubstr("no submap of the map shows more than"));
  EXPECT_THAT(reason, HasSubstr("two must have 10 in common"));
}

TEST_F(LocalizeInTest, MapsThatDoNotDriftAreLaidWithinCentimetres) {
  const FloorPlan plan = testing::MakeSmallOffice(1);
  const DriftOptions none{0., 0., 0., 0., 0., 0.};
  std::vector<DescribedMap> maps;
  std::vector<Rigid2> T_map_world;
  for (const uint32_t seed : {1, 2}) {
    const std::string path =
        offices_->File("straight_" + std::to_string(seed) + ".pbstream");
    testing::WriteShortDrive(plan, seed, path, /*with_submaps=*/true, none);
    maps.push_back(Describe(path).map);
    T_map_world.push_back(MapFromWorld(offices_->TruthOf(path), maps.back()));
  }
  const Localization result = Find(maps[0], maps[1]);
  ASSERT_TRUE(result.T_map_query.has_value()) << result.reason;
  // At the nodes: the origin of a map may lie far from where the robot was. Two
  // cells: the answer rests on few pairs of submaps.
  const Rigid2 truth = T_map_world[0] * T_map_world[1].Inverse();
  double sum = 0.;
  const auto& nodes = maps[1].state.pose_graph.nodes;
  for (const auto& [id, node] : nodes) {
    const Eigen::Vector2d& position = node.T_map_node.translation();
    sum += (*result.T_map_query * position - truth * position).norm();
  }
  EXPECT_LT(sum / static_cast<double>(nodes.size()), 0.1);
  EXPECT_NEAR(NormalizeAngle(result.T_map_query->rotation() - truth.rotation()),
              0., 0.007);
}

TEST_F(LocalizeInTest, TheReverseIsTheInverse) {
  const Localization there = Find(*morning_, *evening_);
  const Localization back = Find(*evening_, *morning_);
  ASSERT_TRUE(there.T_map_query && back.T_map_query);
  // Not the same matches, and maps that drift: they are fitted where they meet.
  EXPECT_THAT(*there.T_map_query * *back.T_map_query,
              testing::IsPoseNear(Rigid2(), 0.5, 0.05));
}

TEST_F(LocalizeInTest, AnotherBuildingIsRefused) {
  const Localization result = Find(*morning_, *elsewhere_);
  EXPECT_NE(result.verdict, LocalizationVerdict::kLocalized);
  EXPECT_FALSE(result.T_map_query.has_value());
  EXPECT_NE(result.reason, "");
}

TEST_F(LocalizeInTest, IsTheSameForAnyNumberOfThreads) {
  const Localization one = Find(*morning_, *evening_, 1);
  const Localization four = Find(*morning_, *evening_, 4);
  ASSERT_TRUE(one.T_map_query && four.T_map_query);
  EXPECT_EQ(one.T_map_query->translation(), four.T_map_query->translation());
  EXPECT_EQ(one.T_map_query->rotation(), four.T_map_query->rotation());
  EXPECT_EQ(one.score, four.score);
  EXPECT_EQ(one.runner_up_score, four.runner_up_score);
  EXPECT_EQ(one.matches.size(), four.matches.size());
}

TEST_F(LocalizeInTest, TwiceTheSamePlaceIsAmbiguous) {
  // A building of two equal wings, 200 m apart: the map of the morning, and
  // beside it a copy under another number.
  DescribedMap twins = *morning_;
  const Rigid2 T_map_copy(200., 0., 0.5);
  for (const auto& [id, place] : morning_->places) {
    Place copy = place;
    copy.id.trajectory = 1;
    twins.places.emplace(copy.id, std::move(copy));
  }
  PoseGraph& graph = twins.state.pose_graph;
  for (const auto& [id, submap] : morning_->state.submaps) {
    twins.state.submaps[{1, id.index}] = submap;
    graph.submap_poses[{1, id.index}] = T_map_copy * graph.submap_poses.at(id);
  }
  for (const auto& [id, node] : morning_->state.pose_graph.nodes) {
    Node& copy = graph.nodes[{1, id.index}];
    copy.time = node.time;
    copy.T_local_node = node.T_local_node;
    copy.T_map_node = T_map_copy * node.T_map_node;
  }
  for (Constraint constraint : morning_->state.pose_graph.constraints) {
    constraint.submap.trajectory = constraint.node.trajectory = 1;
    graph.constraints.push_back(constraint);
  }
  twins.odometry = OdometryPoses(twins.state);
  const Localization result = Find(twins, *evening_);
  EXPECT_EQ(result.verdict, LocalizationVerdict::kAmbiguous) << result.reason;
  EXPECT_FALSE(result.T_map_query.has_value());
  EXPECT_THAT(result.reason, HasSubstr("ambiguous between"));
  ASSERT_TRUE(result.runner_up_score.has_value());
  EXPECT_NEAR(*result.runner_up_score, *result.score, 4.);
}

TEST_F(LocalizeInTest, TooLittleIsRefused) {
  const DescribedMap nothing;
  const Localization result = Find(*morning_, nothing);
  EXPECT_EQ(result.verdict, LocalizationVerdict::kTooLittleSeen);
  EXPECT_THAT(result.reason, HasSubstr("too little was seen"));
  // A map without places has nothing alike.
  EXPECT_EQ(Find(nothing, *evening_).verdict,
            LocalizationVerdict::kNothingAlike);
}

TEST_F(LocalizeInTest, MakesPlacesOfTheFirstSeconds) {
  const Session query = Describe(offices_->Evening(), TimeWindow{10., 100.});
  const std::map<NodeId, Node>& all = evening_->state.pose_graph.nodes;
  const int64_t begin = all.at({0, 0}).time;
  size_t num_expected = 0;
  for (const auto& [id, node] : all) {
    const double seconds = static_cast<double>(node.time - begin) * 1e-7;
    num_expected += seconds >= 10. && seconds <= 110.;
  }
  EXPECT_EQ(query.map.state.pose_graph.nodes.size(), num_expected);
  ASSERT_FALSE(query.map.places.empty());
  EXPECT_EQ(query.scan_grids.size(), query.map.state.submaps.size());
  // Each node is in one of the places at least, where local SLAM says.
  std::set<NodeId> held;
  for (const Constraint& constraint : query.map.state.pose_graph.constraints) {
    held.insert(constraint.node);
    const Rigid2 T_map_node =
        query.map.state.pose_graph.submap_poses.at(constraint.submap) *
        constraint.T_submap_node;
    EXPECT_THAT(
        T_map_node,
        testing::IsPoseNear(all.at(constraint.node).T_map_node, 1e-6, 1e-6));
  }
  EXPECT_EQ(held.size(), num_expected);

  const Localization result = Find(*morning_, query.map);
  ASSERT_TRUE(result.T_map_query.has_value()) << result.reason;
  const Localization whole = Find(*morning_, *evening_);
  ASSERT_TRUE(whole.T_map_query.has_value());
  EXPECT_THAT(*result.T_map_query,
              testing::IsPoseNear(*whole.T_map_query, 1., 0.1));
}

TEST_F(LocalizeInTest, AWindowWithoutNodesHasNoPlaces) {
  const Session query = Describe(offices_->Evening(), TimeWindow{1e6, 10.});
  EXPECT_TRUE(query.map.places.empty());
  EXPECT_TRUE(query.map.state.pose_graph.nodes.empty());
}

}  // namespace
}  // namespace cartographer_sdf::session_test
