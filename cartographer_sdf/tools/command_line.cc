// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/command_line.h"

#include <algorithm>
#include <iostream>
#include <optional>
#include <set>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "cartographer_sdf/config/nearest_name.h"
#include "gflags/gflags.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// gflags prints doubles to the last digit.
std::string ShortDefault(const gflags::CommandLineFlagInfo& info) {
  double value = 0.;
  if (info.type == "double" && absl::SimpleAtod(info.default_value, &value)) {
    return absl::StrCat(value);
  }
  return info.default_value;
}

constexpr char kProgram[] = "cartographer_sdf";
constexpr size_t kLineLength = 80;

enum ExitCode { kDone = 0, kWorldAtFault = 1, kWrongUsage = 2 };

std::vector<std::string> FlagsOf(const Subcommand& subcommand) {
  std::vector<std::string> names = subcommand.required_flags;
  names.insert(names.end(), subcommand.optional_flags.begin(),
               subcommand.optional_flags.end());
  return names;
}

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

gflags::CommandLineFlagInfo FlagInfo(const std::string& name) {
  gflags::CommandLineFlagInfo info;
  CHECK(gflags::GetCommandLineFlagInfo(name.c_str(), &info)) << name;
  return info;
}

std::string Suggestion(const std::string& name, const std::string& prefix,
                       const std::vector<std::string>& candidates) {
  const std::optional<std::string> nearest = NearestName(name, candidates);
  if (!nearest.has_value()) return "";
  return absl::StrCat(", did you mean '", prefix, *nearest, "'?");
}

bool IsHelp(const std::string& argument) {
  return argument == "--help" || argument == "-help" || argument == "-h";
}

// One argument "--name" or "--name=value".
struct FlagArgument {
  std::string name;
  std::optional<std::string> value;
};

std::optional<FlagArgument> SplitFlag(const std::string& argument) {
  const size_t num_dashes = absl::StartsWith(argument, "--")  ? 2
                            : absl::StartsWith(argument, "-") ? 1
                                                              : 0;
  if (num_dashes == 0 || argument.size() == num_dashes) return std::nullopt;
  const std::pair<std::string, std::string> parts =
      absl::StrSplit(argument.substr(num_dashes), absl::MaxSplits('=', 1));
  FlagArgument flag{parts.first, std::nullopt};
  if (absl::StrContains(argument, '=')) flag.value = parts.second;
  return flag;
}

// Takes the value of "--flag value" from the arguments, of which `*next` is the
// first that is not taken.
absl::Status CompleteValue(const std::vector<std::string>& arguments,
                           size_t* const next, FlagArgument* const flag) {
  if (flag->value.has_value()) return absl::OkStatus();
  if (FlagInfo(flag->name).type == "bool") {
    flag->value = "true";
    return absl::OkStatus();
  }
  if (*next == arguments.size() || absl::StartsWith(arguments[*next], "--")) {
    return UsageError(absl::StrCat("--", flag->name, " needs a value"));
  }
  flag->value = arguments[(*next)++];
  return absl::OkStatus();
}

// Greedy, without breaking words.
std::string Wrap(const std::string& text, const size_t indent) {
  std::string wrapped;
  for (const absl::string_view paragraph : absl::StrSplit(text, "\n\n")) {
    if (!wrapped.empty()) wrapped += "\n\n";
    wrapped += std::string(indent, ' ');
    size_t length = indent;
    for (const absl::string_view word :
         absl::StrSplit(paragraph, absl::ByAnyChar(" \n"), absl::SkipEmpty())) {
      const bool is_first = length == indent;
      if (!is_first && length + 1 + word.size() > kLineLength) {
        absl::StrAppend(&wrapped, "\n", std::string(indent, ' '));
        length = indent;
      } else if (!is_first) {
        wrapped += ' ';
        ++length;
      }
      absl::StrAppend(&wrapped, word);
      length += word.size();
    }
  }
  return wrapped + "\n";
}

std::string HelpOfFlag(const std::string& name, const bool is_required) {
  const gflags::CommandLineFlagInfo info = FlagInfo(name);
  const std::string remark =
      is_required ? " (required)"
      : info.default_value.empty()
          ? ""
          : absl::StrCat(" (default: ", ShortDefault(info), ")");
  return absl::StrCat("  --", name, " <", info.type, ">", remark, "\n",
                      Wrap(info.description, 6));
}

// One line, whatever the message holds.
int Fail(const std::string& invocation, const absl::Status& status) {
  std::string message(status.message());
  for (char& c : message) {
    if (absl::ascii_iscntrl(static_cast<unsigned char>(c))) c = ' ';
  }
  std::cerr << invocation << ": " << message << "\n";
  return IsUsageError(status) ? kWrongUsage : kWorldAtFault;
}

}  // namespace

absl::Status SetFlags(const Subcommand& subcommand,
                      const std::vector<std::string>& arguments) {
  const std::vector<std::string> names = FlagsOf(subcommand);
  for (size_t next = 0; next < arguments.size();) {
    const std::string& argument = arguments[next++];
    std::optional<FlagArgument> flag = SplitFlag(argument);
    if (!flag.has_value()) {
      return UsageError(absl::StrCat("unexpected argument '", argument, "'"));
    }
    const std::string positive = flag->name.substr(
        absl::StartsWith(flag->name, "no") ? 2 : flag->name.size());
    if (!Contains(names, flag->name) && Contains(names, positive) &&
        FlagInfo(positive).type == "bool" && !flag->value.has_value()) {
      flag = FlagArgument{positive, "false"};
    }
    if (!Contains(names, flag->name)) {
      return UsageError(absl::StrCat("unknown flag '--", flag->name, "'",
                                     Suggestion(flag->name, "--", names)));
    }
    const absl::Status completed = CompleteValue(arguments, &next, &*flag);
    if (!completed.ok()) return completed;
    if (gflags::SetCommandLineOption(flag->name.c_str(), flag->value->c_str())
            .empty()) {
      return UsageError(absl::StrCat("--", flag->name, " must be of type ",
                                     FlagInfo(flag->name).type, ", it is '",
                                     *flag->value, "'"));
    }
  }
  for (const std::string& name : subcommand.required_flags) {
    if (FlagInfo(name).current_value.empty()) {
      return UsageError(absl::StrCat(
          "--", name, " is missing; usage: ", subcommand.Invocation(), " ",
          subcommand.usage));
    }
  }
  return absl::OkStatus();
}

std::string HelpText(const Subcommand& subcommand) {
  std::string text = absl::StrCat(
      subcommand.Invocation(), ": ", subcommand.summary, ".\n\nUsage:\n",
      Wrap(absl::StrCat(subcommand.Invocation(), " ", subcommand.usage), 2));
  if (!subcommand.description.empty()) {
    absl::StrAppend(&text, "\n", Wrap(subcommand.description, 0));
  }
  absl::StrAppend(&text, "\nFlags:\n");
  for (const std::string& name : subcommand.required_flags) {
    text += HelpOfFlag(name, true);
  }
  for (const std::string& name : subcommand.optional_flags) {
    text += HelpOfFlag(name, false);
  }
  return text;
}

std::string HelpText(const std::vector<Subcommand>& subcommands) {
  std::string text = absl::StrCat(
      kProgram, " ", CARTOGRAPHER_SDF_VERSION,
      ": wide-baseline loop closing for maps of Cartographer 2D.\n\nUsage:\n  ",
      kProgram, " SUBCOMMAND --flags\n  ", kProgram, " SUBCOMMAND --help\n  ",
      kProgram, " --version\n\nSubcommands:\n");
  size_t width = 0;
  for (const Subcommand& subcommand : subcommands) {
    if (subcommand.is_for_developers) continue;
    width = std::max(width, subcommand.name.size());
  }
  for (const Subcommand& subcommand : subcommands) {
    if (subcommand.is_for_developers) continue;
    absl::StrAppend(&text, "  ", subcommand.name,
                    std::string(width + 2 - subcommand.name.size(), ' '),
                    subcommand.summary, "\n");
  }
  return text +
         "\nExit codes: 0 done, 1 something is wrong with a file, 2 "
         "wrong usage.\n";
}

int RunSubcommand(const Subcommand& subcommand,
                  const std::vector<std::string>& arguments) {
  if (std::any_of(arguments.begin(), arguments.end(), IsHelp)) {
    std::cout << HelpText(subcommand);
    return kDone;
  }
  absl::Status status = SetFlags(subcommand, arguments);
  if (status.ok()) status = subcommand.run();
  if (status.ok() && !std::cout.flush()) {
    status = absl::UnavailableError("cannot write to the standard output");
  }
  return status.ok() ? kDone : Fail(subcommand.Invocation(), status);
}

int RunProgram(const std::vector<Subcommand>& subcommands,
               const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    return Fail(kProgram, UsageError(absl::StrCat("which subcommand? See ",
                                                  kProgram, " --help")));
  }
  const std::string& name = arguments.front();
  if (IsHelp(name)) {
    std::cout << HelpText(subcommands);
    return kDone;
  }
  if (name == "--version") {
    std::cout << kProgram << " " << CARTOGRAPHER_SDF_VERSION << "\n";
    return kDone;
  }
  std::vector<std::string> names;
  for (const Subcommand& subcommand : subcommands) {
    if (subcommand.name == name) {
      return RunSubcommand(subcommand,
                           {arguments.begin() + 1, arguments.end()});
    }
    names.push_back(subcommand.name);
  }
  const std::string suggestion = Suggestion(name, "", names);
  return Fail(kProgram, UsageError(absl::StrCat(
                            "unknown subcommand '", name, "'",
                            suggestion.empty()
                                ? absl::StrCat("; see ", kProgram, " --help")
                                : suggestion)));
}

}  // namespace cartographer_sdf
