// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What holds for the files of every subcommand.

#include "cartographer_sdf/tools/file_flags.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cartographer_sdf/tools/command_line.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/program.h"
#include "test/testing/small_map.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::file_flags_test {
namespace {

using ::cartographer_sdf::testing::Container;
using ::cartographer_sdf::testing::SmallMap;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

bool IsInput(const SubcommandFlag& flag) {
  return flag.use == FileUse::kRead || flag.use == FileUse::kReadList;
}

bool IsOutput(const SubcommandFlag& flag) {
  return flag.use != FileUse::kNone && flag.use != FileUse::kPassList &&
         !IsInput(flag);
}

bool IsMap(const SubcommandFlag& flag) {
  return flag.use == FileUse::kWriteMap || flag.use == FileUse::kCopyMap;
}

bool IsText(const SubcommandFlag& flag) {
  return flag.use == FileUse::kWriteText || flag.use == FileUse::kWriteTextList;
}

std::vector<SubcommandFlag> FlagsOf(const Subcommand& subcommand) {
  return subcommand.AllFlags();
}

class FileFlagsTest : public ::testing::Test {
 protected:
  FileFlagsTest() : content_(Container(SmallMap().Records())) {
    directory_.Write("map.pbstream", content_);
  }

  // A map of its own for each input flag.
  std::string InputOf(const SubcommandFlag& flag) {
    return directory_.Write("in_" + flag.name + ".pbstream", content_);
  }

  // The message of CheckFiles with these flags, and maps for all inputs.
  std::string Check(const Subcommand& subcommand,
                    const std::vector<std::string>& more) {
    const gflags::FlagSaver saver;
    std::vector<std::string> arguments;
    for (const SubcommandFlag& flag : FlagsOf(subcommand)) {
      if (IsInput(flag)) {
        arguments.push_back(absl::StrCat("--", flag.name, "=", InputOf(flag)));
      }
    }
    for (const SubcommandFlag& flag : subcommand.required_flags) {
      if (!IsOutput(flag)) continue;
      arguments.push_back(absl::StrCat("--", flag.name, "=",
                                       directory_.File("out_" + flag.name)));
    }
    arguments.insert(arguments.end(), more.begin(), more.end());
    absl::Status status = SetFlags(subcommand, arguments);
    EXPECT_TRUE(status.ok()) << status;
    status = CheckFiles(subcommand);
    return std::string(status.message());
  }

  // Calls back for each flag for which the predicate holds.
  void ForEach(const std::function<bool(const SubcommandFlag&)>& holds,
               const std::function<void(const Subcommand&,
                                        const SubcommandFlag&)>& test) {
    for (const Subcommand& subcommand : AllSubcommands()) {
      for (const SubcommandFlag& flag : FlagsOf(subcommand)) {
        if (!holds(flag)) continue;
        SCOPED_TRACE(subcommand.name + " --" + flag.name);
        test(subcommand, flag);
      }
    }
  }

  [[nodiscard]] std::set<std::string> Files() const {
    std::set<std::string> names;
    for (const auto& entry :
         std::filesystem::directory_iterator(directory_.path())) {
      names.insert(entry.path().filename().string());
    }
    return names;
  }

  const testing::TemporaryDirectory directory_;
  const std::string content_;
};

// A flag that names a file says what becomes of it.
TEST_F(FileFlagsTest, EveryFileFlagIsDeclared) {
  const std::set<std::string> no_files = {
      "method",         "frozen_trajectories",
      "kinds",          "configuration_directory",
      "submap",         "configuration_basename",
      "methods",        "min_overlaps",
      "max_clearances", "fail_on",
      "task",           "program",
      "map_filestem",   "geojson_origin",
      "partner",
  };
  ForEach([](const SubcommandFlag&) { return true; },
          [&](const Subcommand&, const SubcommandFlag& flag) {
            const bool is_string =
                gflags::GetCommandLineFlagInfoOrDie(flag.name.c_str()).type ==
                "string";
            EXPECT_EQ(flag.use != FileUse::kNone,
                      is_string && no_files.count(flag.name) == 0);
          });
}

TEST_F(FileFlagsTest, NoFilesAreNoProblem) {
  for (const Subcommand& subcommand : AllSubcommands()) {
    EXPECT_EQ(Check(subcommand, {}), "") << subcommand.name;
  }
}

TEST_F(FileFlagsTest, NoOutputReplacesAnInput) {
  int num_pairs = 0;
  ForEach(IsOutput, [&](const Subcommand& subcommand,
                        const SubcommandFlag& output) {
    for (const SubcommandFlag& input : FlagsOf(subcommand)) {
      if (!IsInput(input)) continue;
      ++num_pairs;
      const std::string path = InputOf(input);
      const std::string link = directory_.File("link");
      const std::string hard_link = directory_.File("hard_link");
      std::filesystem::remove(hard_link);
      std::filesystem::create_hard_link(path, hard_link);
      std::filesystem::remove(link);
      std::filesystem::create_symlink(path, link);
      const std::string detour =
          directory_.path() + "/./" +
          std::filesystem::path(path).filename().string();
      for (const std::string& name : {path, detour, link, hard_link}) {
        EXPECT_THAT(
            Check(subcommand, {absl::StrCat("--", output.name, "=", name)}),
            HasSubstr("it is one of the files that are read (--" + input.name))
            << name;
      }
      EXPECT_TRUE(testing::ReadFile(path) == content_);
    }
  });
  EXPECT_GT(num_pairs, 30);
}

TEST_F(FileFlagsTest, NoTwoOutputsAreOneFile) {
  int num_pairs = 0;
  const std::string path = directory_.File("same");
  std::filesystem::create_symlink("same", directory_.File("link"));
  ForEach(
      IsOutput, [&](const Subcommand& subcommand, const SubcommandFlag& first) {
        for (const SubcommandFlag& second : FlagsOf(subcommand)) {
          if (!IsOutput(second) || second.name == first.name) continue;
          ++num_pairs;
          for (const std::string& name : {path, directory_.File("link")}) {
            EXPECT_THAT(
                Check(subcommand, {absl::StrCat("--", first.name, "=", path),
                                   absl::StrCat("--", second.name, "=", name)}),
                HasSubstr("it is also written by"));
          }
          for (const std::string& written : second.written_names) {
            EXPECT_THAT(
                Check(subcommand,
                      {absl::StrCat("--", first.name, "=", path, "/", written),
                       absl::StrCat("--", second.name, "=", path)}),
                HasSubstr("it is also written by"));
          }
        }
      });
  EXPECT_GT(num_pairs, 20);
}

TEST_F(FileFlagsTest, OutputsThatCannotBeAreRefused) {
  const std::string pipe = directory_.File("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/full", directory_.File("device"));
  directory_.Write("file", "");
  const std::string in_file = directory_.File("file") + "/x";
  ForEach(IsOutput, [&](const Subcommand& subcommand,
                        const SubcommandFlag& flag) {
    const auto check = [&](const std::string& path) {
      return Check(subcommand, {absl::StrCat("--", flag.name, "=", path)});
    };
    EXPECT_THAT(check(in_file), HasSubstr("irectory"));
    if (flag.use == FileUse::kWriteInto) {
      EXPECT_THAT(check(directory_.File("file")), HasSubstr("not a directory"));
      EXPECT_EQ(check(directory_.File("new/directory")), "");
      return;
    }
    EXPECT_THAT(
        check(directory_.File("missing/x")),
        HasSubstr("there is no directory " + directory_.path() + "/missing"));
    for (const std::string& path :
         {directory_.path(), pipe, directory_.File("device"),
          std::string("/dev/null")}) {
      EXPECT_THAT(check(path), HasSubstr("not a regular file")) << path;
    }
    // No process, root's least, may make files there.
    EXPECT_THAT(check("/proc/x"), HasSubstr("cannot write /proc/x"));
    EXPECT_EQ(check(directory_.File("fine")), "");
  });
  EXPECT_FALSE(std::filesystem::exists(directory_.File("fine")));
  EXPECT_FALSE(std::filesystem::exists(directory_.File("new")));
}

TEST_F(FileFlagsTest, FilesOfAnotherKindAreNotReplaced) {
  const std::string map = directory_.File("map.pbstream");
  const std::string text = directory_.Write("table.csv", "a,b\n");
  const std::string empty = directory_.Write("empty", "");
  ForEach(
      IsOutput, [&](const Subcommand& subcommand, const SubcommandFlag& flag) {
        if (flag.use == FileUse::kWriteInto) return;
        const auto check = [&](const std::string& path) {
          return Check(subcommand, {absl::StrCat("--", flag.name, "=", path)});
        };
        EXPECT_EQ(check(empty), "");
        EXPECT_EQ(check(map).empty(), IsMap(flag));
        EXPECT_EQ(check(text).empty(), IsText(flag));
      });
}

TEST_F(FileFlagsTest, OnlyTablesGoToTheStandardOutput) {
  ForEach(IsOutput,
          [&](const Subcommand& subcommand, const SubcommandFlag& flag) {
            const std::string message =
                Check(subcommand, {absl::StrCat("--", flag.name, "=-")});
            EXPECT_EQ(message.empty(), IsText(flag)) << message;
          });
}

TEST_F(FileFlagsTest, EveryInputMustBeThere) {
  const std::string pipe = directory_.File("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  int num_inputs = 0;
  ForEach(
      IsInput, [&](const Subcommand& subcommand, const SubcommandFlag& flag) {
        ++num_inputs;
        const auto check = [&](const std::string& path) {
          return Check(subcommand, {absl::StrCat("--", flag.name, "=", path)});
        };
        EXPECT_THAT(check(directory_.File("absent")),
                    HasSubstr("absent: there is no such file"));
        EXPECT_THAT(check(directory_.path()), HasSubstr("not a regular file"));
        EXPECT_THAT(check(pipe), HasSubstr("not a regular file"));
      });
  EXPECT_GT(num_inputs, 15);
}

TEST_F(FileFlagsTest, TooSmallADiskIsNoticed) {
  // Larger than any disk, and without content.
  const std::string input = directory_.File("sparse.pbstream");
  directory_.Write("sparse.pbstream", "");
  const uintmax_t size =
      std::filesystem::space(directory_.path()).capacity + 1'000'000;
  std::error_code error;
  std::filesystem::resize_file(input, size, error);
  if (error) GTEST_SKIP() << "no sparse files: " << error.message();
  int num_copies = 0;
  ForEach(
      [](const SubcommandFlag& flag) { return flag.use == FileUse::kCopyMap; },
      [&](const Subcommand& subcommand, const SubcommandFlag& flag) {
        ++num_copies;
        const std::string input_flag = subcommand.required_flags.front().name;
        EXPECT_THAT(
            Check(subcommand,
                  {absl::StrCat("--", input_flag, "=", input),
                   absl::StrCat("--", flag.name, "=", directory_.File("out"))}),
            AllOf(HasSubstr("MB or more"), HasSubstr("MB left")));
      });
  EXPECT_EQ(num_copies, 5);
}

TEST_F(FileFlagsTest, ChecksLeaveNothingBehind) {
  const std::set<std::string> before = Files();
  const Subcommand subcommand = AllSubcommands().front();
  Check(subcommand,
        {"--output", directory_.File("a"), "--report", directory_.File("b")});
  std::set<std::string> after = Files();
  after.erase("in_input.pbstream");
  EXPECT_EQ(after, before);
}

TEST(SplitPathsTest, CommasCanBeWritten) {
  EXPECT_THAT(SplitPaths(""), IsEmpty());
  EXPECT_THAT(SplitPaths("a,b c,,d"), ElementsAre("a", "b c", "d"));
  EXPECT_THAT(SplitPaths("a\\,b,c"), ElementsAre("a,b", "c"));
  EXPECT_THAT(SplitPaths("a\\\\,b"), ElementsAre("a\\", "b"));
  EXPECT_THAT(SplitPaths("a\\b\\"), ElementsAre("a\\b\\"));
}

// --- As a user runs them. ---

TEST_F(FileFlagsTest, ChangesAMapInPlace) {
  const std::string map = directory_.File("map.pbstream");
  const std::string backup = map + ".bak";
  std::filesystem::create_symlink(map, directory_.File("link"));
  for (const std::string name : {"close_loops", "audit"}) {
    const auto run = [&](std::vector<std::string> more) {
      more.insert(more.begin(), name);
      return RunTestProgram(more);
    };
    const ProgramResult changed =
        run({"--input", directory_.File("link"), "--in_place"});
    EXPECT_EQ(changed.exit_code, 0) << changed.error;
    EXPECT_THAT(changed.output, HasSubstr(backup));
    // audit drops a constraint.
    EXPECT_EQ(testing::ReadFile(map) == content_, name == "close_loops");
    EXPECT_TRUE(testing::ReadFile(backup) == content_);
    EXPECT_TRUE(ReadMap(map).ok());
    EXPECT_FALSE(std::filesystem::equivalent(map, backup));
    EXPECT_FALSE(std::filesystem::is_symlink(backup));
    EXPECT_TRUE(std::filesystem::is_symlink(directory_.File("link")));
    // An older backup may be all that is left of a map.
    const ProgramResult again = run({"--input", map, "--in_place"});
    EXPECT_EQ(again.exit_code, 1);
    EXPECT_THAT(again.error, HasSubstr(backup + ": it exists"));
    EXPECT_EQ(run({"--input", map, "--in_place", "--nobackup"}).exit_code, 0);
    EXPECT_EQ(run({"--input", map, "--in_place", "--output",
                   directory_.File("x.pbstream")})
                  .exit_code,
              2);
    EXPECT_EQ(run({"--input", map, "--nobackup"}).exit_code, 2);
    std::filesystem::remove(backup);
  }
  EXPECT_THAT(Files(), ElementsAre("link", "map.pbstream"));
}

TEST_F(FileFlagsTest, ATableHasTheStandardOutputToItself) {
  const std::string map = directory_.File("map.pbstream");
  const ProgramResult result =
      RunTestProgram({"match", "--input", map, "--output", "-"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, StartsWith("reference_trajectory,"));
  EXPECT_THAT(result.output, Not(HasSubstr("pairs of submaps")));
  EXPECT_THAT(result.error, HasSubstr("pairs of submaps"));
}

TEST_F(FileFlagsTest, TrajectoriesToFreezeMustBeThere) {
  const std::string map = directory_.File("map.pbstream");
  const std::string output = directory_.File("out.pbstream");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"close_loops", "--output", output},
        {"audit", "--output", output},
        {"falsify", "--output", output, "--wrong_constraints",
         directory_.File("w.csv")}}) {
    for (const std::string frozen : {"5", "5,6", "0"}) {
      std::vector<std::string> all = arguments;
      all.insert(all.end(), {"--input", map, "--frozen_trajectories", frozen});
      const ProgramResult result = RunTestProgram(all);
      EXPECT_EQ(result.exit_code, frozen == "5" ? 0 : 1) << result.error;
      if (frozen == "5") continue;
      EXPECT_THAT(result.error, HasSubstr("has no trajectory"));
    }
  }
}

TEST_F(FileFlagsTest, CutMapsAreRefusedOrRepaired) {
  SmallMap cut;
  cut.nodes.resize(2);
  const std::string map =
      directory_.Write("cut.pbstream", Container(cut.Records()));
  const std::string output = directory_.File("out.pbstream");
  const std::string whole = directory_.File("map.pbstream");
  const std::vector<std::string> commands[] = {
      {"close_loops", "--input", map, "--output", output},
      {"audit", "--input", map, "--output", output},
      {"match", "--input", map, "--output", directory_.File("m.csv")},
      {"relocalize", "--map", map, "--query", whole},
      {"relocalize", "--map", whole, "--query", map}};
  for (std::vector<std::string> arguments : commands) {
    const ProgramResult refused = RunTestProgram(arguments);
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_THAT(refused.error,
                HasSubstr("cut.pbstream is not whole: 0 of 2 submaps and 2 of "
                          "4 nodes"));
    arguments.push_back("--repair");
    const ProgramResult repaired = RunTestProgram(arguments);
    EXPECT_EQ(repaired.exit_code, 0) << repaired.error;
    EXPECT_THAT(
        repaired.output,
        HasSubstr("repaired: 0 submaps and 2 nodes without data were left"));
    const bool writes_map =
        arguments[3] == "--output" && arguments[0] != "match";
    if (!writes_map) continue;
    const absl::StatusOr<MapState> state = ReadMap(output);
    ASSERT_TRUE(state.ok()) << state.status();
    EXPECT_EQ(state->pose_graph.nodes.size(), 2u);
    std::filesystem::remove(output);
  }
  const ProgramResult info = RunTestProgram({"info", "--input", map});
  EXPECT_EQ(info.exit_code, 0);
  EXPECT_THAT(info.output, HasSubstr("4, 2 of them without data"));
}

}  // namespace
}  // namespace cartographer_sdf::file_flags_test
