// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The program cartographer_sdf_run_log as a user runs it.

#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_sdf/evaluation/map_errors.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/simulation/floor_plan.h"
#include "cartographer_sdf/simulation/lidar.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/program.h"
#include "test/testing/shared_data.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::run_log_test {
namespace {

using ::cartographer_sdf::testing::TemporaryDirectory;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kSecondsPerScan = 0.2;
constexpr int kNumScans = 100;

// Around the middle of an L-shaped hall.
Rigid2 TruePose(const int scan) {
  const double angle = 2. * M_PI * scan / kNumScans;
  return Rigid2(5. + 1.5 * std::cos(angle), 4. + 1.5 * std::sin(angle),
                angle + M_PI / 2.);
}

// What a robot with perfect wheels and a laser of 180 beams records there.
std::string SimulatedLog() {
  FloorPlan plan = EmptyFloorPlan({12., 9.}, 0.025);
  FillRectangle({6., 4.5}, {12., 9.}, 0., true, &plan);
  FillRectangle({5.5, 4.}, {9., 6.}, 0., false, &plan);
  FillRectangle({9., 5.}, {4., 7.}, 0., false, &plan);
  FillDisc({5., 4.}, 0.3, &plan);
  std::string log = "# simulated\n";
  for (int i = 0; i < kNumScans; ++i) {
    const Rigid2 T_world_robot = TruePose(i);
    absl::StrAppend(&log, "FLASER 180");
    for (int beam = 0; beam < 180; ++beam) {
      const double angle =
          T_world_robot.rotation() + (beam - 90.) * M_PI / 180.;
      const std::optional<double> range =
          CastRay(plan, T_world_robot.translation(),
                  {std::cos(angle), std::sin(angle)}, 20.);
      absl::StrAppendFormat(&log, " %.3f", range.value_or(80.));
    }
    const Rigid2 pose = TruePose(0).Inverse() * T_world_robot;
    absl::StrAppendFormat(&log, " 0 0 0 %.6f %.6f %.6f %.3f host 0\n",
                          pose.translation().x(), pose.translation().y(),
                          pose.rotation(), 1e9 + kSecondsPerScan * i);
  }
  return log;
}

int NumOccurrences(const std::string& part, const std::string& text) {
  int count = 0;
  for (size_t at = text.find(part); at != std::string::npos;
       at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

class RunLogTest : public ::testing::Test {
 protected:
  ProgramResult Run(const std::string& log,
                    const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {
        "--log=" + log,
        absl::StrCat("--configuration_directories=", directory_.path(), ",",
                     TEST_HOST_CONFIGURATION_DIRECTORY),
        "--configuration_basename=cartographer_mapping_searcher_only.lua"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunProgramFile(TEST_RUN_LOG_PROGRAM, arguments);
  }
  // One line that tells, and nothing written.
  void ExpectFault(const ProgramResult& result, const std::string& problem) {
    EXPECT_EQ(result.exit_code, 1) << result.error;
    EXPECT_THAT(result.error, AllOf(HasSubstr("cartographer_sdf_run_log: "),
                                    HasSubstr(problem)));
    EXPECT_EQ(result.error.find('\n'), result.error.size() - 1) << result.error;
    EXPECT_FALSE(std::filesystem::exists(directory_.File("out.pbstream")));
  }

  TemporaryDirectory directory_;
};

TEST_F(RunLogTest, DrivesASimulatedLog) {
  const std::string log = directory_.Write("Büro.log", SimulatedLog());
  const std::string output = directory_.File("out.pbstream");
  const std::string report = directory_.File("report");
  const ProgramResult result =
      Run(log, {"--output=" + output, "--report=" + report,
                "--result=" + directory_.File("result.json")});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.output, HasSubstr("100 scans"));
  const absl::StatusOr<MapState> state = ReadMap(output);
  ASSERT_TRUE(state.ok()) << state.status();
  const auto& nodes = state->pose_graph.nodes;
  // One every 0.2 m or 2 degrees: all.
  EXPECT_GT(nodes.size(), 0.9 * kNumScans);
  // By the scans, which agree with the odometry only if beams, stamps and signs
  // are right. Two cells.
  for (const auto& [id, node] : nodes) {
    const int scan = static_cast<int>(std::lround(
        1e-7 * static_cast<double>(node.time - nodes.begin()->second.time) /
        kSecondsPerScan));
    const Rigid2 truth = TruePose(0).Inverse() * TruePose(scan);
    const Rigid2 error = truth.Inverse() * TrackingPose(node);
    EXPECT_LT(error.translation().norm(), 0.1) << scan;
    EXPECT_LT(std::abs(error.rotation()), 0.03) << scan;
  }
  EXPECT_THAT(directory_.Read("report/run.json"),
              AllOf(HasSubstr("\"scans\": 100"), HasSubstr("/Büro.log\"")));
  EXPECT_THAT(directory_.Read("result.json"),
              AllOf(HasSubstr("\"scans\": 100"), HasSubstr("/Büro.log\""),
                    HasSubstr("\"status\": \"done\"")));
  EXPECT_THAT(
      directory_.Read("report/nodes.csv"),
      HasSubstr("node,time,distance,x,y,yaw,connected,cpu_seconds\n0,"));
  EXPECT_THAT(directory_.Read("report/index.html"), HasSubstr("</html>"));
}

TEST_F(RunLogTest, HelpNamesFilesThatExist) {
  const ProgramResult help = RunProgramFile(TEST_RUN_LOG_PROGRAM, {"--help"});
  EXPECT_EQ(help.exit_code, 0);
  std::istringstream words(help.output);
  int num_names = 0;
  for (std::string word; words >> word;) {
    const size_t end = word.find(".lua");
    if (end == std::string::npos) continue;
    word.resize(end + 4);
    const size_t begin =
        word.find_last_not_of("abcdefghijklmnopqrstuvwxyz_", end - 1);
    if (begin != std::string::npos) word.erase(0, begin + 1);
    EXPECT_TRUE(std::filesystem::exists(
        absl::StrCat(kTestConfigurationDirectory, "/", word)))
        << word;
    ++num_names;
  }
  EXPECT_GE(num_names, 2);
}

TEST_F(RunLogTest, SearcherAloneDoesNotFloodTheLog) {
  const std::string log = directory_.Write("drive.log", SimulatedLog());
  directory_.Write("small_submaps.lua",
                   "include \"cartographer_mapping_searcher_only.lua\"\n"
                   "TRAJECTORY_BUILDER_2D.submaps.num_range_data = 10\n"
                   "return options\n");
  const ProgramResult result =
      Run(log, {"--configuration_basename=small_submaps.lua", "--verbose"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  // Cartographer's samplers warn whenever one that drops everything is made:
  // once for the trajectory, not for every node and submap near it.
  EXPECT_LE(NumOccurrences("dropping all data", result.error), 1);
  // Its own search for closures is off nevertheless.
  EXPECT_THAT(result.error, HasSubstr(" 0 computations resulted in 0 "));
  EXPECT_THAT(result.error, Not(ContainsRegex("[1-9]0* computations")));
}

TEST_F(RunLogTest, DrivesAPieceInAFrozenMap) {
  const std::string log = directory_.Write("drive.log", SimulatedLog());
  const std::string map = directory_.File("map.pbstream");
  ASSERT_EQ(Run(log, {"--output=" + map}).exit_code, 0);
  const std::string output = directory_.File("out.pbstream");
  const ProgramResult result =
      Run(log, {"--map=" + map, "--output=" + output, "--start=4",
                "--duration=8", "--real_time_factor=20"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.output, HasSubstr("41 scans, 8 s"));
  const absl::StatusOr<MapState> state = ReadMap(output);
  ASSERT_TRUE(state.ok()) << state.status();
  EXPECT_EQ(state->trajectories.size(), 2u);
}

// The maps that results are measured on were made of these logs with these
// options. Points are sampled in a way that depends on their last digits, so
// that local SLAM drifts apart: a millimetre at one beam makes 3 cm of the
// first 17 m, and what differs from then 13 cm and, while turning, 0.05 rad.
TEST_F(RunLogTest, MakesTheMapThatIsKnown) {
  SKIP_WITHOUT_SHARED_DATA("intel.log.gz");
  SKIP_WITHOUT_SHARED_DATA("intel_open_loop.pbstream");
  const std::string output = directory_.File("out.pbstream");
  const ProgramResult result = Run(
      SharedDataPath("intel.log.gz"),
      {"--output=" + output, "--duration=60", "--sdf_configuration_basename="});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const absl::StatusOr<MapState> made = ReadMap(output);
  ASSERT_TRUE(made.ok()) << made.status();
  const absl::StatusOr<MapState> known =
      ReadMap(SharedDataPath("intel_open_loop.pbstream"));
  ASSERT_TRUE(known.ok()) << known.status();
  std::map<int64_t, const Node*> known_by_time;
  for (const auto& [id, node] : known->pose_graph.nodes) {
    known_by_time[node.time] = &node;
  }
  const auto& nodes = made->pose_graph.nodes;
  ASSERT_GT(nodes.size(), 100u);
  const Rigid2 T_map_first = TrackingPose(nodes.begin()->second);
  ASSERT_EQ(known_by_time.count(nodes.begin()->second.time), 1u);
  const Rigid2 T_known_first =
      TrackingPose(*known_by_time.at(nodes.begin()->second.time));
  size_t num_compared = 0;
  for (const auto& [id, node] : nodes) {
    const auto other = known_by_time.find(node.time);
    // Other scans are kept where the robot turned by a little less.
    if (other == known_by_time.end()) continue;
    ++num_compared;
    const Rigid2 error =
        (T_known_first.Inverse() * TrackingPose(*other->second)).Inverse() *
        (T_map_first.Inverse() * TrackingPose(node));
    EXPECT_LT(error.translation().norm(), 0.2) << id;
    EXPECT_LT(std::abs(error.rotation()), 0.08) << id;
  }
  EXPECT_GT(2 * num_compared, nodes.size());
}

TEST_F(RunLogTest, FaultsOfFilesAreOneLine) {
  const std::string log = directory_.Write("drive.log", SimulatedLog());
  const std::string output = "--output=" + directory_.File("out.pbstream");
  ExpectFault(Run(directory_.File("none.log"), {output}), "no such file");
  ExpectFault(Run(directory_.Write("bad.log", "FLASER 2 1 x\n"), {output}),
              "bad.log:1:");
  ExpectFault(
      Run(directory_.Write("short.log", SimulatedLog().substr(0, 1200) + "\n"),
          {output}),
      "short.log:3:");
  ExpectFault(Run(log, {output, "--configuration_basename=none.lua"}),
              "none.lua");
  ExpectFault(Run(log, {output, "--sdf_configuration_basename=none.lua"}),
              "none.lua");
  // Cartographer would abort on these.
  directory_.Write("syntax.lua", "options = {\n");
  ExpectFault(Run(log, {output, "--configuration_basename=syntax.lua"}),
              "unexpected symbol");
  directory_.Write("missing.lua",
                   "include \"cartographer_mapping.lua\"\n"
                   "POSE_GRAPH.optimize_every_n_nodes = nil\nreturn options\n");
  ExpectFault(Run(log, {output, "--configuration_basename=missing.lua"}),
              "optimize_every_n_nodes");
  directory_.Write("unknown.lua",
                   "include \"cartographer_mapping.lua\"\n"
                   "POSE_GRAPH.no_such_option = 1\nreturn options\n");
  ExpectFault(Run(log, {output, "--configuration_basename=unknown.lua"}),
              "no_such_option");
  const std::string map = directory_.Write("map.pbstream", "no map");
  ExpectFault(Run(log, {output, "--map=" + map}), "map.pbstream");
  EXPECT_EQ(Run(log, {"--output=/no/such/place/out.pbstream"}).exit_code, 1);
}

TEST_F(RunLogTest, RosOptionsArePassedOver) {
  const std::string log = directory_.Write("drive.log", SimulatedLog());
  directory_.Write("robot.lua",
                   "include \"cartographer_mapping.lua\"\n"
                   "options.map_frame = \"map\"\n"
                   "options.num_laser_scans = 1\nreturn options\n");
  EXPECT_EQ(Run(log, {"--configuration_basename=robot.lua", "--duration=3"})
                .exit_code,
            0);
}

TEST_F(RunLogTest, WrongUsageIsTold) {
  for (const char* const argument :
       {"--no_such_flag=1", "--start=-1", "--real_time_factor=-2",
        "--field_of_view=400", "--seconds_per_scan=0", "stray"}) {
    const ProgramResult result = Run("a.log", {argument});
    EXPECT_EQ(result.exit_code, 2) << argument << ": " << result.error;
  }
  const ProgramResult help = RunProgramFile(TEST_RUN_LOG_PROGRAM, {"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.output, AllOf(HasSubstr("cartographer_sdf_run_log --log"),
                                 HasSubstr("--real_time_factor"),
                                 Not(HasSubstr("--query"))));
}

}  // namespace
}  // namespace cartographer_sdf::run_log_test
