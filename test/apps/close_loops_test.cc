// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/close_loops.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/evaluation/map_errors.h"
#include "cartographer_sdf/evaluation/match_score.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "cartographer_sdf/simulation/office.h"
#include "cartographer_sdf/simulation/simulated_map.h"
#include "cartographer_sdf/simulation/truth.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/building.h"
#include "test/testing/shared_data.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::close_loops_test {
namespace {

using ::testing::ElementsAre;
using testing::IsPoseNear;

constexpr double kDegree = M_PI / 180.;

Executor Threads(const int num_threads) { return MakeExecutor(num_threads); }

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
    RecognitionOptions options;
    options.verify_neighbourhoods = false;
    std::vector<std::pair<std::string, double>> seconds;
    const StageCallback on_stage;
    StageClock clock(on_stage, &seconds);
    for (const Match& match : RecognizeWithin(
             options, remembered.map.trajectory_places(), Threads(2), &clock)) {
      scores.push_back(match.pair.score);
    }
    return scores;
  };
  EXPECT_EQ(matches(first), matches(second));
  // Of other options, or broken: described and written again.
  const RememberedMap other = remember("other options");
  EXPECT_FALSE(other.is_from_file);
  EXPECT_THAT(other.complaint, ::testing::HasSubstr("other options"));
  const std::string whole = directory.Read("places");
  directory.Write("places", whole.substr(0, whole.size() - 7));
  const RememberedMap broken = remember("other options");
  EXPECT_FALSE(broken.is_from_file);
  EXPECT_THAT(broken.complaint, ::testing::HasSubstr(file));
  EXPECT_EQ(broken.map.places.size(), first.map.places.size());
  EXPECT_TRUE(remember("other options").is_from_file);
  // What was never a file of places is somebody's, and stays.
  directory.Write("places", "a diary");
  EXPECT_THAT(std::string(RememberMap(PlaceOptions(), MatchOptions(), "options",
                                      MapPath(), file, Threads(2))
                              .status()
                              .message()),
              ::testing::HasSubstr("is no file of places"));
  EXPECT_EQ(directory.Read("places"), "a diary");
}

TEST_F(SimulatedOfficeTest, RetrievalKeepsTheClosures) {
  LoopClosingOptions options;
  options.recognition.use_retrieval = false;
  const auto all_pairs = CloseLoops(options, MapPath(), {}, Threads(4));
  ASSERT_TRUE(all_pairs.ok()) << all_pairs.status();
  EXPECT_GE(10 * result().num_matches, 9 * all_pairs->num_matches);
  EXPECT_GE(10 * result().closed.closures.size(),
            9 * all_pairs->closed.closures.size());
}

TEST_F(SimulatedOfficeTest, ClosuresAreRight) {
  int num_in_graph = 0;
  for (const Closure& outcome : result().closed.closures) {
    if (outcome.status != ClosureStatus::kInGraph) continue;
    ++num_in_graph;
    const PairPose& closure = outcome.match.pair;
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
      EvaluateTrajectory(result().closed.pose_graph, truth());
  ASSERT_TRUE(before.has_value() && after.has_value());
  EXPECT_LT(after->errors.translation.mean,
            before->errors.translation.mean / 3.);
  EXPECT_LT(after->errors.rotation.mean, before->errors.rotation.mean / 2.);
}

TEST_F(SimulatedOfficeTest, TheGraphHoldsTheClosuresConstraints) {
  const std::vector<Constraint>& given = result().state.pose_graph.constraints;
  const std::vector<Constraint>& all = result().closed.pose_graph.constraints;
  size_t num_new = 0;
  for (const Closure& outcome : result().closed.closures) {
    EXPECT_EQ(outcome.constraints.empty(),
              outcome.status != ClosureStatus::kInGraph);
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
  ASSERT_EQ(other->closed.closures.size(), result().closed.closures.size());
  for (size_t k = 0; k < other->closed.closures.size(); ++k) {
    const Closure &a = other->closed.closures[k],
                  &b = result().closed.closures[k];
    EXPECT_EQ(a.match.pair.reference, b.match.pair.reference);
    EXPECT_EQ(a.match.pair.query, b.match.pair.query);
    ExpectIdentical(a.match.pair.T_reference_query,
                    b.match.pair.T_reference_query);
    EXPECT_EQ(a.match.pair.score, b.match.pair.score);
    EXPECT_EQ(a.status, b.status);
    EXPECT_EQ(a.graph_error.translation, b.graph_error.translation);
    ASSERT_EQ(a.constraints.size(), b.constraints.size());
    for (size_t i = 0; i < a.constraints.size(); ++i) {
      ExpectIdentical(a.constraints[i].T_submap_node,
                      b.constraints[i].T_submap_node);
    }
  }
  for (const auto& [id, node] : other->closed.pose_graph.nodes) {
    ExpectIdentical(node.T_map_node,
                    result().closed.pose_graph.nodes.at(id).T_map_node);
  }
  for (const auto& [id, T_map_submap] : other->closed.pose_graph.submap_poses) {
    ExpectIdentical(T_map_submap,
                    result().closed.pose_graph.submap_poses.at(id));
  }
}

TEST_F(SimulatedOfficeTest, TellsItsStages) {
  std::vector<std::string> stages;
  std::map<std::string, double> seconds_of;
  for (const auto& [stage, seconds] : result().stage_seconds) {
    stages.push_back(stage);
    seconds_of[stage] = seconds;
  }
  EXPECT_THAT(stages, ElementsAre("read and describe", "match and verify",
                                  "verify neighbourhoods", "find torn submaps",
                                  "select consistent", "generate constraints",
                                  "optimise"));
  // A hundred pairs of submaps, and cycles of their matches.
  EXPECT_GT(seconds_of["match and verify"],
            10. * seconds_of["select consistent"]);
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
  EXPECT_NE(error([](auto* o) { o->recognition.min_index_gap = 0; }), "");
  EXPECT_NE(
      error([](auto* o) { o->closing.outlier_rejection.max_num_rounds = -1; }),
      "");
  EXPECT_NE(
      error([](auto* o) { o->recognition.match.inlier_distance_meters = 0.; }),
      "");
  EXPECT_NE(error([](auto* o) { o->closing.tear.num_parts = 0; }), "");
  EXPECT_NE(
      error([](auto* o) { o->closing.constraints.num_nodes_per_submap = 0; }),
      "");
}

// Half a minute on one core.
TEST(RealMapTest, ClosesTheLoopsOfIntel) {
  SKIP_WITHOUT_SHARED_DATA("intel_open_loop.pbstream");
  const std::string path = SharedDataPath("intel_open_loop.pbstream");
  std::map<SubmapId, ObservedPoints> observed;
  const absl::StatusOr<MapState> state =
      ReadMap(path, {[&observed](const SubmapId& id, const SubmapSummary&,
                                 const OccupancyGrid& grid) {
                observed[id] = ThinnedObservedPoints(grid);
              }});
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
  for (const Closure& outcome : result->closed.closures) {
    if (outcome.status != ClosureStatus::kInGraph) continue;
    MatchRow row;
    row.reference = outcome.match.pair.reference;
    row.query = outcome.match.pair.query;
    row.score = outcome.match.pair.score;
    row.T_reference_query = outcome.match.pair.T_reference_query;
    rows.push_back(row);
  }
  const PairTruths pairs = ComputePairTruths(observed, *truth);
  const MatchScore score = ScoreAnswers(pairs, LabelAnswers(pairs, rows));
  EXPECT_EQ(score.num_wrong, 0);
  // 947 were measured.
  EXPECT_NEAR(score.num_answers, 947, 14);

  const RelationErrors before =
      EvaluateRelations(state->pose_graph, *relations, 0.1);
  const RelationErrors after =
      EvaluateRelations(result->closed.pose_graph, *relations, 0.1);
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
}  // namespace cartographer_sdf::close_loops_test
