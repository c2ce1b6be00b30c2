// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// As a user walks it: falsify, audit.

#include <filesystem>
#include <string>
#include <vector>

#include "cartographer_sdf/file/text_file.h"
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
  // Once to read, and once to write and to draw.
  EXPECT_EQ(counter.Count(), 2);

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
