// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What the program says about itself, for people and for shells. All of it is
// made of the same descriptions, so that none goes out of date.

#ifndef CARTOGRAPHER_SDF_TOOLS_HELP_H_
#define CARTOGRAPHER_SDF_TOOLS_HELP_H_

#include <optional>
#include <string>

#include "cartographer_sdf/tools/subcommand.h"

namespace cartographer_sdf {

constexpr char kProgramName[] = "cartographer_sdf";

// For a terminal of 80 columns.
[[nodiscard]] std::string HelpText(const Subcommand& subcommand);
[[nodiscard]] std::string GeneralHelp();

// Pages of section 1 of the manual, as troff.
[[nodiscard]] std::string ManPage(const Subcommand& subcommand);
[[nodiscard]] std::string GeneralManPage();

// A script for "bash" or "zsh" that completes subcommands, flags and files;
// none for other shells.
[[nodiscard]] std::optional<std::string> CompletionScript(
    const std::string& shell);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_HELP_H_
