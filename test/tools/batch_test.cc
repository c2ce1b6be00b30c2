// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// batch, as a nightly job runs it.

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "cartographer_sdf/tools/batch_jobs.h"
#include "cartographer_sdf/tools/batch_summary.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/program.h"
#include "test/testing/small_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::batch_test {
namespace {

using ::cartographer_sdf::testing::Container;
using ::cartographer_sdf::testing::SmallMap;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

class BatchTest : public ::testing::Test {
 protected:
  BatchTest()
      : good_(directory_.Write("it's, good.pbstream",
                               Container(SmallMap().Records()))),
        bad_(directory_.Write("bad.pbstream", "garbage")),
        output_(directory_.File("night")) {}

  ProgramResult Batch(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "batch");
    arguments.insert(arguments.end(), {"--output_dir", output_});
    return RunTestProgram(arguments);
  }
  std::string Read(const std::string& name) const {
    return directory_.Read("night/" + name);
  }
  Json Maps() const { return Json::parse(Read("summary.json"))["maps"]; }

  const testing::TemporaryDirectory directory_;
  const std::string good_;
  const std::string bad_;
  const std::string output_;
};

TEST_F(BatchTest, OneFailureLeavesTheOthersAlone) {
  const std::string none = directory_.File("none.pbstream");
  const ProgramResult run = Batch({bad_, good_, none, "--jobs=2"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.error, HasSubstr("2 of 3 maps failed"));
  const Json maps = Maps();
  ASSERT_EQ(maps.size(), 3u);
  EXPECT_EQ(maps[0]["status"], "failed");
  EXPECT_THAT(maps[0]["message"].get<std::string>(), HasSubstr("bad.pbstream"));
  EXPECT_EQ(maps[1]["status"], "nothing");
  EXPECT_EQ(maps[1]["counts"]["nodes"], SmallMap::kNumNodes);
  EXPECT_EQ(maps[2]["status"], "failed");
  EXPECT_EQ(Read("failures.txt"), bad_ + "\n" + none + "\n");
  EXPECT_TRUE(fs::exists(output_ + "/maps/it's, good.pbstream"));
  EXPECT_FALSE(fs::exists(output_ + "/maps/bad.pbstream"));
  EXPECT_THAT(Read("logs/bad.txt"), HasSubstr("bad.pbstream"));
  EXPECT_THAT(
      Read("summary.csv"),
      AllOf(HasSubstr("name,input,status,exit_code,message,"),
            HasSubstr("\n\"it's, good\",\"" + good_ + "\",nothing,0,")));
  const std::string page = Read("index.html");
  EXPECT_THAT(page, AllOf(HasSubstr("3 maps, 2 failed"), HasSubstr("Failures"),
                          HasSubstr("data:image/png;base64,"),
                          Not(HasSubstr("<script")), Not(HasSubstr("://"))));
}

TEST_F(BatchTest, ContinuesWhereItStopped) {
  const auto count = [this](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {good_, bad_, "--result",
                                          directory_.File("r.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(Batch(arguments).exit_code, 1);
    return Json::parse(directory_.Read("r.json"))["counts"]["finished_before"]
        .get<int>();
  };
  EXPECT_EQ(count({}), 0);
  // What failed is tried again.
  EXPECT_EQ(count({}), 1);
  EXPECT_EQ(count({"--jobs", "1"}), 1);
  // Other flags, a lost map, another map of the same name: done again.
  EXPECT_EQ(count({"--repair"}), 0);
  EXPECT_EQ(count({"--repair"}), 1);
  fs::remove(output_ + "/maps/it's, good.pbstream");
  EXPECT_EQ(count({"--repair"}), 0);
  SmallMap other;
  other.submaps.pop_back();
  directory_.Write("it's, good.pbstream", Container(other.Records()) + "x");
  EXPECT_EQ(count({"--repair"}), 0);
}

TEST_F(BatchTest, PlansAndCollects) {
  const ProgramResult plan =
      Batch({good_, bad_, "--plan", directory_.File("plan.txt")});
  ASSERT_EQ(plan.exit_code, 0) << plan.error;
  const std::string commands = directory_.Read("plan.txt");
  EXPECT_EQ(std::count(commands.begin(), commands.end(), '\n'), 2);
  EXPECT_FALSE(fs::exists(output_ + "/results/bad.json"));
  // Nobody has run them yet.
  EXPECT_EQ(Batch({"--collect"}).exit_code, 1);
  EXPECT_EQ(Maps()[0]["status"], "lost");
  // A plain shell, or GNU parallel where it is installed.
  const bool has_parallel = fs::exists("/usr/bin/parallel");
  const std::string runner =
      has_parallel ? "/usr/bin/parallel --will-cite --jobs 2 < \"$1\""
                   : "sh \"$1\"";
  const ProgramResult run = RunProgramFile(
      "/bin/sh", {"-c", runner, "sh", directory_.File("plan.txt")});
  EXPECT_EQ(run.exit_code, 1) << run.error;
  EXPECT_EQ(Batch({"--collect"}).exit_code, 1);
  EXPECT_EQ(Maps()[0]["status"], "nothing");
  EXPECT_EQ(Maps()[1]["status"], "failed");
  // Only what is left.
  EXPECT_THAT(Batch({good_, bad_, "--plan", "-"}).output,
              AllOf(HasSubstr("bad.pbstream"), Not(HasSubstr("good"))));
}

TEST_F(BatchTest, RefusesWrongUsage) {
  EXPECT_EQ(Batch({}).exit_code, 2);
  EXPECT_EQ(Batch({good_, "--collect"}).exit_code, 2);
  EXPECT_EQ(Batch({good_, "--task", "info"}).exit_code, 2);
  EXPECT_EQ(Batch({good_, "--jobs", "-1"}).exit_code, 2);
  EXPECT_EQ(Batch({"--collect"}).exit_code, 1);
}

TEST(BatchJobsTest, NamesDoNotCollide) {
  const std::vector<BatchJob> jobs = MakeJobs(
      {"/out", "audit", {}, false}, {"/x/a.pbstream", "/y/a.pbstream",
                                     "/y/b.pbstream", "/x/../x/a.pbstream"});
  ASSERT_EQ(jobs.size(), 3u);
  EXPECT_NE(jobs[0].name, jobs[1].name);
  EXPECT_EQ(jobs[2].name, "b");
  EXPECT_EQ(jobs[2].arguments.front(), "audit");
  // Without the third, the first keeps its name.
  EXPECT_EQ(MakeJobs({"/out", "audit", {}, false},
                     {"/x/a.pbstream", "/y/a.pbstream"})[0]
                .name,
            jobs[0].name);
}

TEST(BatchJobsTest, ShellsReadAnyName) {
  BatchJob job;
  job.arguments = {"info", "it's $(odd)\n"};
  job.log = "a b";
  EXPECT_EQ(ShellCommand("/p q", job),
            "'/p q' 'info' 'it'\\''s $(odd)\n' > 'a b' 2>&1");
}

}  // namespace
}  // namespace cartographer_sdf::batch_test
