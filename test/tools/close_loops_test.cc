// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The whole path as a user walks it: simulate, close_loops, evaluate, match.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/evaluation/map_errors.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/place_store/place_file.h"
#include "cartographer_sdf/report/json.h"
#include "cartographer_sdf/report/match_table.h"
#include "cartographer_sdf/simulation/truth.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/node_motion.h"
#include "test/testing/open_counter.h"
#include "test/testing/program.h"
#include "test/testing/shared_data.h"
#include "test/testing/slipped_map.h"
#include "test/testing/temporary_directory.h"
#include "test/testing/two_offices.h"

namespace cartographer_sdf::close_loops_test {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

class CloseLoopsTest : public ::testing::Test {
 protected:
  // Once for all tests: it takes some seconds.
  static void SetUpTestSuite() {
    directory_ = new testing::TemporaryDirectory();
    const ProgramResult result =
        RunTestProgram({"simulate", "--output", File("open.pbstream"),
                        "--truth", File("truth.csv"), "--length", "240"});
    ASSERT_EQ(result.exit_code, 0) << result.error;
  }
  static void TearDownTestSuite() { delete directory_; }

  static std::string File(const std::string& name) {
    return directory_->File(name);
  }
  static ProgramResult CloseLoops(const std::string& output,
                                  std::vector<std::string> more) {
    more.insert(more.begin(), {"close_loops", "--input", File("open.pbstream"),
                               "--output", File(output)});
    return RunTestProgram(more);
  }
  // Odometry turns twenty times as much as local SLAM lets pass.
  static std::string WriteDriveWithPoorOdometry() {
    DriftOptions drift;
    drift.odometry_yaw_bias = 0.01;
    drift.local_slam_fraction = 0.05;
    const std::string path = File("poor.pbstream");
    testing::WriteShortDrive(testing::MakeSmallOffice(1), 1, path,
                             /*with_submaps=*/true, drift);
    return path;
  }
  static double MeanNodeError(const std::string& map) {
    const ProgramResult result =
        RunTestProgram({"evaluate", "--input", File(map), "--truth",
                        File("truth.csv"), "--csv", File(map + ".csv")});
    EXPECT_EQ(result.exit_code, 0) << result.error;
    const std::string csv = directory_->Read(map + ".csv");
    const size_t begin = csv.find("nodes,mean_m,");
    EXPECT_NE(begin, std::string::npos) << csv;
    return std::stod(csv.substr(begin + 13));
  }

  static testing::TemporaryDirectory* directory_;
};

testing::TemporaryDirectory* CloseLoopsTest::directory_ = nullptr;

TEST_F(CloseLoopsTest, StraightensASimulatedMap) {
  const ProgramResult result = CloseLoops(
      "closed.pbstream",
      {"--closures", File("closures.csv"), "--report", File("report")});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  // No progress where nobody watches.
  EXPECT_EQ(result.error, "");
  EXPECT_THAT(result.output, HasSubstr("in_graph"));

  const double before = MeanNodeError("open.pbstream");
  const double after = MeanNodeError("closed.pbstream");
  EXPECT_GT(before, 0.3);
  // What local SLAM's noise leaves within submaps: 0.03 m.
  EXPECT_LT(after, 0.08);

  const auto truth = ReadTruth(File("truth.csv"));
  const auto closures = ReadMatches(File("closures.csv"));
  ASSERT_TRUE(truth.ok() && closures.ok());
  EXPECT_GT(closures->size(), 20u);
  for (const MatchRow& closure : *closures) {
    EXPECT_TRUE(closure.accepted);
    const Rigid2 T_reference_query =
        truth->T_world_submap.at(closure.reference).Inverse() *
        truth->T_world_submap.at(closure.query);
    const Rigid2 error =
        T_reference_query.Inverse() * closure.T_reference_query;
    EXPECT_LT(error.translation().norm(), 0.5)
        << closure.reference << " " << closure.query;
    EXPECT_LT(std::abs(error.rotation()), 0.09);
  }

  const std::string page = directory_->Read("report/index.html");
  EXPECT_THAT(
      page, AllOf(HasSubstr("open.pbstream"), HasSubstr("Before"),
                  HasSubstr("SDF_GLOBAL_CONSTRAINTS"), Not(HasSubstr("://"))));
}

TEST_F(CloseLoopsTest, TellsWhetherCartographerWouldBendTheMap) {
  const std::string poor = WriteDriveWithPoorOdometry();
  const std::vector<std::string> arguments = {
      "close_loops",   poor, "-o", File("poor_closed.pbstream"), "--fail_on",
      "odometry_bends"};
  const ProgramResult with_odometry = RunTestProgram(arguments);
  EXPECT_EQ(with_odometry.exit_code, 3) << with_odometry.error;
  EXPECT_THAT(with_odometry.output,
              AllOf(HasSubstr("Cartographer would move nodes by up to "),
                    HasSubstr("or write it with --drop_odometry.\n")));
  std::vector<std::string> more = arguments;
  more.emplace_back("--drop_odometry");
  const ProgramResult without = RunTestProgram(more);
  EXPECT_EQ(without.exit_code, 0) << without.error;
  EXPECT_THAT(without.output, Not(HasSubstr("Cartographer would move")));
  const auto map = ReadMap(File("poor_closed.pbstream"));
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_EQ(map->num_records.count("odometry_data"), 0u);
  // Nothing is written.
  EXPECT_EQ(RunTestProgram({"audit", poor, "--drop_odometry"}).exit_code, 2);
}

TEST_F(CloseLoopsTest, DropsOdometryThatHasShapedAMap) {
  const std::string poor = WriteDriveWithPoorOdometry();
  directory_->Write("trusting.lua",
                    "include \"sdf_global_constraints.lua\"\n"
                    "SDF_GLOBAL_CONSTRAINTS.loop_closing.closing."
                    "infer_odometry_weights = false\n"
                    "return SDF_GLOBAL_CONSTRAINTS\n");
  const std::string shaped = File("shaped.pbstream");
  const ProgramResult closed = RunTestProgram(
      {"close_loops", poor, "-o", shaped, "--configuration_directory",
       directory_->path(), "--configuration_basename", "trusting.lua"});
  ASSERT_EQ(closed.exit_code, 0) << closed.error;
  // All closures are in it already, and none of its constraints is doubtful.
  for (const std::string subcommand : {"close_loops", "audit"}) {
    const std::string output = File(subcommand + "_without.pbstream");
    const ProgramResult without =
        RunTestProgram({subcommand, shaped, "-o", output, "--drop_odometry"});
    EXPECT_EQ(without.exit_code, 0) << without.error;
    const auto before = ReadMap(shaped);
    const auto after = ReadMap(output);
    ASSERT_TRUE(before.ok() && after.ok()) << subcommand;
    EXPECT_EQ(before->pose_graph.constraints.size(),
              after->pose_graph.constraints.size())
        << subcommand;
    EXPECT_GT(testing::LargestMotion(before->pose_graph, after->pose_graph),
              0.02)
        << subcommand;
  }
}

TEST_F(CloseLoopsTest, TellsOfTornSubmaps) {
  const std::string slipped = File("slipped.pbstream");
  testing::WriteOffice(testing::Slip::kInSubmaps8And9, slipped);
  const ProgramResult info =
      RunTestProgram({"info", "--input", slipped, "--torn_submaps"});
  EXPECT_EQ(info.exit_code, 0) << info.error;
  EXPECT_THAT(info.output,
              AllOf(HasSubstr("Torn submaps: 2\n"), HasSubstr("\n  0,8: part"),
                    HasSubstr("\n  0,9: part")));
  // Only on demand: it takes time.
  EXPECT_THAT(RunTestProgram({"info", "--input", slipped}).output,
              Not(HasSubstr("Torn")));
  const ProgramResult quality =
      RunTestProgram({"info", "--input", slipped, "--quality"});
  EXPECT_EQ(quality.exit_code, 0) << quality.error;
  EXPECT_THAT(
      quality.output,
      AllOf(HasSubstr("Torn submaps: 2\n"), HasSubstr("places seen twice ("),
            HasSubstr("submaps two apart in local SLAM ("),
            HasSubstr("- local SLAM slipped: 2 submaps are torn inside")));
  const ProgramResult closed = RunTestProgram(
      {"close_loops", "--input", slipped, "--output",
       File("slipped_closed.pbstream"), "--report", File("slipped_report")});
  EXPECT_EQ(closed.exit_code, 0) << closed.error;
  EXPECT_THAT(closed.output, AllOf(HasSubstr("2 submaps are torn inside:\n"),
                                   HasSubstr("\n  0,9: part")));
  EXPECT_THAT(directory_->Read("slipped_report/index.html"),
              AllOf(HasSubstr("torn inside"), HasSubstr("0,9: part")));
}

TEST_F(CloseLoopsTest, TellsOfSlips) {
  const std::string slipping = File("slipping.pbstream");
  DriftOptions drift;
  // Some 0.02 rad between two scans.
  drift.odometry_yaw_bias = 0.5;
  drift.local_slam_fraction = 0.;
  testing::WriteShortDrive(testing::MakeSmallOffice(1), 1, slipping,
                           /*with_submaps=*/true, drift);
  directory_->Write("sensitive.lua",
                    "include \"sdf_global_constraints.lua\"\n"
                    "SDF_GLOBAL_CONSTRAINTS.loop_closing.closing.optimization."
                    "min_slip_angle = 0.01\n"
                    "return SDF_GLOBAL_CONSTRAINTS\n");
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(),
                     {"--configuration_directory", directory_->path(),
                      "--configuration_basename", "sensitive.lua"});
    return RunTestProgram(arguments);
  };
  const ProgramResult closed =
      run({"close_loops", slipping, "-o", File("slipping_closed.pbstream"),
           "--report", File("slipping_report"), "--result", File("slips.json"),
           "--fail_on", "slips"});
  EXPECT_EQ(closed.exit_code, 3) << closed.error;
  EXPECT_THAT(closed.output,
              ContainsRegex("Local SLAM slipped at [0-9]+ steps, in [0-9]+ "
                            "submaps: there odometry turned by angles that "
                            "differ by up to [0-9.]+ deg; where closures ask "
                            "for it, the map gives way.\n"));
  EXPECT_THAT(directory_->Read("slipping_report/index.html"),
              AllOf(HasSubstr("Local SLAM slipped at"),
                    HasSubstr("local SLAM slipped in it")));
  const Json result = Json::parse(directory_->Read("slips.json"));
  const Json& slips = result["slips"];
  ASSERT_GT(slips.size(), 3u);
  for (const Json& slip : slips) {
    EXPECT_GT(std::abs(slip["angle"].get<double>()), 0.01);
  }
  EXPECT_THAT(run({"info", slipping, "--torn_submaps"}).output,
              HasSubstr("\nLocal SLAM slipped at "));
  EXPECT_THAT(run({"info", slipping, "--quality"}).output,
              ContainsRegex("at [0-9]+ steps odometry turned otherwise"));
}

// What takes the time with large maps. Once to read, and once to write.
TEST_F(CloseLoopsTest, DecompressesItsInputTwice) {
  testing::OpenCounter counter(File("open.pbstream"));
  const ProgramResult bare = CloseLoops("bare.pbstream", {});
  ASSERT_EQ(bare.exit_code, 0) << bare.error;
  EXPECT_EQ(counter.Count(), 2);
  const ProgramResult reported =
      CloseLoops("reported.pbstream", {"--report", File("another_report")});
  ASSERT_EQ(reported.exit_code, 0) << reported.error;
  // Once more for the checksum in the report, which decompresses nothing.
  EXPECT_EQ(counter.Count(), 5);
  EXPECT_TRUE(directory_->Read("bare.pbstream") ==
              directory_->Read("reported.pbstream"));
  const ProgramResult info = RunTestProgram(
      {"info", "--input", File("open.pbstream"), "--torn_submaps"});
  ASSERT_EQ(info.exit_code, 0) << info.error;
  EXPECT_EQ(counter.Count(), 6);
}

TEST_F(CloseLoopsTest, DoesNotDependOnThreads) {
  for (const std::string threads : {"1", "3"}) {
    const ProgramResult result = CloseLoops(
        threads + ".pbstream",
        {"--threads", threads, "--closures", File(threads + ".csv")});
    ASSERT_EQ(result.exit_code, 0) << result.error;
  }
  EXPECT_TRUE(directory_->Read("1.pbstream") == directory_->Read("3.pbstream"));
  EXPECT_EQ(directory_->Read("1.csv"), directory_->Read("3.csv"));
}

TEST_F(CloseLoopsTest, KeepsFrozenTrajectories) {
  const ProgramResult result =
      CloseLoops("frozen.pbstream", {"--frozen_trajectories", "0"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const auto before = ReadMap(File("open.pbstream"));
  const auto after = ReadMap(File("frozen.pbstream"));
  ASSERT_TRUE(before.ok() && after.ok());
  EXPECT_GT(after->pose_graph.constraints.size(),
            before->pose_graph.constraints.size());
  for (const auto& [id, node] : before->pose_graph.nodes) {
    EXPECT_EQ(after->pose_graph.nodes.at(id).T_map_node.translation(),
              node.T_map_node.translation());
  }
}

TEST_F(CloseLoopsTest, LeavesAMapWithoutClosuresAsItIs) {
  directory_->Write("strict.lua",
                    "include \"sdf_global_constraints.lua\"\n"
                    "SDF_GLOBAL_CONSTRAINTS.loop_closing.recognition."
                    "match.verification.judgement.min_score = 1e6\n"
                    "return SDF_GLOBAL_CONSTRAINTS\n");
  const ProgramResult result = CloseLoops(
      "same.pbstream", {"--configuration_directory", directory_->path(),
                        "--configuration_basename", "strict.lua"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.output, HasSubstr("No loop closure was found"));
  EXPECT_TRUE(directory_->Read("same.pbstream") ==
              directory_->Read("open.pbstream"));
}

TEST_F(CloseLoopsTest, RefusesInOneLineAndWritesNothing) {
  const struct {
    std::vector<std::string> arguments;
    int exit_code;
    std::string problem;
  } cases[] = {
      {{"--configuration_basename", "paper.lua"}, 1, "match.method"},
      {{"--configuration_basename", "none.lua"}, 1, "none.lua"},
      {{"--configuration_directory", "/none"}, 1, "/none"},
      {{"--frozen_trajectories", "one"}, 2, "one"},
      {{"--frozen_trajectories", "7"}, 1, "has no trajectory 7"},
      {{"--threads", "-1"}, 2, "--threads"},
      {{"--closures", "/none/closures.csv"}, 1, "/none/closures.csv"},
      {{"--report", "/dev/null/report"}, 1, "/dev/null/report"},
  };
  for (const auto& test : cases) {
    const ProgramResult result = CloseLoops("never.pbstream", test.arguments);
    EXPECT_EQ(result.exit_code, test.exit_code) << result.error;
    EXPECT_THAT(result.error, HasSubstr(test.problem));
    EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1)
        << result.error;
    EXPECT_FALSE(std::filesystem::exists(File("never.pbstream")))
        << test.problem;
  }
}

// A truth of another building would say that the map is tens of metres off.
TEST_F(CloseLoopsTest, ATruthOfAnotherMapIsNoticed) {
  ASSERT_EQ(
      RunTestProgram({"simulate", "--output", File("other.pbstream"), "--truth",
                      File("other.csv"), "--length", "240", "--plan_seed", "5"})
          .exit_code,
      0);
  const ProgramResult result =
      RunTestProgram({"evaluate", File("open.pbstream"), "--truth",
                      File("other.csv"), "--result", "-"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("is the truth of another map"));
  EXPECT_THAT(result.output, HasSubstr("\"status\": \"failed\""));
}

TEST_F(CloseLoopsTest, PicturesShowTheMapAsItBecomes) {
  ASSERT_EQ(CloseLoops("drawn.pbstream", {"--picture", File("drawn.png"),
                                          "--picture_pixels", "200"})
                .exit_code,
            0);
  // That of the map that was written.
  ASSERT_EQ(RunTestProgram({"export", File("drawn.pbstream"), "--png",
                            File("again.png"), "--picture_pixels", "200"})
                .exit_code,
            0);
  EXPECT_EQ(directory_->Read("drawn.png"), directory_->Read("again.png"));
  EXPECT_EQ(CloseLoops("x.pbstream", {"--picture_pixels", "3"}).exit_code, 2);
}

TEST_F(CloseLoopsTest, MatchesByEitherMethod) {
  for (const std::string method : {"sdf", "paper"}) {
    const ProgramResult result =
        RunTestProgram({"match", "--input", File("open.pbstream"), "--output",
                        File(method + ".csv"), "--method", method});
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const auto matches = ReadMatches(File(method + ".csv"));
    ASSERT_TRUE(matches.ok()) << matches.status();
    EXPECT_GT(
        std::count_if(matches->begin(), matches->end(),
                      [](const MatchRow& match) { return match.accepted; }),
        20);
    for (const MatchRow& match : *matches) {
      EXPECT_TRUE(match.reference < match.query);
    }
  }
}

TEST_F(CloseLoopsTest, SimulatesAsLargeAsAsked) {
  const auto simulate = [](const std::vector<std::string>& flags) {
    std::vector<std::string> arguments = {"simulate", "--output",
                                          File("short.pbstream"), "--truth",
                                          File("short.csv")};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    return RunTestProgram(arguments);
  };
  const ProgramResult result =
      simulate({"--length", "60", "--plan_width", "60", "--plan_height", "50"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const auto map = ReadMap(File("short.pbstream"));
  const auto longer = ReadMap(File("open.pbstream"));
  ASSERT_TRUE(map.ok() && longer.ok());
  // 60 m of 240 m, at a submap every 12 m or so.
  EXPECT_GE(map->submaps.size(), 2u);
  EXPECT_LT(3 * map->submaps.size(), longer->submaps.size());
  EXPECT_THAT(simulate({"--plan_width", "5"}).error, HasSubstr("width"));
  EXPECT_THAT(simulate({"--length", "-1"}).error, HasSubstr("length"));
}

// Of one map, and of two of one building whose ids are the same.
TEST_F(CloseLoopsTest, MatchesCanBeAskedToAgree) {
  ASSERT_EQ(RunTestProgram({"simulate", "--output", File("second.pbstream"),
                            "--truth", File("second.csv"), "--seed", "2",
                            "--length", "240"})
                .exit_code,
            0);
  for (const bool two_maps : {false, true}) {
    std::vector<std::string> arguments = {"match", "--input",
                                          File("open.pbstream")};
    if (two_maps) {
      arguments.insert(arguments.end(), {"--query", File("second.pbstream")});
    }
    const auto match = [&arguments](const std::string& output,
                                    const std::vector<std::string>& more) {
      std::vector<std::string> all = arguments;
      all.insert(all.end(), {"--output", File(output)});
      all.insert(all.end(), more.begin(), more.end());
      const ProgramResult result = RunTestProgram(all);
      EXPECT_EQ(result.exit_code, 0) << result.error;
      return *ReadMatches(File(output));
    };
    // A threshold that lets wrong ones through, and nobody who tells them
    // apart.
    directory_->Write("lax.lua",
                      "include \"sdf_global_constraints.lua\"\n"
                      "local judgement = SDF_GLOBAL_CONSTRAINTS.loop_closing."
                      "recognition.match.verification.judgement\n"
                      "judgement.min_score = -3.\n"
                      "judgement.min_margin = 0.\n"
                      "return SDF_GLOBAL_CONSTRAINTS");
    const std::vector<std::string> lax = {
        "--configuration_directory", directory_->path(),
        "--configuration_basename", "lax.lua", "--alone"};
    const std::vector<MatchRow> alone = match("alone.csv", lax);
    std::vector<std::string> agree = lax;
    agree.insert(agree.end(), {"--agree", "--terms", File("terms.csv")});
    const std::vector<MatchRow> agreeing = match("agreeing.csv", agree);
    ASSERT_EQ(alone.size(), agreeing.size());
    int num_refused = 0;
    int num_accepted = 0;
    for (size_t k = 0; k != alone.size(); ++k) {
      EXPECT_EQ(alone[k].score, agreeing[k].score);
      num_accepted += agreeing[k].accepted;
      if (alone[k].accepted == agreeing[k].accepted) {
        EXPECT_EQ(alone[k].verdict, agreeing[k].verdict);
        continue;
      }
      EXPECT_TRUE(alone[k].accepted);
      EXPECT_THAT(agreeing[k].verdict,
                  ::testing::AnyOf("unsupported", "inconsistent"));
      ++num_refused;
    }
    EXPECT_GT(num_refused, 0);
    EXPECT_GT(num_accepted, 20);
    const std::string terms = directory_->Read("terms.csv");
    EXPECT_EQ(std::count(terms.begin(), terms.end(), '\n'),
              static_cast<int>(alone.size()) + 1);
  }
  for (const std::vector<std::string>& flags :
       {std::vector<std::string>{"--agree"},
        {"--alone"},
        {"--terms", File("t.csv")},
        {"--neighbour_terms", File("t.csv")}}) {
    std::vector<std::string> arguments = {
        "match",    "--input",       File("open.pbstream"),
        "--output", File("not.csv"), "--method",
        "paper"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const ProgramResult result = RunTestProgram(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.error, HasSubstr("method sdf"));
  }
}

TEST_F(CloseLoopsTest, UserMapsRun) {
  for (const std::string name :
       {"user_map_arena", "user_map_odometry", "user_map_two_sessions"}) {
    SKIP_WITHOUT_SHARED_DATA(name + ".pbstream");
    const ProgramResult result = RunTestProgram(
        {"close_loops", "--input", SharedDataPath(name + ".pbstream"),
         "--output", File(name + ".pbstream"), "--report", File(name)});
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_TRUE(ReadMap(File(name + ".pbstream")).ok());
  }
}

// The second time and in the closed map, whose submaps are the same; with an
// answer that is the same, byte for byte.
TEST_F(CloseLoopsTest, RemembersWhatSubmapsLookLike) {
  const std::string places = File("a.places");
  const auto close = [&](const std::string& output) {
    const ProgramResult result = CloseLoops(
        output, {"--places", places, "--result", File("remembered.json")});
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.error, "");
    return directory_->Read(output);
  };
  const std::string closed = close("first.pbstream");
  // A file that fits is not written again.
  const auto long_ago =
      std::filesystem::last_write_time(places) - std::chrono::hours(1);
  std::filesystem::last_write_time(places, long_ago);
  const auto is_unchanged = [&] {
    return std::filesystem::last_write_time(places) == long_ago;
  };
  EXPECT_TRUE(close("second.pbstream") == closed);
  EXPECT_TRUE(is_unchanged());
  ASSERT_EQ(CloseLoops("third.pbstream", {}).exit_code, 0);
  EXPECT_TRUE(directory_->Read("third.pbstream") == closed);
  const ProgramResult again =
      RunTestProgram({"close_loops", File("first.pbstream"), "--output",
                      File("fourth.pbstream"), "--places", places});
  ASSERT_EQ(again.exit_code, 0) << again.error;
  EXPECT_EQ(again.error, "");
  EXPECT_TRUE(is_unchanged());
  // It is read, in place of the grids: what it lacks is not found.
  const auto key =
      MakePlaceFileKey(File("open.pbstream"),
                       FormatPlaceOptions(PlaceOptions(), MatchOptions()));
  ASSERT_TRUE(key.ok()) << key.status();
  ASSERT_TRUE(WritePlaces(places, *key, {}).ok());
  EXPECT_TRUE(close("fifth.pbstream") == directory_->Read("open.pbstream"));
}

}  // namespace
}  // namespace cartographer_sdf::close_loops_test
