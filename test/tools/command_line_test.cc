// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/command_line.h"

#include <string>
#include <vector>

#include "cartographer_sdf/tools/flags.h"
#include "gflags/gflags.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

DECLARE_string(inputs);
DECLARE_int32(jobs);
DECLARE_string(output_dir);

namespace cartographer_sdf::command_line_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Subcommand Named(const std::string& name) {
  for (const Subcommand& subcommand : AllSubcommands()) {
    if (subcommand.name == name) return subcommand;
  }
  ADD_FAILURE() << name;
  return {};
}

std::string ErrorOf(const std::string& subcommand,
                    const std::vector<std::string>& arguments) {
  const gflags::FlagSaver saver;
  const absl::Status status = SetFlags(Named(subcommand), arguments);
  EXPECT_TRUE(IsUsageError(status));
  return std::string(status.message());
}

TEST(CommandLineTest, MapsNeedNoFlag) {
  const gflags::FlagSaver saver;
  ASSERT_TRUE(
      SetFlags(Named("close_loops"), {"a b.pbstream", "-o", "c.pbstream"})
          .ok());
  EXPECT_EQ(FLAGS_input, "a b.pbstream");
  EXPECT_EQ(FLAGS_output, "c.pbstream");
  // In any order, and beside flags.
  ASSERT_TRUE(SetFlags(Named("relocalize"),
                       {"--threads", "2", "a.pbstream", "-result=r", "b"})
                  .ok());
  EXPECT_EQ(FLAGS_map, "a.pbstream");
  EXPECT_EQ(FLAGS_query, "b");
  EXPECT_EQ(FLAGS_result, "r");
  ASSERT_TRUE(SetFlags(Named("relocalize"), {"--map=m", "q"}).ok());
  EXPECT_EQ(FLAGS_map, "m");
  EXPECT_EQ(FLAGS_query, "q");
  // A dash at the beginning of a name.
  ASSERT_TRUE(SetFlags(Named("info"), {"--", "--threads"}).ok());
  EXPECT_EQ(FLAGS_input, "--threads");
}

TEST(CommandLineTest, ShellsExpandGlobs) {
  const gflags::FlagSaver saver;
  const Subcommand merge = Named("merge");
  const std::vector<std::string> odd = {"a,b.pbstream", "c\\d.pbstream", "e f"};
  std::vector<std::string> arguments = odd;
  arguments.insert(arguments.end(), {"--output", "m.pbstream"});
  ASSERT_TRUE(SetFlags(merge, arguments).ok());
  EXPECT_EQ(SplitPaths(FLAGS_inputs), odd);
  // --inputs *.pbstream
  FLAGS_inputs = "";
  ASSERT_TRUE(
      SetFlags(merge, {"--output=m", "--inputs", "a,b", "c,d", "e"}).ok());
  EXPECT_THAT(SplitPaths(FLAGS_inputs), ElementsAre("a", "b", "c,d", "e"));
  FLAGS_inputs = "";
  ASSERT_TRUE(SetFlags(merge, {"--output=m", "--inputs=a", "--inputs=b"}).ok());
  EXPECT_THAT(SplitPaths(FLAGS_inputs), ElementsAre("a", "b"));
}

TEST(CommandLineTest, OtherNamesOfFlags) {
  const gflags::FlagSaver saver;
  ASSERT_TRUE(SetFlags(Named("batch"), {"a", "-o", "d", "-j", "3"}).ok());
  EXPECT_EQ(FLAGS_output_dir, "d");
  EXPECT_EQ(FLAGS_jobs, 3);
  // Cartographer has one name, and this project's programs had the other.
  for (const char* const name :
       {"--configuration_directory", "-configuration_directories"}) {
    FLAGS_configuration_directory = "";
    ASSERT_TRUE(SetFlags(Named("info"), {"a", name, "x,y"}).ok());
    EXPECT_EQ(FLAGS_configuration_directory, "x,y");
  }
}

TEST(CommandLineTest, SuggestsWhatWasMeant) {
  EXPECT_THAT(ErrorOf("info", {"--inptu", "x"}),
              HasSubstr("did you mean '--input'?"));
  EXPECT_THAT(ErrorOf("close_loops", {"--out", "x"}),
              HasSubstr("did you mean '--output'?"));
  EXPECT_THAT(ErrorOf("close_loops", {"--nobakcup"}),
              HasSubstr("did you mean '--nobackup'?"));
  EXPECT_THAT(ErrorOf("match", {"--fail-on", "x"}),
              HasSubstr("did you mean '--fail_on'?"));
  EXPECT_THAT(ErrorOf("info", {"--report", "x"}),
              HasSubstr("which belongs to close_loops, "));
  // Each flag of each subcommand, misspelt.
  for (const Subcommand& subcommand : AllSubcommands()) {
    for (const SubcommandFlag& flag : subcommand.AllFlags()) {
      const std::string misspelt = flag.name + "x";
      if (subcommand.FindFlag(misspelt) != nullptr) continue;
      EXPECT_THAT(ErrorOf(subcommand.name, {"--" + misspelt}),
                  HasSubstr(", did you mean '--"))
          << subcommand.name;
    }
  }
}

TEST(CommandLineTest, TooMuchIsAnError) {
  EXPECT_THAT(ErrorOf("info", {"a", "b"}),
              HasSubstr("unexpected argument 'b'"));
  EXPECT_THAT(ErrorOf("info", {"--input", "a", "b"}),
              HasSubstr("unexpected argument 'b'"));
  EXPECT_THAT(ErrorOf("simulate", {"a"}), HasSubstr("unexpected argument 'a'"));
  EXPECT_THAT(ErrorOf("merge", {"a", ""}), HasSubstr("unexpected argument ''"));
  EXPECT_THAT(ErrorOf("close_loops", {"a"}), HasSubstr("--output is missing"));
}

TEST(PathListTest, JoinsWhatItSplits) {
  for (const std::vector<std::string>& paths : {std::vector<std::string>{"a"},
                                                {"a,b", "c"},
                                                {"\\", "a\\,b", ",", "\\\\"}}) {
    EXPECT_EQ(SplitPaths(JoinPaths(paths)), paths) << JoinPaths(paths);
  }
}

}  // namespace
}  // namespace cartographer_sdf::command_line_test
