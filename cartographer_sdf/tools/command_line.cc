// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/command_line.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "cartographer_sdf/config/nearest_name.h"
#include "gflags/gflags.h"

namespace cartographer_sdf {
namespace {

constexpr char kEndOfFlags[] = "--";

// The first of the long names that a subcommand has counts.
constexpr std::pair<const char*, const char*> kOtherNames[] = {
    {"o", "output"},
    {"o", "output_dir"},
    {"i", "input"},
    {"j", "jobs"},
    {"configuration_directories", "configuration_directory"},
    {"pbstream_filename", "input"},
};

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

std::vector<std::string> NamesOf(const std::vector<SubcommandFlag>& flags) {
  std::vector<std::string> names;
  for (const SubcommandFlag& flag : flags) names.push_back(flag.name);
  return names;
}

gflags::CommandLineFlagInfo InfoOf(const std::string& flag) {
  return gflags::GetCommandLineFlagInfoOrDie(flag.c_str());
}

absl::Status UnexpectedArgument(const std::string& argument) {
  return UsageError(absl::StrCat("unexpected argument '", argument, "'"));
}

// Flags are set as they are read.
class FlagReader {
 public:
  FlagReader(const Subcommand& subcommand,
             const std::vector<std::string>& arguments)
      : subcommand_(subcommand), arguments_(arguments) {}

  absl::Status Read() {
    bool takes_flags = true;
    while (next_ < arguments_.size()) {
      const std::string& argument = arguments_[next_++];
      if (takes_flags && argument == kEndOfFlags) {
        takes_flags = false;
        continue;
      }
      const std::optional<FlagArgument> flag =
          takes_flags ? SplitFlag(argument) : std::nullopt;
      if (!flag.has_value()) {
        positionals_.push_back(argument);
        continue;
      }
      const absl::Status status = ReadFlag(*flag);
      if (!status.ok()) return status;
    }
    return ReadPositionals();
  }

 private:
  absl::Status ReadFlag(FlagArgument flag) {
    flag.name = LongName(subcommand_, flag.name);
    const std::string positive(absl::StripPrefix(flag.name, "no"));
    if (subcommand_.FindFlag(flag.name) == nullptr &&
        subcommand_.FindFlag(positive) != nullptr &&
        InfoOf(positive).type == "bool" && !flag.value.has_value()) {
      flag = FlagArgument{positive, "false"};
    }
    const SubcommandFlag* const known = subcommand_.FindFlag(flag.name);
    if (known == nullptr) {
      return UsageError(absl::StrCat("unknown flag '--", flag.name, "'",
                                     FlagSuggestion(subcommand_, flag.name)));
    }
    if (!flag.value && InfoOf(flag.name).type == "bool") flag.value = "true";
    if (!flag.value && next_ < arguments_.size() &&
        !absl::StartsWith(arguments_[next_], "--")) {
      flag.value = arguments_[next_++];
    }
    if (!flag.value) {
      return UsageError(absl::StrCat("--", flag.name, " needs a value"));
    }
    return Set(*known, *flag.value);
  }

  absl::Status Set(const SubcommandFlag& flag, const std::string& value) {
    const gflags::CommandLineFlagInfo info = InfoOf(flag.name);
    const bool is_first = given_.insert(flag.name).second;
    const std::string whole =
        TakesSeveralFiles(flag) && !is_first && !info.current_value.empty()
            ? absl::StrCat(info.current_value, ",", value)
            : value;
    if (!gflags::SetCommandLineOption(flag.name.c_str(), whole.c_str())
             .empty()) {
      return absl::OkStatus();
    }
    return UsageError(absl::StrCat("--", flag.name, " must be of type ",
                                   info.type, ", it is '", value, "'"));
  }

  absl::Status ReadPositionals() {
    auto next = positionals_.begin();
    for (const std::string& name : subcommand_.positional_flags) {
      const SubcommandFlag& flag = *subcommand_.FindFlag(name);
      const bool takes_all = TakesSeveralFiles(flag);
      if (given_.count(name) > 0 && !takes_all) continue;
      while (next != positionals_.end() && !next->empty()) {
        const absl::Status status =
            Set(flag, takes_all ? JoinPaths({*next}) : *next);
        if (!status.ok()) return status;
        ++next;
        if (!takes_all) break;
      }
    }
    return next == positionals_.end() ? absl::OkStatus()
                                      : UnexpectedArgument(*next);
  }

  const Subcommand& subcommand_;
  const std::vector<std::string>& arguments_;
  size_t next_ = 0;
  std::set<std::string> given_;
  std::vector<std::string> positionals_;
};

absl::Status CheckRequired(const Subcommand& subcommand) {
  for (const SubcommandFlag& flag : subcommand.required_flags) {
    if (InfoOf(flag.name).current_value.empty()) {
      return UsageError(absl::StrCat(
          "--", flag.name, " is missing; usage: ", subcommand.Invocation(), " ",
          subcommand.usage));
    }
  }
  return absl::OkStatus();
}

}  // namespace

std::string NameSuggestion(const std::string& name, const std::string& prefix,
                           const std::vector<std::string>& candidates) {
  std::optional<std::string> nearest = NearestName(name, candidates);
  if (!nearest && !name.empty()) {
    const auto begins = [&name](const std::string& candidate) {
      return absl::StartsWith(candidate, name);
    };
    const auto first =
        std::find_if(candidates.begin(), candidates.end(), begins);
    if (first != candidates.end() &&
        std::count_if(first, candidates.end(), begins) == 1) {
      nearest = *first;
    }
  }
  if (!nearest.has_value()) return "";
  return absl::StrCat(", did you mean '", prefix, *nearest, "'?");
}

std::string FlagSuggestion(const Subcommand& subcommand,
                           const std::string& flag) {
  std::vector<std::string> owners;
  for (const Subcommand& other : AllSubcommands()) {
    if (other.FindFlag(flag) != nullptr) owners.push_back(other.name);
  }
  if (!owners.empty()) {
    return absl::StrCat(", which belongs to ", absl::StrJoin(owners, ", "));
  }
  std::vector<std::string> names = NamesOf(subcommand.AllFlags());
  for (const std::string& name : NamesOf(subcommand.AllFlags())) {
    if (InfoOf(name).type == "bool") names.push_back("no" + name);
  }
  return NameSuggestion(flag, "--", names);
}

std::string LongName(const Subcommand& subcommand, const std::string& name) {
  if (subcommand.FindFlag(name) != nullptr) return name;
  for (const auto& [other_name, long_name] : kOtherNames) {
    if (name == other_name && subcommand.FindFlag(long_name) != nullptr) {
      return long_name;
    }
  }
  return name;
}

absl::Status SetFlags(const Subcommand& subcommand,
                      const std::vector<std::string>& arguments) {
  absl::Status status = FlagReader(subcommand, arguments).Read();
  if (status.ok()) status = ApplyInPlace(subcommand);
  return status.ok() ? CheckRequired(subcommand) : status;
}

}  // namespace cartographer_sdf
