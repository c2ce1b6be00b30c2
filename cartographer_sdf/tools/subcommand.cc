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
#include "absl/strings/str_cat.h"
#include "cartographer_sdf/tools/command_line.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/help.h"
#include "cartographer_sdf/tools/result_file.h"
#include "cartographer_sdf/tools/version.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace cartographer_sdf {

Subcommand AuditSubcommand();
Subcommand BatchSubcommand();
Subcommand CloseLoopsSubcommand();
Subcommand Evaluate();
Subcommand ExportSubcommand();
Subcommand FalsifySubcommand();
Subcommand Figures();
Subcommand Info();
Subcommand InspectSubcommand();
Subcommand MatchSubcommand();
Subcommand MergeSubcommand();
Subcommand RelocalizeSubcommand();
Subcommand SimulateSubcommand();

namespace {

constexpr char kUsagePayload[] = "cartographer_sdf/usage";
constexpr char kRefusalPayload[] = "cartographer_sdf/refusal";

bool IsHelp(const std::string& argument) {
  return argument == "--help" || argument == "-help" || argument == "-h";
}

bool HasArgument(const std::vector<std::string>& arguments,
                 const char* const text) {
  return std::find(arguments.begin(), arguments.end(), text) != arguments.end();
}

absl::Status WithPayload(absl::Status status, const char* const payload) {
  status.SetPayload(payload, absl::Cord());
  return status;
}

ExitCode ExitCodeOf(const absl::Status& status) {
  if (status.ok()) return ExitCode::kDone;
  if (IsUsageError(status)) return ExitCode::kWrongUsage;
  return IsRefusal(status) ? ExitCode::kAskedToFail : ExitCode::kWorldAtFault;
}

int Fail(const std::string& invocation, const absl::Status& status) {
  std::cerr << invocation << ": " << OneLine(std::string(status.message()))
            << "\n";
  return static_cast<int>(ExitCodeOf(status));
}

absl::Status CheckAndRun(const Subcommand& subcommand,
                         RunRecord* const record) {
  absl::Status status;
  if (subcommand.check_flags != nullptr) status = subcommand.check_flags();
  if (status.ok()) status = CheckFiles(subcommand);
  if (status.ok()) status = DescribeInputs(subcommand, &record->run);
  if (!status.ok()) return status;
  if (!WritesToStandardOutput(subcommand)) return subcommand.run(record);
  // A table has the standard output to itself.
  std::streambuf* const standard_output = std::cout.rdbuf(std::cerr.rdbuf());
  status = subcommand.run(record);
  std::cout.rdbuf(standard_output);
  return status;
}

// What --fail_on says of a run that succeeded.
RunEnd EndOf(const Subcommand& subcommand, const RunRecord& record,
             const absl::Status& status) {
  RunEnd end{status, ExitCodeOf(status)};
  const std::string condition =
      status.ok() ? ConditionToFailOn(record) : std::string();
  if (condition.empty()) return end;
  end.exit_code = ExitCode::kAskedToFail;
  std::cerr << subcommand.Invocation() << ": --fail_on " << condition
            << (record.reason.empty() ? "" : ": ") << OneLine(record.reason)
            << "\n";
  return end;
}

// With the flags set.
int RunWithResult(const Subcommand& subcommand,
                  const std::vector<std::string>& arguments) {
  absl::Status status = CheckFailOn();
  // Before what may fail: the file of --result tells of it.
  if (status.ok()) status = CheckResultFile(subcommand);
  if (!status.ok()) return Fail(subcommand.Invocation(), status);
  RunRecord record;
  record.run = DescribeRun(subcommand, arguments);
  const ResultFile result(subcommand);
  status = CheckAndRun(subcommand, &record);
  RunEnd end = EndOf(subcommand, record, status);
  if (absl::Status written = result.Write(record, end);
      status.ok() && !written.ok()) {
    end = {written, ExitCode::kWorldAtFault};
  }
  if (end.status.ok() && !std::cout.flush()) {
    end = {absl::UnavailableError("cannot write to the standard output"),
           ExitCode::kWorldAtFault};
  }
  return end.status.ok() ? static_cast<int>(end.exit_code)
                         : Fail(subcommand.Invocation(), end.status);
}

const Subcommand* FindSubcommand(const std::vector<Subcommand>& all,
                                 const std::string& name) {
  const auto found = std::find_if(
      all.begin(), all.end(),
      [&name](const Subcommand& candidate) { return candidate.name == name; });
  return found == all.end() ? nullptr : &*found;
}

int FailOnUnknown(const std::vector<Subcommand>& all, const std::string& name) {
  std::vector<std::string> names = {"help", "version", "completion"};
  for (const Subcommand& subcommand : all) names.push_back(subcommand.name);
  // What stands there may be a flag, which a subcommand must go before.
  const bool is_flag = absl::StartsWith(name, "-");
  if (is_flag) names = {"--help", "--version"};
  const std::string suggestion = NameSuggestion(name, "", names);
  return Fail(
      kProgramName,
      UsageError(absl::StrCat(
          is_flag ? "a subcommand is missing before '" : "unknown subcommand '",
          name, "'",
          suggestion.empty() ? absl::StrCat("; see ", kProgramName, " --help")
                             : suggestion)));
}

int PrintHelp(const std::vector<Subcommand>& all,
              const std::vector<std::string>& names) {
  if (names.size() > 1) {
    return Fail(kProgramName, UsageError("help takes one subcommand"));
  }
  if (names.empty()) {
    std::cout << GeneralHelp();
    return 0;
  }
  const Subcommand* const subcommand = FindSubcommand(all, names.front());
  if (subcommand == nullptr) return FailOnUnknown(all, names.front());
  std::cout << HelpText(*subcommand);
  return 0;
}

int PrintCompletion(const std::vector<std::string>& shells) {
  const std::optional<std::string> script =
      shells.size() == 1 ? CompletionScript(shells.front()) : std::nullopt;
  if (!script) {
    return Fail(kProgramName, UsageError("completion needs bash or zsh"));
  }
  std::cout << *script;
  return 0;
}

}  // namespace

absl::Status UsageError(const std::string& message) {
  return WithPayload(absl::InvalidArgumentError(message), kUsagePayload);
}

bool IsUsageError(const absl::Status& status) {
  return status.GetPayload(kUsagePayload).has_value();
}

absl::Status RefusalError(const std::string& message) {
  return WithPayload(absl::FailedPreconditionError(message), kRefusalPayload);
}

bool IsRefusal(const absl::Status& status) {
  return status.GetPayload(kRefusalPayload).has_value();
}

std::string OneLine(std::string text) {
  for (char& c : text) {
    if (absl::ascii_iscntrl(static_cast<unsigned char>(c))) c = ' ';
  }
  return text;
}

const std::vector<SubcommandFlag>& CommonFlags() {
  static const auto* const kFlags = new std::vector<SubcommandFlag>{
      {"result", FileUse::kWriteText}, "fail_on"};
  return *kFlags;
}

std::vector<SubcommandFlag> Subcommand::AllFlags() const {
  std::vector<SubcommandFlag> flags = required_flags;
  flags.insert(flags.end(), optional_flags.begin(), optional_flags.end());
  flags.insert(flags.end(), CommonFlags().begin(), CommonFlags().end());
  return flags;
}

const SubcommandFlag* Subcommand::FindFlag(const std::string& flag) const {
  for (const auto* const flags :
       {&required_flags, &optional_flags, &CommonFlags()}) {
    for (const SubcommandFlag& candidate : *flags) {
      if (candidate.name == flag) return &candidate;
    }
  }
  return nullptr;
}

std::vector<Subcommand> AllSubcommands() {
  return {CloseLoopsSubcommand(),
          MatchSubcommand(),
          RelocalizeSubcommand(),
          MergeSubcommand(),
          AuditSubcommand(),
          BatchSubcommand(),
          ExportSubcommand(),
          Evaluate(),
          Figures(),
          InspectSubcommand(),
          SimulateSubcommand(),
          FalsifySubcommand(),
          Info()};
}

int RunSubcommand(const Subcommand& subcommand,
                  const std::vector<std::string>& arguments) {
  if (std::any_of(arguments.begin(), arguments.end(), IsHelp)) {
    std::cout << HelpText(subcommand);
    return 0;
  }
  if (HasArgument(arguments, "--man")) {
    std::cout << ManPage(subcommand);
    return 0;
  }
  if (HasArgument(arguments, "--version")) {
    std::cout << VersionLine(subcommand.program) << "\n";
    return 0;
  }
  const absl::Status status = SetFlags(subcommand, arguments);
  return status.ok() ? RunWithResult(subcommand, arguments)
                     : Fail(subcommand.Invocation(), status);
}

int RunProgram(const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    return Fail(kProgramName,
                UsageError(absl::StrCat("which subcommand? See ", kProgramName,
                                        " --help")));
  }
  const std::string& name = arguments.front();
  const std::vector<std::string> others(arguments.begin() + 1, arguments.end());
  const std::vector<Subcommand> all = AllSubcommands();
  if (IsHelp(name)) return PrintHelp(all, {});
  if (name == "help") return PrintHelp(all, others);
  if (name == "completion") return PrintCompletion(others);
  if (name == "--version" || name == "version") {
    std::cout << VersionLine(kProgramName) << "\n";
    return 0;
  }
  if (name == "--man") {
    std::cout << GeneralManPage();
    return 0;
  }
  const Subcommand* const subcommand = FindSubcommand(all, name);
  return subcommand != nullptr ? RunSubcommand(*subcommand, others)
                               : FailOnUnknown(all, name);
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
