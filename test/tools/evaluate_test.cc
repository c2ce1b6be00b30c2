// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include <string>
#include <vector>

#include "cartographer_sdf/report/match_table.h"
#include "cartographer_sdf/simulation/truth.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/program.h"
#include "test/testing/shared_data.h"
#include "test/testing/small_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::evaluate_test {
namespace {

using ::cartographer_sdf::testing::Container;
using ::cartographer_sdf::testing::SmallMap;
using ::testing::AllOf;
using ::testing::HasSubstr;

// A small map, whose truth is the map moved as a whole.
class EvaluateTest : public ::testing::Test {
 protected:
  EvaluateTest() {
    map_ = directory_.Write("a.pbstream", Container(SmallMap().Records()));
    Truth truth;
    const Rigid2 T_world_map(7., -3., 1.);
    for (int i = 0; i != SmallMap::kNumNodes; ++i) {
      const NodeId id{SmallMap::kTrajectory, i};
      // The pose graph's yaw plus that of the gravity alignment.
      const double gravity_yaw = 0.8 + i;
      truth.T_world_tracking[id] =
          T_world_map * SmallMap::NodePose(i) * Rigid2(0., 0., gravity_yaw);
    }
    truth_ = directory_.File("truth.csv");
    EXPECT_TRUE(WriteTruth(truth_, truth).ok());
  }

  ProgramResult Run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"evaluate", "--input", map_});
    return RunTestProgram(arguments);
  }
  void ExpectFailure(const std::vector<std::string>& arguments,
                     const int exit_code, const std::string& problem) {
    const ProgramResult result = Run(arguments);
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(result.output, "");
    EXPECT_THAT(result.error, HasSubstr(problem));
  }

  testing::TemporaryDirectory directory_;
  std::string map_;
  std::string truth_;
};

TEST_F(EvaluateTest, MeasuresNodesAfterAlignment) {
  const std::string csv = directory_.File("numbers.csv");
  const ProgramResult result = Run({"--truth", truth_, "--csv", csv});
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.output, AllOf(HasSubstr("nodes"), HasSubstr("mean_m")));
  const std::string numbers = directory_.Read("numbers.csv");
  EXPECT_THAT(numbers, AllOf(HasSubstr("subject,quantity,value\n"),
                             HasSubstr("nodes,count,4\n"),
                             HasSubstr("nodes,skipped,0\n")));
  // Truth is written to 1e-9 m, so its errors are below 1e-8 m.
  EXPECT_THAT(numbers,
              ::testing::ContainsRegex("nodes,max_m,[0-9.]+e-(09|10)\n"));
}

TEST_F(EvaluateTest, ScoresMatches) {
  Truth truth;
  // Far enough apart by index to count as a pair.
  SmallMap map;
  map.pose_graph.mutable_trajectory(0)->mutable_submap(1)->set_submap_index(9);
  map.submaps[1].mutable_submap_id()->set_index(9);
  for (proto::Constraint& constraint : *map.pose_graph.mutable_constraint()) {
    if (constraint.submap_id().index() == 1) {
      constraint.mutable_submap_id()->set_index(9);
    }
  }
  map_ = directory_.Write("b.pbstream", Container(map.Records()));
  const SubmapId first{SmallMap::kTrajectory, 0};
  const SubmapId second{SmallMap::kTrajectory, 9};
  // Both see the same cells, since they share a local frame.
  truth.T_world_submap[first] = SmallMap::LocalSubmapPose(0);
  truth.T_world_submap[second] = SmallMap::LocalSubmapPose(1);
  ASSERT_TRUE(WriteTruth(truth_, truth).ok());
  MatchRow match;
  match.reference = first;
  match.query = second;
  match.score = 4.;
  match.T_reference_query =
      truth.T_world_submap[first].Inverse() * truth.T_world_submap[second];
  const std::string matches = directory_.File("matches.csv");
  ASSERT_TRUE(WriteMatches(matches, {match}).ok());
  const std::string csv = directory_.File("numbers.csv");
  const ProgramResult result =
      Run({"--truth", truth_, "--matches", matches, "--csv", csv});
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(
      directory_.Read("numbers.csv"),
      AllOf(HasSubstr("matches,pairs,1\n"), HasSubstr("matches,positives,1\n"),
            HasSubstr("matches,recall_p1,1\n"),
            HasSubstr("matches,threshold,4\n"),
            HasSubstr("matches,wrong,0\n")));
  const ProgramResult labelled =
      Run({"--truth", truth_, "--matches", matches, "--labels",
           directory_.File("labels.csv")});
  EXPECT_EQ(labelled.exit_code, 0) << labelled.error;
  EXPECT_THAT(directory_.Read("labels.csv"),
              HasSubstr("\n5,0,5,9,1.000000,1,right,0.000000,0.000000\n"));
  // Against itself as a second map, all four pairs are equal.
  const ProgramResult both =
      Run({"--truth", truth_, "--matches", matches, "--query", map_,
           "--query_truth", truth_, "--csv", csv});
  EXPECT_EQ(both.exit_code, 0) << both.error;
  EXPECT_THAT(directory_.Read("numbers.csv"),
              AllOf(HasSubstr("matches,pairs,4\n"),
                    HasSubstr("matches,recall_p1,0.25\n")));
}

// Seen by itself alone, from which no pose can come, a pair still counts.
TEST_F(EvaluateTest, DrawsRandomPairs) {
  Truth truth;
  for (const int index : {0, 1}) {
    truth.T_world_submap[{SmallMap::kTrajectory, index}] =
        SmallMap::LocalSubmapPose(index);
  }
  ASSERT_TRUE(WriteTruth(truth_, truth).ok());
  const auto run = [this](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {
        "--truth", truth_,  "--random_pairs",
        "10",      "--csv", directory_.File("numbers.csv")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Run(arguments);
  };
  // Neighbours are no pairs, unless asked for.
  const ProgramResult none = run({});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.error, HasSubstr("have no pair of submaps in common"));
  const std::string curves = directory_.File("curves.csv");
  const ProgramResult one =
      run({"--min_index_gap", "1", "--curves", curves, "--plot",
           directory_.File("plot.svg"), "--max_clearances", "0.5"});
  EXPECT_EQ(one.exit_code, 0) << one.error;
  EXPECT_THAT(directory_.Read("numbers.csv"),
              AllOf(HasSubstr("paper overlap>=0.5,pairs,1\n"),
                    HasSubstr("paper 0.5 m overlap>=0.1,positives,1\n"),
                    HasSubstr("shape_context overlap>=0.7,pairs,1\n"),
                    HasSubstr("sdf overlap>=0.3,recall_p1,")));
  EXPECT_THAT(directory_.Read("curves.csv"), HasSubstr("series,threshold,"));
  EXPECT_THAT(directory_.Read("plot.svg"), HasSubstr("shape_context"));
  const ProgramResult unknown =
      run({"--min_index_gap", "1", "--methods", "magic"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.error, HasSubstr("it is magic"));
}

TEST_F(EvaluateTest, RefusesFlagsThatDoNotGoTogether) {
  ExpectFailure({}, 2, "needs --relations or --truth");
  ExpectFailure({"--relations", "x", "--matches", "y"}, 2,
                "--matches needs --truth");
  ExpectFailure({"--truth", truth_, "--labels", "y"}, 2,
                "--labels needs --matches");
  ExpectFailure({"--truth", truth_, "--matches", "x,y", "--labels", "z"}, 2,
                "a file for each");
  ExpectFailure({"--relations", "x", "--random_pairs", "5"}, 2,
                "--random_pairs needs --truth");
  ExpectFailure({"--truth", truth_, "--random_pairs", "-5"}, 2,
                "--random_pairs must be from 0");
  ExpectFailure(
      {"--truth", truth_, "--random_pairs", "5", "--min_overlaps", "0.5,x"}, 2,
      "--min_overlaps must be numbers");
  ExpectFailure({"--truth", truth_, "--plot", "p.svg"}, 2,
                "need --matches or --random_pairs");
  ExpectFailure({"--truth", truth_, "--query", map_}, 2, "need each other");
  ExpectFailure({"--truth", truth_, "--query", map_, "--query_truth", truth_},
                2, "--query needs --matches");
  ExpectFailure({"--truth", truth_, "--seconds_per_scan", "0"}, 2,
                "--seconds_per_scan must be positive");
}

TEST_F(EvaluateTest, TellsWhatIsWrongWithFiles) {
  ExpectFailure({"--truth", "/nowhere/t.csv"}, 1, "/nowhere/t.csv");
  const std::string relations = directory_.Write("r", "0 1 0 0 0 0 1\n");
  ExpectFailure({"--relations", relations}, 1, "no relation of " + relations);
  const std::string one = directory_.Write(
      "one.csv", "kind,trajectory,index,x,y,yaw\nnode,5,0,1,2,3\n");
  ExpectFailure({"--truth", one}, 1, "too few nodes in common");
  ExpectFailure({"--truth", truth_, "--matches", one}, 1, one);
  const std::string submaps = directory_.Write(
      "submaps.csv", "kind,trajectory,index,x,y,yaw\nsubmap,5,0,1,2,3\n");
  ExpectFailure({"--truth", submaps}, 1, "has no nodes to measure");
  ExpectFailure({"--truth", truth_, "--csv", "/nowhere/n.csv"}, 1,
                "/nowhere/n.csv");
}

TEST(EvaluateRealMapTest, PrintsTheErrorsOfIntel) {
  SKIP_WITHOUT_SHARED_DATA("intel_stock.pbstream");
  const ProgramResult result = RunTestProgram(
      {"evaluate", "--input", SharedDataPath("intel_stock.pbstream"),
       "--relations", SharedDataPath("intel.relations")});
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_EQ(result.error, "");
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("relations        2984   0.069     0.050  0.149"),
                    HasSubstr("loop relations   1211   0.083     0.065  "
                              "0.167")));
}

}  // namespace
}  // namespace cartographer_sdf::evaluate_test
