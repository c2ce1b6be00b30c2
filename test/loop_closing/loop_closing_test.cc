// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/loop_closing/loop_closing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/evaluation/match_score.h"
#include "cartographer_sdf/evaluation/relations.h"
#include "cartographer_sdf/evaluation/trajectory_error.h"
#include "cartographer_sdf/evaluation/truth.h"
#include "cartographer_sdf/simulation/office.h"
#include "cartographer_sdf/simulation/simulated_map.h"
#include "cartographer_sdf/tools/parallel_for.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/shared_data.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf {
namespace {

using ::testing::ElementsAre;
using testing::IsPoseNear;

constexpr double kDegree = M_PI / 180.;

Executor Threads(const int num_threads) {
  return
      [num_threads](const size_t n, const std::function<void(size_t)>& task) {
        ParallelFor(static_cast<int>(n), num_threads,
                    [&task](const int i) { task(static_cast<size_t>(i)); });
      };
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

// Places that match nothing: who is compared with whom?
TEST(MatchWithinTest, LeavesNeighboursOut) {
  std::map<SubmapId, Place> places;
  const Place room = *DescribePlace(
      PlaceOptions(), {},
      testing::SeeFrom(testing::TwoRooms(), Rigid2(), {{1., 2.2}, {5., 4.}}));
  for (const SubmapId& id :
       {SubmapId{0, 0}, SubmapId{0, 2}, SubmapId{0, 3}, SubmapId{1, 1}}) {
    places.emplace(id, room).first->second.id = id;
  }
  const auto pairs = [](const std::vector<Match>& matches) {
    std::vector<std::pair<SubmapId, SubmapId>> result;
    for (const Match& match : matches) {
      result.emplace_back(match.closure.reference, match.closure.query);
    }
    return result;
  };
  using Pair = std::pair<SubmapId, SubmapId>;
  const std::map<SubmapId, Place> queries = {*places.find({1, 1})};
  // With few places, retrieval proposes all of them.
  for (const auto& retrieval : {std::optional<RetrievalOptions>(),
                                std::make_optional(RetrievalOptions())}) {
    EXPECT_THAT(
        pairs(MatchWithin(MatchOptions(), retrieval, places, 3, Threads(2))),
        ElementsAre(Pair({0, 0}, {0, 3}), Pair({0, 0}, {1, 1}),
                    Pair({0, 2}, {1, 1}), Pair({0, 3}, {1, 1})));
    EXPECT_EQ(
        MatchWithin(MatchOptions(), retrieval, places, 1, Threads(2)).size(),
        6u);
    EXPECT_THAT(pairs(MatchBetween(MatchOptions(), retrieval, places, queries,
                                   Threads(2))),
                ElementsAre(Pair({0, 0}, {1, 1}), Pair({0, 2}, {1, 1}),
                            Pair({0, 3}, {1, 1}), Pair({1, 1}, {1, 1})));
  }
  // One each; either may propose.
  RetrievalOptions one;
  one.min_num_candidates = one.max_num_candidates = 1;
  const std::vector<Pair> all =
      pairs(MatchWithin(MatchOptions(), std::nullopt, places, 3, Threads(2)));
  for (const int num_threads : {1, 3}) {
    const std::vector<Pair> some = pairs(
        MatchWithin(MatchOptions(), one, places, 3, Threads(num_threads)));
    EXPECT_GE(some.size(), 2u);
    EXPECT_LT(some.size(), all.size());
    for (const Pair& pair : some) EXPECT_THAT(all, ::testing::Contains(pair));
    // Every place has its one.
    for (const auto& [id, place] : places) {
      EXPECT_TRUE(std::any_of(some.begin(), some.end(), [&](const Pair& pair) {
        return pair.first == id || pair.second == id;
      })) << id;
    }
  }
}

// A drive through an invented office, and its loops closed.
class SimulatedOfficeTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new testing::TemporaryDirectory;
    SimulationOptions simulation;
    simulation.drive.length = 240.;
    const absl::StatusOr<SimulatedMap> map =
        Simulate(MakeOffice(OfficeOptions(), 1), simulation, 1);
    CHECK(map.ok()) << map.status();
    const absl::Status written =
        WriteSimulatedMap(*map, MapPath(), directory_->File("truth.csv"));
    CHECK(written.ok()) << written;
    absl::StatusOr<Truth> truth = ReadTruth(directory_->File("truth.csv"));
    CHECK(truth.ok()) << truth.status();
    truth_ = new Truth(*std::move(truth));
    absl::StatusOr<LoopClosingResult> result =
        CloseLoops(LoopClosingOptions(), MapPath(), {}, Threads(4));
    CHECK(result.ok()) << result.status();
    result_ = new LoopClosingResult(*std::move(result));
  }
  static void TearDownTestSuite() {
    delete directory_;
    delete truth_;
    delete result_;
  }

  static std::string MapPath() { return directory_->File("map.pbstream"); }
  static const Truth& truth() { return *truth_; }
  static const LoopClosingResult& result() { return *result_; }

 private:
  static testing::TemporaryDirectory* directory_;
  static Truth* truth_;
  static LoopClosingResult* result_;
};
testing::TemporaryDirectory* SimulatedOfficeTest::directory_;
Truth* SimulatedOfficeTest::truth_;
LoopClosingResult* SimulatedOfficeTest::result_;

TEST_F(SimulatedOfficeTest, RemembersPlacesFromAFile) {
  testing::TemporaryDirectory directory;
  const std::string file = directory.File("places");
  const auto remember = [&file](const std::string& options_text) {
    auto remembered = RememberMap(PlaceOptions(), MatchOptions(), options_text,
                                  MapPath(), file, Threads(2));
    CHECK(remembered.ok()) << remembered.status();
    return *std::move(remembered);
  };
  const RememberedMap first = remember("options");
  EXPECT_FALSE(first.is_from_file);
  EXPECT_EQ(first.complaint, "");
  const RememberedMap second = remember("options");
  EXPECT_TRUE(second.is_from_file);
  EXPECT_EQ(second.complaint, "");
  EXPECT_EQ(second.map.state.submaps.size(), first.map.state.submaps.size());
  EXPECT_EQ(second.map.places.size(), result().num_places);
  // They match as before.
  const auto matches = [](const RememberedMap& remembered) {
    std::vector<double> scores;
    for (const Match& match :
         MatchWithin(MatchOptions(), std::nullopt, remembered.map.places, 3,
                     Threads(2))) {
      scores.push_back(match.closure.score);
    }
    return scores;
  };
  EXPECT_EQ(matches(first), matches(second));
  // Of other options, or broken: described and written again.
  const RememberedMap other = remember("other options");
  EXPECT_FALSE(other.is_from_file);
  EXPECT_THAT(other.complaint, ::testing::HasSubstr("other options"));
  directory.Write("places", "nonsense");
  const RememberedMap broken = remember("other options");
  EXPECT_FALSE(broken.is_from_file);
  EXPECT_THAT(broken.complaint, ::testing::HasSubstr(file));
  EXPECT_EQ(broken.map.places.size(), first.map.places.size());
  EXPECT_TRUE(remember("other options").is_from_file);
}

TEST_F(SimulatedOfficeTest, RetrievalKeepsTheClosures) {
  LoopClosingOptions options;
  options.use_retrieval = true;
  const auto retrieved = CloseLoops(options, MapPath(), {}, Threads(4));
  ASSERT_TRUE(retrieved.ok()) << retrieved.status();
  EXPECT_LE(retrieved->num_matches, result().num_matches);
  EXPECT_GE(10 * retrieved->closures.size(), 9 * result().closures.size());
}

TEST_F(SimulatedOfficeTest, ClosuresAreRight) {
  int num_in_graph = 0;
  for (const ClosureOutcome& outcome : result().closures) {
    if (outcome.fate != Fate::kInGraph) continue;
    ++num_in_graph;
    const LoopClosure& closure = outcome.match.closure;
    const Rigid2 T_reference_query =
        truth().T_world_submap.at(closure.reference).Inverse() *
        truth().T_world_submap.at(closure.query);
    // In the middle between the two, near what both saw: submaps are bent by
    // local SLAM, and their origins may lie far from that.
    const Eigen::Vector2d p_query =
        T_reference_query.Inverse() *
        Eigen::Vector2d(0.5 * T_reference_query.translation());
    const Rigid2 T_query_middle(p_query, 0.);
    EXPECT_THAT(
        closure.T_reference_query * T_query_middle,
        IsPoseNear(T_reference_query * T_query_middle, 0.5, 5. * kDegree))
        << closure.reference << " " << closure.query << " score "
        << closure.score;
    EXPECT_FALSE(outcome.constraints.empty());
  }
  EXPECT_GE(num_in_graph, 10);
}

TEST_F(SimulatedOfficeTest, TheMapIsBetter) {
  const std::optional<TrajectoryError> before =
      EvaluateTrajectory(result().state.pose_graph, truth());
  const std::optional<TrajectoryError> after =
      EvaluateTrajectory(result().pose_graph, truth());
  ASSERT_TRUE(before.has_value() && after.has_value());
  EXPECT_LT(after->errors.translation.mean,
            before->errors.translation.mean / 3.);
  EXPECT_LT(after->errors.rotation.mean, before->errors.rotation.mean / 2.);
}

TEST_F(SimulatedOfficeTest, TheGraphHoldsTheClosuresConstraints) {
  const std::vector<Constraint>& given = result().state.pose_graph.constraints;
  const std::vector<Constraint>& all = result().pose_graph.constraints;
  size_t num_new = 0;
  for (const ClosureOutcome& outcome : result().closures) {
    EXPECT_EQ(outcome.constraints.empty(), outcome.fate != Fate::kInGraph);
    for (const Constraint& constraint : outcome.constraints) {
      ASSERT_LT(given.size() + num_new, all.size());
      const Constraint& stored = all[given.size() + num_new++];
      EXPECT_EQ(stored.submap, constraint.submap);
      EXPECT_EQ(stored.node, constraint.node);
      EXPECT_EQ(stored.tag, Constraint::Tag::kInterSubmap);
    }
  }
  EXPECT_EQ(all.size(), given.size() + num_new);
  EXPECT_GT(num_new, 0u);
}

void ExpectIdentical(const Rigid2& a, const Rigid2& b) {
  ASSERT_EQ(a.translation(), b.translation());
  ASSERT_EQ(a.rotation(), b.rotation());
}

TEST_F(SimulatedOfficeTest, DoesNotDependOnTheNumberOfThreads) {
  const absl::StatusOr<LoopClosingResult> other =
      CloseLoops(LoopClosingOptions(), MapPath(), {}, Threads(1));
  ASSERT_TRUE(other.ok()) << other.status();
  EXPECT_EQ(other->num_matches, result().num_matches);
  ASSERT_EQ(other->closures.size(), result().closures.size());
  for (size_t k = 0; k < other->closures.size(); ++k) {
    const ClosureOutcome &a = other->closures[k], &b = result().closures[k];
    EXPECT_EQ(a.match.closure.reference, b.match.closure.reference);
    EXPECT_EQ(a.match.closure.query, b.match.closure.query);
    ExpectIdentical(a.match.closure.T_reference_query,
                    b.match.closure.T_reference_query);
    EXPECT_EQ(a.match.closure.score, b.match.closure.score);
    EXPECT_EQ(a.match.closure.information, b.match.closure.information);
    EXPECT_EQ(a.fate, b.fate);
    EXPECT_EQ(a.error.translation, b.error.translation);
    ASSERT_EQ(a.constraints.size(), b.constraints.size());
    for (size_t i = 0; i < a.constraints.size(); ++i) {
      ExpectIdentical(a.constraints[i].T_submap_node,
                      b.constraints[i].T_submap_node);
    }
  }
  for (const auto& [id, node] : other->pose_graph.nodes) {
    ExpectIdentical(node.T_map_node,
                    result().pose_graph.nodes.at(id).T_map_node);
  }
  for (const auto& [id, T_map_submap] : other->pose_graph.submap_poses) {
    ExpectIdentical(T_map_submap, result().pose_graph.submap_poses.at(id));
  }
}

TEST_F(SimulatedOfficeTest, TellsItsStages) {
  std::vector<std::string> stages;
  for (const auto& [stage, seconds] : result().stage_seconds) {
    stages.push_back(stage);
    EXPECT_GE(seconds, 0.);
  }
  EXPECT_THAT(stages, ElementsAre("read and describe", "match and verify",
                                  "ask neighbours", "find torn submaps",
                                  "select consistent", "lift to constraints",
                                  "optimise"));
}

TEST(CloseLoopsTest, FailsWithoutAMap) {
  const absl::StatusOr<LoopClosingResult> result =
      CloseLoops(LoopClosingOptions(), "/nowhere.pbstream", {}, Threads(1));
  ASSERT_FALSE(result.ok());
  EXPECT_THAT(std::string(result.status().message()),
              ::testing::HasSubstr("/nowhere.pbstream"));
}

TEST(LoopClosingOptionsTest, AreValidated) {
  EXPECT_EQ(Validate(LoopClosingOptions()), "");
  const auto error = [](const std::function<void(LoopClosingOptions*)>& set) {
    LoopClosingOptions options;
    set(&options);
    return Validate(options);
  };
  EXPECT_NE(error([](auto* o) { o->min_index_gap = 0; }), "");
  EXPECT_NE(error([](auto* o) { o->withdrawal.max_num_rounds = -1; }), "");
  EXPECT_NE(error([](auto* o) { o->match.inlier_distance_meters = 0.; }), "");
  EXPECT_NE(error([](auto* o) { o->tear.num_parts = 0; }), "");
  EXPECT_NE(error([](auto* o) { o->lifting.num_nodes_per_submap = 0; }), "");
}

// Half a minute on one core.
TEST(RealMapTest, ClosesTheLoopsOfIntel) {
  SKIP_WITHOUT_SHARED_DATA("intel_open_loop.pbstream");
  const std::string path = SharedDataPath("intel_open_loop.pbstream");
  std::map<SubmapId, ObservedPoints> observed;
  const absl::StatusOr<MapState> state =
      ReadMap(path, [&observed](const SubmapId& id, const SubmapSummary&,
                                const OccupancyGrid& grid) {
        observed[id] = ThinnedObservedPoints(grid);
      });
  ASSERT_TRUE(state.ok()) << state.status();
  const absl::StatusOr<Truth> truth =
      ReadTruth(SharedDataPath("intel.truth.csv"));
  ASSERT_TRUE(truth.ok()) << truth.status();
  const absl::StatusOr<std::vector<Relation>> relations =
      ReadRelations(SharedDataPath("intel.relations"));
  ASSERT_TRUE(relations.ok()) << relations.status();

  const absl::StatusOr<LoopClosingResult> result =
      CloseLoops(LoopClosingOptions(), path, {}, Threads(2));
  ASSERT_TRUE(result.ok()) << result.status();
  std::vector<MatchRow> rows;
  for (const ClosureOutcome& outcome : result->closures) {
    if (outcome.fate != Fate::kInGraph) continue;
    MatchRow row;
    row.reference = outcome.match.closure.reference;
    row.query = outcome.match.closure.query;
    row.score = outcome.match.closure.score;
    row.T_reference_query = outcome.match.closure.T_reference_query;
    rows.push_back(row);
  }
  const MatchScore score =
      ScoreMatches(ComputePairTruths(observed, *truth), *truth, rows);
  EXPECT_EQ(score.num_wrong, 0);
  EXPECT_GT(score.num_answers, 500);
  EXPECT_GT(score.recall_at_precision_1, 0.5);

  const RelationErrors before =
      EvaluateRelations(state->pose_graph, *relations, 0.1);
  const RelationErrors after =
      EvaluateRelations(result->pose_graph, *relations, 0.1);
  ASSERT_TRUE(before.loops.has_value() && after.loops.has_value());
  RecordProperty("loops_mean_before",
                 std::to_string(before.loops->translation.mean));
  RecordProperty("loops_mean_after",
                 std::to_string(after.loops->translation.mean));
  EXPECT_GT(before.loops->translation.mean, 0.5);
  // As good as Cartographer's own loop closing: 0.083 m.
  EXPECT_LT(after.loops->translation.mean, 0.1);
}

}  // namespace
}  // namespace cartographer_sdf
