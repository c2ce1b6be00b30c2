// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "test/testing/program.h"

#include <algorithm>
#include <string>
#include <vector>

#include "cartographer_sdf/tools/command_line.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/shared_data.h"

DEFINE_bool(test_bool, true, "A boolean for the test.");

namespace cartographer_sdf::program_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

// Nothing on stdout, one line on stderr; returns that.
std::string Failure(const std::vector<std::string>& arguments,
                    const int exit_code) {
  const ProgramResult result = RunTestProgram(arguments);
  EXPECT_EQ(result.exit_code, exit_code) << result.error;
  EXPECT_EQ(result.output, "");
  EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1)
      << result.error;
  EXPECT_THAT(result.error, StartsWith("cartographer_sdf"));
  return result.error;
}

TEST(ProgramTest, Helps) {
  const ProgramResult help = RunTestProgram({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(help.error, "");
  EXPECT_THAT(help.output, AllOf(HasSubstr("Usage:"),
                                 HasSubstr("describe the contents of a map")));
  // Flags of libraries are nobody's business.
  EXPECT_THAT(help.output, Not(HasSubstr("minloglevel")));
  for (const Subcommand& subcommand : AllSubcommands()) {
    const auto line = HasSubstr("\n  " + subcommand.name + " ");
    if (subcommand.is_for_developers) {
      EXPECT_THAT(help.output, Not(line));
    } else {
      EXPECT_THAT(help.output, line);
    }
  }
}

TEST(ProgramTest, HelpsWithEachSubcommand) {
  for (const Subcommand& subcommand : AllSubcommands()) {
    const ProgramResult help = RunTestProgram({subcommand.name, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.output, AllOf(HasSubstr(subcommand.summary),
                                   Not(HasSubstr("minloglevel"))));
    for (const SubcommandFlag& flag : subcommand.required_flags) {
      EXPECT_THAT(help.output, HasSubstr("--" + flag.name + " <"));
    }
    for (const SubcommandFlag& flag : subcommand.optional_flags) {
      EXPECT_THAT(help.output, HasSubstr("--" + flag.name + " <"));
    }
    std::istringstream lines(help.output);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_LE(line.size(), 80u) << line;
    }
  }
}

TEST(ProgramTest, TellsItsVersion) {
  const ProgramResult version = RunTestProgram({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.output,
              ::testing::MatchesRegex(
                  "cartographer_sdf [0-9.]+ \\(commit [-.0-9a-z]+\\)\n"));
  EXPECT_EQ(RunTestProgram({"version"}).output, version.output);
  EXPECT_EQ(RunTestProgram({"info", "--version"}).output, version.output);
}

TEST(ProgramTest, RefusesWrongUsage) {
  EXPECT_THAT(Failure({}, 2), HasSubstr("--help"));
  EXPECT_THAT(Failure({"inof"}, 2), HasSubstr("did you mean 'info'?"));
  EXPECT_THAT(Failure({"frobnicate\n"}, 2), HasSubstr("--help"));
  EXPECT_THAT(Failure({"--input", "x"}, 2),
              HasSubstr("a subcommand is missing before '--input'; see"));
  EXPECT_THAT(Failure({"--hlep"}, 2), HasSubstr("did you mean '--help'?"));
  EXPECT_THAT(Failure({"--verison"}, 2),
              HasSubstr("did you mean '--version'?"));
  EXPECT_THAT(Failure({"info"}, 2), AllOf(HasSubstr("--input is missing"),
                                          HasSubstr("info A.pbstream")));
  EXPECT_THAT(Failure({"info", "--input="}, 2), HasSubstr("is missing"));
  EXPECT_THAT(Failure({"info", "--input"}, 2), HasSubstr("needs a value"));
  EXPECT_THAT(Failure({"info", "--inptu", "x"}, 2),
              HasSubstr("unknown flag '--inptu', did you mean '--input'?"));
  // Flags of others.
  EXPECT_THAT(Failure({"info", "--minloglevel=0"}, 2), HasSubstr("unknown"));
  EXPECT_THAT(Failure({"info", "--report=x"}, 2), HasSubstr("unknown"));
  EXPECT_THAT(Failure({"info", "--input", "x", "y"}, 2),
              HasSubstr("unexpected argument 'y'"));
  EXPECT_THAT(Failure({"info", "--"}, 2), HasSubstr("--input is missing"));
  EXPECT_THAT(Failure({"info", ""}, 2), HasSubstr("unexpected argument"));
  EXPECT_THAT(Failure({"info", "--flagfile=/etc/passwd"}, 2),
              HasSubstr("unknown flag"));
}

TEST(ProgramTest, TellsWhatIsWrongWithFiles) {
  EXPECT_THAT(Failure({"info", "--input", "/nowhere/a.pbstream"}, 1),
              AllOf(StartsWith("cartographer_sdf info: "),
                    HasSubstr("/nowhere/a.pbstream")));
  const testing::TemporaryDirectory directory;
  const std::string path = directory.Write("b.pbstream", "garbage");
  EXPECT_THAT(Failure({"info", "--input=" + path}, 1), HasSubstr(path));
  EXPECT_THAT(Failure({"info", "-input", directory.path()}, 1),
              HasSubstr(directory.path()));
}

TEST(ProgramTest, DescribesRealMaps) {
  SKIP_WITHOUT_SHARED_DATA("user_map_two_sessions.pbstream");
  const std::string path = SharedDataPath("user_map_two_sessions.pbstream");
  const ProgramResult info = RunTestProgram({"info", "--input", path});
  EXPECT_EQ(info.exit_code, 0) << info.error;
  EXPECT_EQ(info.error, "");
  EXPECT_THAT(info.output,
              AllOf(HasSubstr(path), HasSubstr("trajectories    2\n")));
}

absl::Status RunNothing(RunRecord*) { return absl::OkStatus(); }

TEST(SetFlagsTest, SetsFlags) {
  const gflags::FlagSaver saver;
  const Subcommand subcommand{
      "test", "", "", "", {"input"}, {"threads", "test_bool"}, &RunNothing};
  ASSERT_TRUE(SetFlags(subcommand, {"--input", "-", "--threads=-3"}).ok());
  EXPECT_EQ(FLAGS_input, "-");
  EXPECT_EQ(FLAGS_threads, -3);
  EXPECT_TRUE(FLAGS_test_bool);
  ASSERT_TRUE(SetFlags(subcommand, {"--notest_bool", "-input=a=b"}).ok());
  EXPECT_FALSE(FLAGS_test_bool);
  EXPECT_EQ(FLAGS_input, "a=b");
  ASSERT_TRUE(SetFlags(subcommand, {"--test_bool", "--threads", "-4"}).ok());
  EXPECT_TRUE(FLAGS_test_bool);
  EXPECT_EQ(FLAGS_threads, -4);
  ASSERT_TRUE(SetFlags(subcommand, {"--test_bool=false"}).ok());
  EXPECT_FALSE(FLAGS_test_bool);

  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"--threads=x"},
        {"--threads=99999999999"},
        {"--threads="},
        {"--test_bool=perhaps"},
        {"--nothreads"},
        {"--notest_bool=true"},
        {"--threads", "--input"}}) {
    EXPECT_TRUE(IsUsageError(SetFlags(subcommand, wrong))) << wrong[0];
  }
}

TEST(FlagsTest, NumThreads) {
  const gflags::FlagSaver saver;
  EXPECT_GE(*NumThreadsOfFlags(), 1);
  FLAGS_threads = 3;
  EXPECT_EQ(*NumThreadsOfFlags(), 3);
  for (const int wrong : {-1, 100000}) {
    FLAGS_threads = wrong;
    EXPECT_TRUE(IsUsageError(NumThreadsOfFlags().status()));
  }
}

TEST(FlagsTest, LoadsOptions) {
  const gflags::FlagSaver saver;
  EXPECT_TRUE(LoadOptionsOfFlags().ok()) << LoadOptionsOfFlags().status();
  const testing::TemporaryDirectory directory;
  directory.Write("mine.lua",
                  "include \"sdf_global_constraints.lua\"\n"
                  "SDF_GLOBAL_CONSTRAINTS.report.map_picture_pixels = 321\n"
                  "return SDF_GLOBAL_CONSTRAINTS");
  FLAGS_configuration_directory = directory.path();
  FLAGS_configuration_basename = "mine.lua";
  const absl::StatusOr<Options> options = LoadOptionsOfFlags();
  ASSERT_TRUE(options.ok()) << options.status();
  EXPECT_EQ(options->report.map_picture_pixels, 321);
  FLAGS_configuration_directory = "/nowhere," + directory.path();
  EXPECT_THAT(std::string(LoadOptionsOfFlags().status().message()),
              HasSubstr("/nowhere"));
}

}  // namespace
}  // namespace cartographer_sdf::program_test
