// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// relocalize and merge as a user runs them.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/report/json.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/program.h"
#include "test/testing/shared_data.h"
#include "test/testing/two_offices.h"

namespace cartographer_sdf::sessions_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::vector<std::string> NamesOf(const Json& object) {
  std::vector<std::string> names;
  for (const auto& member : object.items()) names.push_back(member.key());
  return names;
}

// Without those that every subcommand has.
std::vector<std::string> NamesOfAnswer(const Json& result) {
  std::vector<std::string> names = NamesOf(result);
  const auto last = std::find(names.begin(), names.end(), "peak_memory_bytes");
  EXPECT_NE(last, names.end());
  names.erase(names.begin(), last == names.end() ? last : last + 1);
  return names;
}

class SessionsTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { offices_ = new testing::TwoOffices; }
  static void TearDownTestSuite() { delete offices_; }
  static std::string File(const std::string& name) {
    return offices_->File(name);
  }
  static Json ParseFile(const std::string& name) {
    return Json::parse(offices_->Read(name));
  }
  static testing::TwoOffices* offices_;
};
testing::TwoOffices* SessionsTest::offices_;

TEST_F(SessionsTest, RelocalizesAndAttaches) {
  const ProgramResult result = RunTestProgram(
      {"relocalize", "--map", offices_->Morning(), "--query",
       offices_->Evening(), "--result", File("found.json"), "--report",
       File("found"), "--output", File("attached.pbstream")});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_EQ(result.error, "");
  EXPECT_THAT(result.output, StartsWith("localized: x "));
  const Json json = ParseFile("found.json");
  EXPECT_THAT(
      NamesOfAnswer(json),
      ElementsAre("localized", "verdict", "reason", "T_map_query",
                  "probability", "runner_up_probability", "score",
                  "runner_up_score", "agreeing", "contradicting", "compared",
                  "crossed", "parts", "jumps", "changed_area", "changes",
                  "closures", "placements", "milliseconds"));
  EXPECT_EQ(json["status"], "done");
  EXPECT_EQ(json["localized"], true);
  EXPECT_EQ(json["verdict"], "localized");
  EXPECT_THAT(NamesOf(json["T_map_query"]), ElementsAre("x", "y", "yaw"));
  EXPECT_GT(json["score"].get<double>(), 0.);
  ASSERT_FALSE(json["closures"].empty());
  EXPECT_EQ(json["closures"].size(), json["agreeing"].get<size_t>());
  EXPECT_THAT(
      NamesOf(json["closures"][0]),
      ElementsAre("reference_trajectory", "reference_index", "query_trajectory",
                  "query_index", "score", "x", "y", "yaw", "overlap",
                  "hit_ratio", "contradiction_ratio"));
  ASSERT_FALSE(json["placements"].empty());
  EXPECT_THAT(NamesOf(json["placements"][0]),
              ElementsAre("T_map_query", "score", "matches", "rival"));
  ASSERT_FALSE(json["milliseconds"].empty());
  EXPECT_TRUE(json["milliseconds"].front().is_number());
  EXPECT_THAT(offices_->Read("found/index.html"),
              AllOf(HasSubstr("evening.pbstream"), HasSubstr("Agreeing"),
                    Not(HasSubstr("://"))));
  // The map stayed to the last bit, the query moved.
  const auto map = ReadMap(offices_->Morning());
  const auto attached = ReadMap(File("attached.pbstream"));
  ASSERT_TRUE(map.ok() && attached.ok());
  EXPECT_EQ(attached->trajectories.size(), 2u);
  for (const auto& [id, node] : map->pose_graph.nodes) {
    const Node& same = attached->pose_graph.nodes.at(id);
    EXPECT_EQ(same.T_map_node.translation(), node.T_map_node.translation());
    EXPECT_EQ(same.T_map_node.rotation(), node.T_map_node.rotation());
  }
  EXPECT_GT(attached->pose_graph.constraints.size(),
            map->pose_graph.constraints.size());
  bool has_inter = false;
  for (const Constraint& constraint : attached->pose_graph.constraints) {
    has_inter |= constraint.submap.trajectory != constraint.node.trajectory;
  }
  EXPECT_TRUE(has_inter);
}

TEST_F(SessionsTest, ARefusalIsAnAnswer) {
  std::vector<std::string> arguments = {
      "relocalize",          "--map",    offices_->Morning(), "--query",
      offices_->Elsewhere(), "--result", File("refused.json")};
  ProgramResult result = RunTestProgram(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.output, StartsWith("not localized: "));
  const Json json = ParseFile("refused.json");
  EXPECT_EQ(json["localized"], false);
  EXPECT_NE(json["reason"], "");
  EXPECT_EQ(json["T_map_query"], nullptr);
  EXPECT_EQ(json["closures"], Json::array());
  // Unless a map was to be made of it.
  arguments.insert(arguments.end(), {"--output", File("refused.pbstream")});
  result = RunTestProgram(arguments);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.error, HasSubstr("was not localized"));
  EXPECT_FALSE(std::filesystem::exists(File("refused.pbstream")));
  EXPECT_EQ(ParseFile("refused.json")["status"], "refused");
  EXPECT_EQ(ParseFile("refused.json")["localized"], false);
  // Or whoever asked wants to know.
  arguments.resize(arguments.size() - 2);
  arguments.insert(arguments.end(), {"--fail_on", "refused"});
  result = RunTestProgram(arguments);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.output, StartsWith("not localized: "));
  EXPECT_THAT(result.error, HasSubstr("--fail_on refused: "));
  EXPECT_EQ(ParseFile("refused.json")["exit_code"], 3);
}

TEST_F(SessionsTest, TriesManyStarts) {
  const ProgramResult result = RunTestProgram(
      {"relocalize", "--map", offices_->Morning(), "--query",
       offices_->Evening(), "--first_seconds", "60", "--num_starts", "3",
       "--places", File("places"), "--result", File("starts.json")});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.output, HasSubstr(" of 3 windows were localized\n"));
  EXPECT_TRUE(std::filesystem::exists(File("places")));
  const Json json = ParseFile("starts.json");
  ASSERT_EQ(json["starts"].size(), 3u);
  EXPECT_EQ(json["counts"]["windows"], 3);
  EXPECT_EQ(json["starts"][0]["start_seconds"], 0.);
  EXPECT_GT(json["starts"][1]["start_seconds"], 0.);
  for (const Json& start : json["starts"]) {
    EXPECT_THAT(NamesOf(start), ElementsAre("start_seconds", "result"));
    EXPECT_TRUE(start["result"]["localized"].is_boolean());
  }
}

TEST_F(SessionsTest, MergesAndTellsOfStrangers) {
  const auto merge = [](const std::string& output, const std::string& threads) {
    return RunTestProgram({"merge", "--inputs",
                           offices_->Elsewhere() + "," + offices_->Evening() +
                               "," + offices_->Morning(),
                           "--output", output, "--result", File("merged.json"),
                           "--report", File("merged"), "--threads", threads});
  };
  const ProgramResult result = merge(File("merged.pbstream"), "1");
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.output,
              HasSubstr("elsewhere.pbstream: NOT in the merged map: "
                        "not connected with the other maps"));
  const Json json = ParseFile("merged.json");
  EXPECT_THAT(
      NamesOfAnswer(json),
      ElementsAre("merged", "reason", "sessions", "pairs", "closures",
                  "overlapping_pairs", "contradicting_pairs", "milliseconds"));
  EXPECT_EQ(json["merged"], true);
  EXPECT_EQ(json["counts"]["sessions_left_out"], 1);
  EXPECT_EQ(json["warnings"][0]["code"], "sessions_left_out");
  ASSERT_EQ(json["sessions"].size(), 3u);
  EXPECT_EQ(json["sessions"][0]["path"], offices_->Elsewhere());
  EXPECT_EQ(json["sessions"][0]["merged"], false);
  EXPECT_EQ(json["sessions"][0]["T_merged_session"], nullptr);
  EXPECT_EQ(json["sessions"][2]["merged"], true);
  ASSERT_EQ(json["pairs"].size(), 3u);
  EXPECT_EQ(json["pairs"][0]["connected"], false);
  EXPECT_THAT(offices_->Read("merged/index.html"),
              HasSubstr("is not in the merged map"));
  const auto merged = ReadMap(File("merged.pbstream"));
  ASSERT_TRUE(merged.ok()) << merged.status();
  EXPECT_EQ(merged->trajectories.size(), 2u);
  // The same bytes, whatever the number of threads.
  ASSERT_EQ(merge(File("again.pbstream"), "3").exit_code, 0);
  EXPECT_EQ(offices_->Read("merged.pbstream"),
            offices_->Read("again.pbstream"));
}

TEST_F(SessionsTest, MergesWhatItRemembers) {
  const std::string inputs = offices_->Evening() + "," + offices_->Morning();
  const auto merge = [&](const std::string& output,
                         const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"merge", "--inputs", inputs,
                                          "--output", File(output)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = RunTestProgram(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.error, "");
    return offices_->Read(output);
  };
  const std::vector<std::string> places = {
      "--places", File("evening.places") + "," + File("morning.places")};
  const std::string merged = merge("described.pbstream", {});
  EXPECT_TRUE(merge("written.pbstream", places) == merged);
  const auto long_ago =
      std::filesystem::last_write_time(File("morning.places")) -
      std::chrono::hours(1);
  for (const char* const name : {"evening.places", "morning.places"}) {
    std::filesystem::last_write_time(File(name), long_ago);
  }
  EXPECT_TRUE(merge("remembered.pbstream", places) == merged);
  for (const char* const name : {"evening.places", "morning.places"}) {
    EXPECT_TRUE(std::filesystem::last_write_time(File(name)) == long_ago);
  }
  // Of another map: described anew, with a warning.
  const ProgramResult swapped = RunTestProgram(
      {"merge", "--inputs", inputs, "--output", File("swapped.pbstream"),
       "--places", File("morning.places") + "," + File("other.places"),
       "--result", File("swapped.json")});
  ASSERT_EQ(swapped.exit_code, 0) << swapped.error;
  EXPECT_THAT(swapped.error, HasSubstr("has the places of another map"));
  EXPECT_EQ(ParseFile("swapped.json")["warnings"][0]["code"],
            "places_not_used");
  EXPECT_TRUE(offices_->Read("swapped.pbstream") == merged);
}

TEST_F(SessionsTest, WrongUsageAndMissingFiles) {
  const auto expect_error = [](const std::vector<std::string>& arguments,
                               const int exit_code,
                               const std::string& message) {
    const ProgramResult result = RunTestProgram(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << message;
    EXPECT_THAT(result.error, HasSubstr(message));
  };
  const std::string map = offices_->Morning();
  expect_error({"relocalize", "--map", map}, 2, "--query");
  expect_error({"relocalize", "--map", map, "--query", File("absent")}, 1,
               "absent");
  expect_error(
      {"relocalize", "--map", map, "--query", map, "--first_seconds", "0"}, 2,
      "--first_seconds must be positive");
  expect_error(
      {"relocalize", "--map", map, "--query", map, "--start_seconds", "1"}, 2,
      "--start_seconds needs --first_seconds");
  expect_error(
      {"relocalize", "--map", map, "--query", map, "--num_starts", "5"}, 2,
      "--num_starts needs --first_seconds");
  expect_error({"relocalize", "--map", map, "--query", map, "--first_seconds",
                "5", "--output", File("x")},
               2, "--output");
  expect_error({"merge", "--inputs", map, "--output", File("x")}, 2,
               "two maps");
  expect_error({"merge", "--inputs", map + "," + map, "--output", File("x")}, 1,
               "is given twice");
  expect_error({"merge", "--inputs", map + "," + offices_->Elsewhere(),
                "--output", File("x")},
               3, "no two of the maps are connected");
  EXPECT_THAT(
      RunTestProgram({"merge", "--inputs", map + "," + offices_->Elsewhere(),
                      "--output", File("x")})
          .output,
      HasSubstr("NOT in the merged map: not connected with the other "
                "maps"));
  expect_error({"merge", "--inputs", map + "," + offices_->Evening(),
                "--output", File("x"), "--places", File("y")},
               2, "--places takes as many files as there are inputs");
  // Maps without a flag, in any number.
  expect_error({"merge", map, offices_->Elsewhere(), "-o", File("x")}, 3,
               "no two of the maps are connected");
  expect_error(
      {"merge", "--inputs", map + "," + offices_->Evening(), "--output", map},
      1, "it is one of the files that are read");
  expect_error({"merge", "--inputs", map + "," + offices_->Evening(),
                "--output", File("x"), "--frozen_trajectories", "1"},
               1, "cannot be frozen");
  EXPECT_FALSE(std::filesystem::exists(File("x")));
}

}  // namespace
}  // namespace cartographer_sdf::sessions_test
