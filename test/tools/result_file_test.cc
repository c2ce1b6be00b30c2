// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// --result, --fail_on and exit codes, as scripts use them. That every
// subcommand keeps to the schema is tested by
// test/scripts/result_schema_test.py.

#include "cartographer_sdf/tools/result_file.h"

#include <filesystem>
#include <string>
#include <vector>

#include "cartographer_sdf/file/sha256.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/program.h"
#include "test/testing/small_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::result_file_test {
namespace {

using ::cartographer_sdf::testing::Container;
using ::cartographer_sdf::testing::SmallMap;
using ::testing::HasSubstr;

// Without odometry, which contradicts local SLAM there and would be warned of.
SmallMap MapWithoutSlips() {
  SmallMap map;
  map.odometry.clear();
  return map;
}

class ResultFileTest : public ::testing::Test {
 protected:
  ResultFileTest()
      : content_(Container(MapWithoutSlips().Records())),
        map_(directory_.Write("a.pbstream", content_)),
        result_(directory_.File("result.json")) {}

  Json Result() const { return Json::parse(directory_.Read("result.json")); }

  const testing::TemporaryDirectory directory_;
  const std::string content_;
  const std::string map_;
  const std::string result_;
};

TEST_F(ResultFileTest, SaysWhatWasDone) {
  const ProgramResult run = RunTestProgram({"info", map_, "--result", result_});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const Json json = Result();
  EXPECT_EQ(json["schema"], kResultSchema);
  EXPECT_EQ(json["schema_version"], kResultSchemaVersion);
  EXPECT_EQ(json["command"]["name"], "info");
  EXPECT_EQ(json["command"]["arguments"],
            Json::array({map_, "--result", result_}));
  EXPECT_EQ(json["status"], "done");
  EXPECT_EQ(json["exit_code"], 0);
  EXPECT_EQ(json["inputs"][0]["path"], map_);
  EXPECT_EQ(json["inputs"][0]["bytes"], content_.size());
  EXPECT_EQ(json["inputs"][0]["sha256"], Sha256(content_));
  EXPECT_EQ(json["counts"]["nodes"], SmallMap::kNumNodes);
  EXPECT_GT(json["peak_memory_bytes"], 1000000);
  EXPECT_GE(json["seconds"]["total"].get<double>(),
            json["seconds"]["stages"]["read"].get<double>());
}

// The checksum is that of the map before it was replaced.
TEST_F(ResultFileTest, RemembersWhatWasReplaced) {
  const ProgramResult run = RunTestProgram(
      {"close_loops", map_, "--in_place", "--nobackup", "--result", result_});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const Json json = Result();
  EXPECT_EQ(json["inputs"][0]["sha256"], Sha256(content_));
  EXPECT_EQ(json["status"], "nothing");
  EXPECT_EQ(json["outputs"][0]["path"], map_);
}

TEST_F(ResultFileTest, StandardOutputHasNothingElse) {
  const ProgramResult run = RunTestProgram({"info", map_, "--result=-"});
  ASSERT_EQ(run.exit_code, 0);
  EXPECT_EQ(Json::parse(run.output)["status"], "done");
  EXPECT_THAT(run.error, HasSubstr("format version"));
}

TEST_F(ResultFileTest, TellsOfErrors) {
  std::string none = directory_.File("none.pbstream");
  ProgramResult run = RunTestProgram({"info", none, "--result", result_});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(Result()["status"], "failed");
  EXPECT_EQ(Result()["exit_code"], 1);
  EXPECT_THAT(Result()["message"].get<std::string>(), HasSubstr(none));
  const std::string bad = directory_.Write("bad.pbstream", "garbage");
  run = RunTestProgram({"info", bad, "--result", result_});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(Result()["inputs"][0]["sha256"], Sha256("garbage"));
  // A name that is no UTF-8 is no reason to fail, and one in UTF-8 stays.
  run = RunTestProgram({"info", directory_.File("\xff"), "--result", result_});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(Result()["message"].get<std::string>(),
              HasSubstr("\xef\xbf\xbd"));
  const std::string umlaut = directory_.Write("Büro.pbstream", content_);
  run = RunTestProgram({"info", umlaut, "--result", result_});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(Result()["inputs"][0]["path"], umlaut);
  // Flags that do not go together; unknown flags say nothing about --result.
  run = RunTestProgram(
      {"merge", map_, "-o", directory_.File("m"), "--result", result_});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(Result()["status"], "wrong_usage");
}

TEST_F(ResultFileTest, NeverReplacesAMap) {
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"info", map_},
        {"info", directory_.File("none.pbstream")},
        {"close_loops", directory_.File("none"), "-o", directory_.File("b")}}) {
    std::vector<std::string> arguments = more;
    arguments.insert(arguments.end(), {"--result", map_});
    const ProgramResult run = RunTestProgram(arguments);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_EQ(directory_.Read("a.pbstream"), content_);
  }
  // Nor another output.
  const ProgramResult run =
      RunTestProgram({"close_loops", map_, "-o", result_, "--result", result_});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_FALSE(std::filesystem::exists(result_));
}

TEST_F(ResultFileTest, FailsOnWhatItIsAsked) {
  const std::vector<std::string> close_loops = {
      "close_loops", map_,   "-o", directory_.File("b.pbstream"),
      "--result",    result_};
  const auto run = [&](const std::string& conditions) {
    std::vector<std::string> arguments = close_loops;
    arguments.insert(arguments.end(), {"--fail_on", conditions});
    return RunTestProgram(arguments);
  };
  EXPECT_EQ(run("").exit_code, 0);
  EXPECT_EQ(run("refused,warning").exit_code, 0);
  const ProgramResult nothing = run("refused,nothing");
  EXPECT_EQ(nothing.exit_code, 3);
  EXPECT_THAT(nothing.error,
              HasSubstr("--fail_on nothing: no new loop closure was found"));
  EXPECT_EQ(Result()["exit_code"], 3);
  EXPECT_EQ(Result()["status"], "nothing");
  // What was asked for is there nevertheless.
  EXPECT_EQ(directory_.Read("b.pbstream"), content_);
  const ProgramResult wrong = run("nothin");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.error, HasSubstr("did you mean 'nothing'?"));
}

TEST(RunRecordTest, ConditionsAreMet) {
  RunRecord record;
  record.Warn(RunWarning::kTornSubmaps, "2 submaps are torn");
  const gflags::FlagSaver saver;
  const auto condition = [&record](const std::string& conditions) {
    gflags::SetCommandLineOption("fail_on", conditions.c_str());
    EXPECT_TRUE(CheckFailOn().ok()) << conditions;
    return ConditionToFailOn(record);
  };
  EXPECT_EQ(condition(""), "");
  EXPECT_EQ(condition("refused,nothing,repaired"), "");
  EXPECT_EQ(condition("repaired,torn_submaps"), "torn_submaps");
  EXPECT_EQ(condition("warning"), "warning");
  record.End(Outcome::kRefused, "why");
  EXPECT_EQ(condition("refused"), "refused");
  EXPECT_EQ(condition("nothing"), "");
}

}  // namespace
}  // namespace cartographer_sdf::result_file_test
