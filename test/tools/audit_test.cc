// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// As a user walks it: falsify, audit.

#include <filesystem>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/file/text_file.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/open_counter.h"
#include "test/testing/program.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::audit_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class AuditProgramTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new testing::TemporaryDirectory();
    const auto run = [](const std::vector<std::string>& arguments) {
      const ProgramResult result = RunTestProgram(arguments);
      ASSERT_EQ(result.exit_code, 0) << result.error;
    };
    run({"simulate", "--output", File("open.pbstream"), "--truth",
         File("truth.csv"), "--length", "240"});
    run({"close_loops", "--input", File("open.pbstream"), "--output",
         File("good.pbstream")});
    run({"falsify", "--input", File("good.pbstream"), "--output",
         File("bad.pbstream"), "--wrong_constraints", File("wrong.csv"),
         "--pairs", "1", "--kinds", "half_turn,twin"});
  }
  static void TearDownTestSuite() { delete directory_; }
  static std::string File(const std::string& name) {
    return directory_->File(name);
  }

  static testing::TemporaryDirectory* directory_;
};

testing::TemporaryDirectory* AuditProgramTest::directory_ = nullptr;

TEST_F(AuditProgramTest, FindsWhatFalsifyAdded) {
  testing::OpenCounter counter(File("bad.pbstream"));
  const ProgramResult result =
      RunTestProgram({"audit", "--input", File("bad.pbstream"), "--output",
                      File("mended.pbstream"), "--constraints",
                      File("constraints.csv"), "--report", File("report")});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_EQ(result.error, "");
  EXPECT_THAT(result.output, HasSubstr("doubtful"));
  // Once to read, once to write and to draw, and once for the checksum in the
  // report.
  EXPECT_EQ(counter.Count(), 3);

  const auto wrong =
      ReadCsv(File("wrong.csv"),
              {{"constraint", CsvType::kInteger}, {"kind", CsvType::kWord}});
  ASSERT_TRUE(wrong.ok()) << wrong.status();
  ASSERT_GE(wrong->size(), 2u);
  const auto rows =
      ReadCsv(File("constraints.csv"), {{"constraint", CsvType::kInteger},
                                        {"doubtful", CsvType::kInteger},
                                        {"verdict", CsvType::kWord}});
  ASSERT_TRUE(rows.ok()) << rows.status();
  size_t num_found = 0;
  for (const CsvRow& label : *wrong) {
    for (const CsvRow& row : *rows) {
      if (row.Integer(0) != label.Integer(0)) continue;
      EXPECT_EQ(row.Integer(1), 1) << label.Word(1) << " " << row.Word(2);
      ++num_found;
    }
  }
  EXPECT_EQ(num_found, wrong->size());
  EXPECT_THAT(directory_->Read("report/index.html"),
              AllOf(HasSubstr("Doubtful constraints"),
                    HasSubstr("data:image/png"), HasSubstr("doubtful: ")));

  // What is mended has nothing doubtful any more.
  const ProgramResult again =
      RunTestProgram({"audit", "--input", File("mended.pbstream")});
  EXPECT_THAT(again.output, HasSubstr(" 0 of them doubtful"));
}

TEST_F(AuditProgramTest, DropsTheConstraintsOfAList) {
  const auto wrong =
      ReadCsv(File("wrong.csv"), {{"constraint", CsvType::kInteger}});
  const auto before = ReadMap(File("bad.pbstream"));
  ASSERT_TRUE(wrong.ok() && before.ok());
  // Other columns, as in the file of --constraints, do not matter.
  std::string list =
      "constraint,verdict,submap_trajectory,submap_index,node_trajectory,"
      "node_index\n";
  for (const CsvRow& row : *wrong) {
    const Constraint& constraint =
        before->pose_graph.constraints[static_cast<size_t>(row.Integer(0))];
    absl::StrAppend(&list, row.Integer(0), ",any,",
                    constraint.submap.trajectory, ",", constraint.submap.index,
                    ",", constraint.node.trajectory, ",", constraint.node.index,
                    "\n");
  }
  const std::string drop = directory_->Write("drop.csv", list);
  const ProgramResult result = RunTestProgram(
      {"audit", "--input", File("bad.pbstream"), "--drop", drop, "--output",
       File("dropped.pbstream"), "--report", File("dropped")});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.output, HasSubstr(absl::StrCat(
                                 wrong->size(), " constraints are dropped")));
  const auto after = ReadMap(File("dropped.pbstream"));
  ASSERT_TRUE(after.ok()) << after.status();
  EXPECT_EQ(after->pose_graph.constraints.size() + wrong->size(),
            before->pose_graph.constraints.size());
}

TEST_F(AuditProgramTest, SaysWhatIsWrongWithAList) {
  const std::string header =
      "constraint,submap_trajectory,submap_index,node_trajectory,node_index\n";
  const std::vector<std::pair<std::string, std::string>> lists = {
      {"", "is empty"},
      {"constraint,submap_index\n1,2\n", "submap_trajectory"},
      {header + "x,0,0,0,0\n", "not an integer"},
      {header + "1,0,0,0\n", "4 fields instead of 5"},
      {header + "-1,0,0,0,0\n", "must not be negative"},
      {header + "99999999999999999999,0,0,0,0\n", "not an integer"},
      {header + "2147483647,0,0,0,0\n", "made for another map"},
      {header + "1,0,0,0,99999\n", "made for another map"},
      {std::string("\0\xff\xfe,\n", 5), "columns named"}};
  for (const auto& [content, problem] : lists) {
    const std::string path = directory_->Write("list.csv", content);
    const ProgramResult result =
        RunTestProgram({"audit", "--input", File("bad.pbstream"), "--drop",
                        path, "--output", File("none.pbstream")});
    EXPECT_EQ(result.exit_code, 1) << content;
    EXPECT_THAT(result.error, HasSubstr(problem)) << content;
    EXPECT_FALSE(std::filesystem::exists(File("none.pbstream")));
  }
  const ProgramResult missing =
      RunTestProgram({"audit", "--input", File("bad.pbstream"), "--drop",
                      File("nowhere.csv")});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.error, HasSubstr("nowhere.csv"));
}

TEST_F(AuditProgramTest, LeavesNothingBehindWhereItFails) {
  directory_->Write("broken.pbstream", "not a map");
  const ProgramResult result = RunTestProgram(
      {"audit", "--input", File("broken.pbstream"), "--output",
       File("none.pbstream"), "--constraints", File("none.csv")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error,
              AllOf(HasSubstr("broken.pbstream"), Not(HasSubstr("\n\n"))));
  EXPECT_FALSE(std::filesystem::exists(File("none.pbstream")));
  EXPECT_FALSE(std::filesystem::exists(File("none.csv")));
}

TEST_F(AuditProgramTest, RefusesWrongUsage) {
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--kinds", "funny"},
        std::vector<std::string>{"--pairs", "0"}}) {
    std::vector<std::string> arguments = {"falsify",
                                          "--input",
                                          File("good.pbstream"),
                                          "--output",
                                          File("none.pbstream"),
                                          "--wrong_constraints",
                                          File("none.csv")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(RunTestProgram(arguments).exit_code, 2) << more[0];
  }
  EXPECT_EQ(RunTestProgram({"audit"}).exit_code, 2);
  EXPECT_EQ(RunTestProgram({"audit", "--input", File("good.pbstream"),
                            "--frozen_trajectories", "x"})
                .exit_code,
            2);
  EXPECT_FALSE(std::filesystem::exists(File("none.pbstream")));
}

}  // namespace
}  // namespace cartographer_sdf::audit_test
