// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/subcommand.h"

#include <algorithm>
#include <cstdlib>  // defines __GLIBC__
#include <iostream>
#include <optional>

#include "absl/strings/ascii.h"
#include "absl/strings/cord.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "cartographer_sdf/config/nearest_name.h"
#include "gflags/gflags.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace cartographer_sdf {

Subcommand AuditSubcommand();
Subcommand CloseLoopsSubcommand();
Subcommand Evaluate();
Subcommand FalsifySubcommand();
Subcommand Figures();
Subcommand Info();
Subcommand MatchSubcommand();
Subcommand MergeSubcommand();
Subcommand RelocalizeSubcommand();
Subcommand SimulateSubcommand();

namespace {

constexpr char kProgram[] = "cartographer_sdf";
constexpr char kUsagePayload[] = "cartographer_sdf/usage";
constexpr size_t kLineLength = 80;

enum ExitCode { kDone = 0, kWorldAtFault = 1, kWrongUsage = 2 };

// gflags prints doubles with all digits.
std::string ShortDefault(const gflags::CommandLineFlagInfo& info) {
  double value = 0.;
  if (info.type == "double" && absl::SimpleAtod(info.default_value, &value)) {
    return absl::StrCat(value);
  }
  return info.default_value;
}

std::vector<std::string> FlagsOf(const Subcommand& subcommand) {
  std::vector<std::string> names;
  for (const auto* const flags :
       {&subcommand.required_flags, &subcommand.optional_flags}) {
    for (const SubcommandFlag& flag : *flags) names.push_back(flag.name);
  }
  return names;
}

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
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

std::optional<FlagArgument> SplitFlag(absl::string_view argument) {
  if (!absl::ConsumePrefix(&argument, "-")) return std::nullopt;
  absl::ConsumePrefix(&argument, "-");
  if (argument.empty()) return std::nullopt;
  const std::vector<std::string> parts =
      absl::StrSplit(argument, absl::MaxSplits('=', 1));
  FlagArgument flag{parts[0], std::nullopt};
  if (parts.size() > 1) flag.value = parts[1];
  return flag;
}

// Greedy, without breaking words.
std::string Wrap(const std::string& text, const size_t indent) {
  std::string wrapped;
  for (const absl::string_view paragraph : absl::StrSplit(text, "\n\n")) {
    if (!wrapped.empty()) wrapped += "\n";
    std::string line(indent, ' ');
    for (const absl::string_view word :
         absl::StrSplit(paragraph, absl::ByAnyChar(" \n"), absl::SkipEmpty())) {
      if (line.size() > indent && line.size() + 1 + word.size() > kLineLength) {
        absl::StrAppend(&wrapped, line, "\n");
        line.resize(indent);
      }
      absl::StrAppend(&line, line.size() > indent ? " " : "", word);
    }
    absl::StrAppend(&wrapped, line, "\n");
  }
  return wrapped;
}

std::string HelpOfFlag(const std::string& name, const bool is_required) {
  const gflags::CommandLineFlagInfo info =
      gflags::GetCommandLineFlagInfoOrDie(name.c_str());
  const std::string remark =
      is_required ? " (required)"
      : info.default_value.empty()
          ? ""
          : absl::StrCat(" (default: ", ShortDefault(info), ")");
  return absl::StrCat("  --", name, " <", info.type, ">", remark, "\n",
                      Wrap(info.description, 6));
}

std::string HelpText(const Subcommand& subcommand) {
  std::string text = absl::StrCat(
      subcommand.Invocation(), ": ", subcommand.summary, ".\n\nUsage:\n",
      Wrap(absl::StrCat(subcommand.Invocation(), " ", subcommand.usage), 2));
  if (!subcommand.description.empty()) {
    absl::StrAppend(&text, "\n", Wrap(subcommand.description, 0));
  }
  absl::StrAppend(&text, "\nFlags:\n");
  for (const SubcommandFlag& flag : subcommand.required_flags) {
    text += HelpOfFlag(flag.name, true);
  }
  for (const SubcommandFlag& flag : subcommand.optional_flags) {
    text += HelpOfFlag(flag.name, false);
  }
  return text;
}

std::string GeneralHelp() {
  std::string text = absl::StrCat(
      kProgram, " ", CARTOGRAPHER_SDF_VERSION,
      ": wide-baseline loop closing for maps of Cartographer 2D.\n\n"
      "Usage:\n  ",
      kProgram, " SUBCOMMAND --flags\n  ", kProgram, " SUBCOMMAND --help\n  ",
      kProgram, " --version\n\nSubcommands:\n");
  for (const Subcommand& subcommand : AllSubcommands()) {
    if (subcommand.is_for_developers) continue;
    absl::StrAppend(&text, absl::StrFormat("  %-13s%s\n", subcommand.name,
                                           subcommand.summary));
  }
  return text +
         "\nExit codes: 0 success, 1 an error with a file, 2 wrong usage.\n";
}

int Fail(const std::string& invocation, const absl::Status& status) {
  std::cerr << invocation << ": " << OneLine(std::string(status.message()))
            << "\n";
  return IsUsageError(status) ? kWrongUsage : kWorldAtFault;
}

std::string TypeOf(const std::string& flag) {
  return gflags::GetCommandLineFlagInfoOrDie(flag.c_str()).type;
}

absl::Status CheckRequired(const Subcommand& subcommand) {
  for (const SubcommandFlag& flag : subcommand.required_flags) {
    if (gflags::GetCommandLineFlagInfoOrDie(flag.name.c_str())
            .current_value.empty()) {
      return UsageError(absl::StrCat(
          "--", flag.name, " is missing; usage: ", subcommand.Invocation(), " ",
          subcommand.usage));
    }
  }
  return absl::OkStatus();
}

absl::Status CheckAndRun(const Subcommand& subcommand) {
  absl::Status status;
  if (subcommand.check_flags != nullptr) status = subcommand.check_flags();
  if (status.ok()) status = CheckFiles(subcommand);
  if (!status.ok()) return status;
  if (!WritesToStandardOutput(subcommand)) return subcommand.run();
  // A table has the standard output to itself.
  std::streambuf* const standard_output = std::cout.rdbuf(std::cerr.rdbuf());
  status = subcommand.run();
  std::cout.rdbuf(standard_output);
  return status;
}

}  // namespace

absl::Status UsageError(const std::string& message) {
  absl::Status status = absl::InvalidArgumentError(message);
  status.SetPayload(kUsagePayload, absl::Cord());
  return status;
}

std::string OneLine(std::string text) {
  for (char& c : text) {
    if (absl::ascii_iscntrl(static_cast<unsigned char>(c))) c = ' ';
  }
  return text;
}

bool IsUsageError(const absl::Status& status) {
  return status.GetPayload(kUsagePayload).has_value();
}

std::vector<Subcommand> AllSubcommands() {
  return {CloseLoopsSubcommand(),
          MatchSubcommand(),
          RelocalizeSubcommand(),
          MergeSubcommand(),
          AuditSubcommand(),
          Evaluate(),
          Figures(),
          SimulateSubcommand(),
          FalsifySubcommand(),
          Info()};
}

absl::Status SetFlags(const Subcommand& subcommand,
                      const std::vector<std::string>& arguments) {
  const std::vector<std::string> names = FlagsOf(subcommand);
  for (size_t next = 0; next < arguments.size();) {
    const std::string& argument = arguments[next++];
    std::optional<FlagArgument> flag = SplitFlag(argument);
    if (!flag.has_value()) {
      return UsageError(absl::StrCat("unexpected argument '", argument, "'"));
    }
    const std::string positive(absl::StripPrefix(flag->name, "no"));
    if (!Contains(names, flag->name) && Contains(names, positive) &&
        TypeOf(positive) == "bool" && !flag->value.has_value()) {
      flag = FlagArgument{positive, "false"};
    }
    if (!Contains(names, flag->name)) {
      return UsageError(absl::StrCat("unknown flag '--", flag->name, "'",
                                     Suggestion(flag->name, "--", names)));
    }
    const std::string type = TypeOf(flag->name);
    if (!flag->value && type == "bool") flag->value = "true";
    if (!flag->value && next < arguments.size() &&
        !absl::StartsWith(arguments[next], "--")) {
      flag->value = arguments[next++];
    }
    if (!flag->value) {
      return UsageError(absl::StrCat("--", flag->name, " needs a value"));
    }
    if (gflags::SetCommandLineOption(flag->name.c_str(), flag->value->c_str())
            .empty()) {
      return UsageError(absl::StrCat("--", flag->name, " must be of type ",
                                     type, ", it is '", *flag->value, "'"));
    }
  }
  absl::Status status = ApplyInPlace(subcommand);
  return status.ok() ? CheckRequired(subcommand) : status;
}

int RunSubcommand(const Subcommand& subcommand,
                  const std::vector<std::string>& arguments) {
  if (std::any_of(arguments.begin(), arguments.end(), IsHelp)) {
    std::cout << HelpText(subcommand);
    return kDone;
  }
  absl::Status status = SetFlags(subcommand, arguments);
  if (status.ok()) status = CheckAndRun(subcommand);
  if (status.ok() && !std::cout.flush()) {
    status = absl::UnavailableError("cannot write to the standard output");
  }
  return status.ok() ? kDone : Fail(subcommand.Invocation(), status);
}

int RunProgram(const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    return Fail(kProgram, UsageError(absl::StrCat("which subcommand? See ",
                                                  kProgram, " --help")));
  }
  const std::string& name = arguments.front();
  if (IsHelp(name)) {
    std::cout << GeneralHelp();
    return kDone;
  }
  if (name == "--version") {
    std::cout << kProgram << " " << CARTOGRAPHER_SDF_VERSION << "\n";
    return kDone;
  }
  std::vector<std::string> names;
  for (const Subcommand& subcommand : AllSubcommands()) {
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

void KeepFreedMemory() {
#ifdef __GLIBC__
  constexpr int kMegabyte = 1 << 20;
  // The largest threshold that glibc accepts: larger arrays are mapped and
  // returned.
  mallopt(M_MMAP_THRESHOLD, 32 * kMegabyte);
  mallopt(M_TRIM_THRESHOLD, 512 * kMegabyte);
#endif
}

}  // namespace cartographer_sdf
