// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The command line: gflags holds the flags, but its own parser exits with code
// 1 and accepts every flag that is linked in.

#ifndef CARTOGRAPHER_SDF_TOOLS_COMMAND_LINE_H_
#define CARTOGRAPHER_SDF_TOOLS_COMMAND_LINE_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_sdf/tools/subcommand.h"

namespace cartographer_sdf {

// Sets the flags of the subcommand: "--flag value", "--flag=value", with one
// dash or two, "--flag" and "--noflag" for booleans. Returns a UsageError for
// everything that is not exactly that, and for missing required flags.
[[nodiscard]] absl::Status SetFlags(const Subcommand& subcommand,
                                    const std::vector<std::string>& arguments);

[[nodiscard]] std::string HelpText(const std::vector<Subcommand>& subcommands);
[[nodiscard]] std::string HelpText(const Subcommand& subcommand);

// One command, with its flags. Messages go to stdout and stderr; returns the
// exit code.
[[nodiscard]] int RunSubcommand(const Subcommand& subcommand,
                                const std::vector<std::string>& arguments);

// The whole program. Messages go to stdout and stderr; returns the exit code.
[[nodiscard]] int RunProgram(const std::vector<Subcommand>& subcommands,
                             const std::vector<std::string>& arguments);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_COMMAND_LINE_H_
