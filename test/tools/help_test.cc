// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/help.h"

#include <filesystem>
#include <set>
#include <sstream>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/paths.h"
#include "test/testing/program.h"

namespace cartographer_sdf::help_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST(HelpTest, HelpIsASubcommand) {
  EXPECT_EQ(RunTestProgram({"help"}).output, RunTestProgram({"-h"}).output);
  EXPECT_EQ(RunTestProgram({"help", "info"}).output,
            RunTestProgram({"info", "--help"}).output);
  const ProgramResult unknown = RunTestProgram({"help", "inof"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.error, HasSubstr("did you mean 'info'?"));
  EXPECT_EQ(RunTestProgram({"help", "info", "match"}).exit_code, 2);
}

// A flag that several have says what it means to this one.
TEST(HelpTest, SpeaksOfOneSubcommand) {
  std::set<std::string> names;
  for (const Subcommand& subcommand : AllSubcommands()) {
    names.insert(subcommand.name);
  }
  for (const Subcommand& subcommand : AllSubcommands()) {
    for (const std::string& name : names) {
      if (name == subcommand.name) continue;
      EXPECT_THAT(HelpText(subcommand), Not(HasSubstr(" " + name + ": ")));
    }
    EXPECT_THAT(HelpText(subcommand), HasSubstr("--fail_on"));
  }
  EXPECT_THAT(RunTestProgram({"help", "simulate"}).output,
              AllOf(HasSubstr("Floor plan"), Not(HasSubstr("to search in"))));
}

// Names of configuration files in help texts are those of files.
TEST(HelpTest, ConfigurationFilesExist) {
  int num_names = 0;
  for (const Subcommand& subcommand : AllSubcommands()) {
    std::istringstream words(HelpText(subcommand));
    for (std::string word; words >> word;) {
      const size_t end = word.find(".lua");
      if (end == std::string::npos) continue;
      const size_t begin =
          word.find_last_not_of("abcdefghijklmnopqrstuvwxyz_", end - 1);
      const std::string name =
          word.substr(begin == std::string::npos ? 0 : begin + 1,
                      end + 4 - (begin == std::string::npos ? 0 : begin + 1));
      EXPECT_TRUE(std::filesystem::exists(
          std::string(kTestConfigurationDirectory) + "/" + name))
          << subcommand.name << ": " << name;
      ++num_names;
    }
  }
  EXPECT_GT(num_names, 5);
}

TEST(HelpTest, ManualPages) {
  EXPECT_THAT(GeneralManPage(),
              AllOf(StartsWith(".TH \"CARTOGRAPHER_SDF\" \"1\""),
                    HasSubstr(".SH SUBCOMMANDS"), HasSubstr("close_loops"),
                    Not(HasSubstr("falsify")), HasSubstr("EXIT STATUS")));
  for (const Subcommand& subcommand : AllSubcommands()) {
    const std::string page = ManPage(subcommand);
    EXPECT_EQ(RunTestProgram({subcommand.name, "--man"}).output, page);
    for (const SubcommandFlag& flag : subcommand.AllFlags()) {
      EXPECT_THAT(page, HasSubstr("\n.BI \\-\\-" + flag.name + " "));
    }
    // No line of text is taken for a request.
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line);) {
      if (line.empty() || (line[0] != '.' && line[0] != '\'')) continue;
      EXPECT_THAT(line,
                  ::testing::MatchesRegex("\\.(TH|SH|TP|PP|B|BI|BR|br)( .*)?"));
    }
  }
}

TEST(HelpTest, CompletionKnowsEveryFlag) {
  for (const std::string shell : {"bash", "zsh"}) {
    const ProgramResult script = RunTestProgram({"completion", shell});
    EXPECT_EQ(script.exit_code, 0);
    for (const Subcommand& subcommand : AllSubcommands()) {
      for (const SubcommandFlag& flag : subcommand.AllFlags()) {
        EXPECT_THAT(script.output, HasSubstr("--" + flag.name)) << shell;
      }
    }
  }
  EXPECT_EQ(RunTestProgram({"completion"}).exit_code, 2);
  EXPECT_EQ(RunTestProgram({"completion", "fish"}).exit_code, 2);
}

// By bash itself.
TEST(HelpTest, BashCompletes) {
  const testing::TemporaryDirectory directory;
  const std::string script = directory.Write(
      "complete.sh", *CompletionScript("bash") +
                         "COMP_WORDS=(cartographer_sdf \"$@\")\n"
                         "COMP_CWORD=$#\n"
                         "_cartographer_sdf\n"
                         "echo \"${COMPREPLY[@]}\"\n");
  const auto complete = [&script](std::vector<std::string> words) {
    words.insert(words.begin(), script);
    const ProgramResult result = RunProgramFile("/bin/bash", words);
    EXPECT_EQ(result.error, "");
    return result.output;
  };
  EXPECT_EQ(complete({"relo"}), "relocalize\n");
  EXPECT_EQ(complete({"help", "relo"}), "relocalize\n");
  EXPECT_EQ(complete({"close_loops", "--clo"}), "--closures\n");
  EXPECT_EQ(complete({"close_loops", "map.pb"}), "\n");
}

}  // namespace
}  // namespace cartographer_sdf::help_test
