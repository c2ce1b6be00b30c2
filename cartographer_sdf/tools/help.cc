// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/help.h"

#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "cartographer_sdf/tools/version.h"
#include "gflags/gflags.h"

namespace cartographer_sdf {
namespace {

constexpr size_t kLineLength = 80;
constexpr char kSummary[] =
    "wide-baseline loop closing for maps of Cartographer 2D";
constexpr const char* kUsages[] = {"SUBCOMMAND [MAP...] --flags",
                                   "SUBCOMMAND --help", "help [SUBCOMMAND]",
                                   "version", "completion bash|zsh"};

struct ExitCodeMeaning {
  ExitCode code;
  const char* meaning;
};
constexpr ExitCodeMeaning kExitCodes[] = {
    {ExitCode::kDone, "done"},
    {ExitCode::kWorldAtFault, "a file is at fault, or the machine"},
    {ExitCode::kWrongUsage, "wrong usage"},
    {ExitCode::kAskedToFail,
     "refused, or what --fail_on names: no certain answer, nothing found, a "
     "warning"}};

// gflags prints doubles with all digits.
std::string ShortDefault(const gflags::CommandLineFlagInfo& info) {
  double value = 0.;
  if (info.type == "double" && absl::SimpleAtod(info.default_value, &value)) {
    return absl::StrCat(value);
  }
  return info.default_value;
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

struct FlagHelp {
  std::string name;
  std::string type;
  std::string remark;  // "required", "default: 3" or nothing
  std::string description;
};

FlagHelp HelpOf(const SubcommandFlag& flag, const bool is_required) {
  const gflags::CommandLineFlagInfo info =
      gflags::GetCommandLineFlagInfoOrDie(flag.name.c_str());
  return {flag.name, info.type,
          is_required                  ? "required"
          : info.default_value.empty() ? ""
                                       : "default: " + ShortDefault(info),
          flag.help.empty() ? info.description : flag.help};
}

std::vector<FlagHelp> FlagHelps(const Subcommand& subcommand) {
  std::vector<FlagHelp> helps;
  for (const SubcommandFlag& flag : subcommand.required_flags) {
    helps.push_back(HelpOf(flag, true));
  }
  for (const SubcommandFlag& flag : subcommand.optional_flags) {
    helps.push_back(HelpOf(flag, false));
  }
  for (const SubcommandFlag& flag : CommonFlags()) {
    helps.push_back(HelpOf(flag, false));
  }
  return helps;
}

// --- Manual pages. ---

std::string EscapeTroff(const std::string& text) {
  std::string escaped = absl::StrReplaceAll(
      text,
      {{"\\", "\\e"}, {"-", "\\-"}, {"\n.", "\n\\&."}, {"\n'", "\n\\&'"}});
  if (!escaped.empty() && (escaped[0] == '.' || escaped[0] == '\'')) {
    escaped.insert(0, "\\&");
  }
  return escaped;
}

std::string TroffParagraphs(const std::string& text) {
  return absl::StrReplaceAll(EscapeTroff(text), {{"\n\n", "\n.PP\n"}}) + "\n";
}

std::string TroffHeader(const std::string& title) {
  return absl::StrCat(".TH \"", EscapeTroff(absl::AsciiStrToUpper(title)),
                      "\" \"1\" \"\" \"", EscapeTroff(kProgramName), " ",
                      ProgramVersion(), "\" \"User Commands\"\n");
}

std::string TroffExitCodes() {
  std::string text = ".SH \"EXIT STATUS\"\n";
  for (const ExitCodeMeaning& entry : kExitCodes) {
    absl::StrAppend(&text, ".TP\n.B ", static_cast<int>(entry.code), "\n",
                    EscapeTroff(entry.meaning), "\n");
  }
  return text;
}

// --- Completion. ---

std::string FlagWords(const Subcommand& subcommand) {
  std::string words;
  for (const SubcommandFlag& flag : subcommand.AllFlags()) {
    absl::StrAppend(&words, words.empty() ? "" : " ", "--", flag.name);
  }
  return words;
}

std::string SubcommandWords() {
  std::string words = "help version completion";
  for (const Subcommand& subcommand : AllSubcommands()) {
    if (!subcommand.is_for_developers) {
      absl::StrAppend(&words, " ", subcommand.name);
    }
  }
  return words;
}

std::string BashCompletion() {
  std::string text =
      absl::StrCat("# bash completion for ", kProgramName, "\n",
                   "_cartographer_sdf() {\n"
                   "  local current=\"${COMP_WORDS[COMP_CWORD]}\" flags=\"\"\n"
                   "  COMPREPLY=()\n"
                   "  if ((COMP_CWORD == 1)); then\n"
                   "    COMPREPLY=($(compgen -W \"",
                   SubcommandWords(),
                   "\" -- \"${current}\"))\n"
                   "    return\n"
                   "  fi\n"
                   "  case \"${COMP_WORDS[1]}\" in\n"
                   "    help) flags=\"",
                   SubcommandWords(),
                   "\" ;;\n"
                   "    completion) flags=\"bash zsh\" ;;\n");
  for (const Subcommand& subcommand : AllSubcommands()) {
    absl::StrAppend(&text, "    ", subcommand.name, ") flags=\"",
                    FlagWords(subcommand), "\" ;;\n");
  }
  return text +
         "  esac\n"
         "  if [[ \"${current}\" == -* || \"${COMP_WORDS[1]}\" == help ||\n"
         "    \"${COMP_WORDS[1]}\" == completion ]]; then\n"
         "    COMPREPLY=($(compgen -W \"${flags}\" -- \"${current}\"))\n"
         "  fi\n"
         "}\n"
         "complete -o bashdefault -o default -F _cartographer_sdf "
         "cartographer_sdf\n";
}

// Within single quotes.
std::string EscapeZsh(const std::string& text) {
  return absl::StrReplaceAll(
      text, {{"'", "'\\''"}, {"[", "\\["}, {"]", "\\]"}, {":", "\\:"}});
}

std::string ZshFlags(const Subcommand& subcommand) {
  std::string text;
  for (const SubcommandFlag& flag : subcommand.AllFlags()) {
    const FlagHelp help = HelpOf(flag, false);
    const std::string first_sentence =
        help.description.substr(0, help.description.find('.'));
    absl::StrAppend(&text, " \\\n        '--", flag.name, "[",
                    EscapeZsh(first_sentence), "]");
    if (help.type != "bool") {
      absl::StrAppend(&text, ":", flag.name, ":",
                      flag.use == FileUse::kNone ? " " : "_files");
    }
    text += "'";
  }
  return text;
}

std::string ZshCompletion() {
  std::string text =
      absl::StrCat("#compdef ", kProgramName,
                   "\n\n_cartographer_sdf() {\n  if ((CURRENT == 2)); then\n"
                   "    local -a subcommands=(\n      'help:show help'\n"
                   "      'version:show the version'\n"
                   "      'completion:print a completion script'\n");
  for (const Subcommand& subcommand : AllSubcommands()) {
    if (subcommand.is_for_developers) continue;
    absl::StrAppend(&text, "      '", subcommand.name, ":",
                    EscapeZsh(subcommand.summary), "'\n");
  }
  text +=
      "    )\n    _describe 'subcommand' subcommands\n    return\n  fi\n"
      "  local subcommand=\"${words[2]}\"\n  shift words\n  ((CURRENT--))\n"
      "  case \"${subcommand}\" in\n";
  for (const Subcommand& subcommand : AllSubcommands()) {
    absl::StrAppend(&text, "    ", subcommand.name, ")\n      _arguments",
                    ZshFlags(subcommand),
                    " \\\n        '*:map:_files'\n      ;;\n");
  }
  return text + "  esac\n}\n\n_cartographer_sdf \"$@\"\n";
}

}  // namespace

std::string HelpText(const Subcommand& subcommand) {
  std::string text = absl::StrCat(
      subcommand.Invocation(), ": ", subcommand.summary, ".\n\nUsage:\n",
      Wrap(absl::StrCat(subcommand.Invocation(), " ", subcommand.usage), 2));
  if (!subcommand.description.empty()) {
    absl::StrAppend(&text, "\n", Wrap(subcommand.description, 0));
  }
  absl::StrAppend(&text, "\nFlags:\n");
  for (const FlagHelp& flag : FlagHelps(subcommand)) {
    absl::StrAppend(&text, "  --", flag.name, " <", flag.type, ">",
                    flag.remark.empty() ? "" : " (" + flag.remark + ")", "\n",
                    Wrap(flag.description, 6));
  }
  return text;
}

std::string GeneralHelp() {
  std::string text =
      absl::StrCat(VersionLine(kProgramName), ": ", kSummary, ".\n\nUsage:\n");
  for (const char* const usage : kUsages) {
    absl::StrAppend(&text, "  ", kProgramName, " ", usage, "\n");
  }
  text += "\nSubcommands:\n";
  for (const Subcommand& subcommand : AllSubcommands()) {
    if (subcommand.is_for_developers) continue;
    absl::StrAppend(&text, absl::StrFormat("  %-13s%s\n", subcommand.name,
                                           subcommand.summary));
  }
  text += "\nExit codes:\n";
  for (const ExitCodeMeaning& entry : kExitCodes) {
    std::string lines = Wrap(entry.meaning, 5);
    lines[2] = static_cast<char>('0' + static_cast<int>(entry.code));
    text += lines;
  }
  return text;
}

std::string ManPage(const Subcommand& subcommand) {
  const std::string title =
      absl::StrReplaceAll(subcommand.Invocation(), {{" ", "-"}});
  std::string text = absl::StrCat(
      TroffHeader(title), ".SH NAME\n", EscapeTroff(title), " \\- ",
      EscapeTroff(subcommand.summary), "\n.SH SYNOPSIS\n.B ",
      EscapeTroff(subcommand.Invocation()), "\n", EscapeTroff(subcommand.usage),
      "\n.SH DESCRIPTION\n",
      TroffParagraphs(subcommand.description.empty() ? subcommand.summary + "."
                                                     : subcommand.description),
      ".SH OPTIONS\n");
  for (const FlagHelp& flag : FlagHelps(subcommand)) {
    absl::StrAppend(
        &text, ".TP\n.BI \\-\\-", EscapeTroff(flag.name), " \" <",
        EscapeTroff(flag.type), ">",
        flag.remark.empty() ? "" : EscapeTroff(" (" + flag.remark + ")"),
        "\"\n", TroffParagraphs(flag.description));
  }
  return absl::StrCat(text, TroffExitCodes(), ".SH \"SEE ALSO\"\n.BR ",
                      EscapeTroff(kProgramName), " (1)\n");
}

std::string GeneralManPage() {
  std::string text = absl::StrCat(TroffHeader(kProgramName), ".SH NAME\n",
                                  EscapeTroff(kProgramName), " \\- ",
                                  EscapeTroff(kSummary), "\n.SH SYNOPSIS\n");
  for (const char* const usage : kUsages) {
    absl::StrAppend(&text, ".B ", EscapeTroff(kProgramName), "\n",
                    EscapeTroff(usage), "\n.br\n");
  }
  text += ".SH SUBCOMMANDS\n";
  for (const Subcommand& subcommand : AllSubcommands()) {
    if (subcommand.is_for_developers) continue;
    absl::StrAppend(&text, ".TP\n.BR ", EscapeTroff(kProgramName), "\\-",
                    EscapeTroff(subcommand.name), " (1)\n",
                    EscapeTroff(subcommand.summary), "\n");
  }
  return text + TroffExitCodes();
}

std::optional<std::string> CompletionScript(const std::string& shell) {
  if (shell == "bash") return BashCompletion();
  if (shell == "zsh") return ZshCompletion();
  return std::nullopt;
}

}  // namespace cartographer_sdf
