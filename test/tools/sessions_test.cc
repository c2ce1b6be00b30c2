// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// relocalize and merge as a user runs them.

#include <filesystem>
#include <string>
#include <vector>

#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/tools/session_json.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/program.h"
#include "test/testing/shared_data.h"
#include "test/testing/two_offices.h"

namespace cartographer_sdf {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class SessionsTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { offices_ = new testing::TwoOffices; }
  static void TearDownTestSuite() { delete offices_; }
  static std::string File(const std::string& name) {
    return offices_->File(name);
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
  const std::string json = offices_->Read("found.json");
  EXPECT_THAT(json, AllOf(HasSubstr("\"localized\": true"),
                          HasSubstr("\"T_map_query\": {\"x\": "),
                          HasSubstr("\"runner_up_score\": "),
                          HasSubstr("\"closures\": [\n"),
                          HasSubstr("\"milliseconds\": {")));
  EXPECT_THAT(offices_->Read("found/index.html"),
              AllOf(HasSubstr("evening.pbstream"), HasSubstr("Agreeing"),
                    Not(HasSubstr("http"))));
  // The map stayed to the last bit, the query moved.
  const auto map = ReadMap(offices_->Morning());
  const auto attached = ReadMap(File("attached.pbstream"));
  ASSERT_TRUE(map.ok() && attached.ok());
  EXPECT_EQ(attached->num_trajectories, 2);
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
  EXPECT_THAT(offices_->Read("refused.json"),
              AllOf(HasSubstr("\"localized\": false"),
                    HasSubstr("\"T_map_query\": null")));
  // Unless a map was to be made of it.
  arguments.insert(arguments.end(), {"--output", File("refused.pbstream")});
  result = RunTestProgram(arguments);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("was not localized"));
  EXPECT_FALSE(std::filesystem::exists(File("refused.pbstream")));
}

TEST_F(SessionsTest, TriesManyStarts) {
  const ProgramResult result = RunTestProgram(
      {"relocalize", "--map", offices_->Morning(), "--query",
       offices_->Evening(), "--first_seconds", "60", "--num_starts", "3",
       "--places", File("places"), "--result", File("starts.json")});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.output, HasSubstr(" of 3 windows were localized\n"));
  EXPECT_TRUE(std::filesystem::exists(File("places")));
  EXPECT_THAT(offices_->Read("starts.json"),
              StartsWith("[{\"start_seconds\": 0, \"result\": {\n"));
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
  EXPECT_THAT(result.output, HasSubstr("elsewhere.pbstream: NOT CONNECTED"));
  EXPECT_THAT(
      offices_->Read("merged.json"),
      AllOf(HasSubstr("\"merged\": true"), HasSubstr("\"connected\": false")));
  EXPECT_THAT(offices_->Read("merged/index.html"),
              HasSubstr("is not connected with the others"));
  const auto merged = ReadMap(File("merged.pbstream"));
  ASSERT_TRUE(merged.ok()) << merged.status();
  EXPECT_EQ(merged->num_trajectories, 2);
  // The same bytes, whatever the number of threads.
  ASSERT_EQ(merge(File("again.pbstream"), "3").exit_code, 0);
  EXPECT_EQ(offices_->Read("merged.pbstream"),
            offices_->Read("again.pbstream"));
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
               1, "no two of the maps are connected");
  expect_error(
      {"merge", "--inputs", map + "," + offices_->Evening(), "--output", map},
      1, "it is one of the maps that are read");
  expect_error({"merge", "--inputs", map + "," + offices_->Evening(),
                "--output", File("x"), "--frozen_trajectories", "1"},
               1, "cannot be frozen");
  EXPECT_FALSE(std::filesystem::exists(File("x")));
}

TEST(QuoteJsonTest, AnyBytesAreAString) {
  EXPECT_EQ(QuoteJson("plain"), "\"plain\"");
  EXPECT_EQ(QuoteJson("a\"b\\c\n\x01"), "\"a\\\"b\\\\c\\u000a\\u0001\"");
  EXPECT_EQ(QuoteJson("gr\xc3\xbc\xc3\x9f"), "\"gr\xc3\xbc\xc3\x9f\"");
  EXPECT_EQ(QuoteJson("\xff\xc3"), "\"??\"");
}

}  // namespace
}  // namespace cartographer_sdf
