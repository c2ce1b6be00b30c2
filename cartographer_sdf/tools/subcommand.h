// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The subcommands of the program, and its command line. gflags holds the flags,
// but its parser exits with code 1 and accepts every flag that is linked in. To
// add a subcommand, add a file with a function "Subcommand Foo()" that names
// its flags, what becomes of the files that they name, and the function to run,
// and list it in AllSubcommands.

#ifndef CARTOGRAPHER_SDF_TOOLS_SUBCOMMAND_H_
#define CARTOGRAPHER_SDF_TOOLS_SUBCOMMAND_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_sdf/tools/file_flags.h"

namespace cartographer_sdf {

// An error in the use of the program: incompatible flags, numbers out of range.
[[nodiscard]] absl::Status UsageError(const std::string& message);
[[nodiscard]] bool IsUsageError(const absl::Status& status);

// Replaces control characters by spaces.
[[nodiscard]] std::string OneLine(std::string text);

struct Subcommand {
  // Empty if the program has only one command.
  std::string name;
  // One line, without a full stop.
  std::string summary;
  // The arguments after the name, e.g. "--input A.pbstream [--report DIR]".
  std::string usage;
  // The help beyond the summary; empty lines separate paragraphs.
  std::string description;
  // Required flags must be given and not empty; flags in neither list are a
  // usage error. The files that they name are checked before the run.
  std::vector<SubcommandFlag> required_flags;
  std::vector<SubcommandFlag> optional_flags;
  // Called once, with the flags set. An error prints its message as one line on
  // stderr and sets the exit code to 1, or 2 for a UsageError.
  absl::Status (*run)() = nullptr;
  std::string program = "cartographer_sdf";
  // If not null, called before the files are checked: wrong combinations of
  // flags are a UsageError.
  absl::Status (*check_flags)() = nullptr;
  // For developers of the project: the general help does not list it.
  bool is_for_developers = false;

  // The command that precedes the flags.
  [[nodiscard]] std::string Invocation() const {
    return name.empty() ? program : program + " " + name;
  }
};

// In the order of the help text.
[[nodiscard]] std::vector<Subcommand> AllSubcommands();

// Sets the flags of the subcommand: "--flag value", "--flag=value", with one
// dash or two, "--flag" and "--noflag" for booleans. Returns a UsageError for
// anything else, and for missing required flags.
[[nodiscard]] absl::Status SetFlags(const Subcommand& subcommand,
                                    const std::vector<std::string>& arguments);

// Runs one command with its flags. Prints to stdout and stderr; returns the
// exit code.
[[nodiscard]] int RunSubcommand(const Subcommand& subcommand,
                                const std::vector<std::string>& arguments);

// Runs the whole program, with AllSubcommands, in the same way.
[[nodiscard]] int RunProgram(const std::vector<std::string>& arguments);

// Makes the allocator of this process keep freed memory for reuse; call it
// before starting threads. The field of a submap and the data derived from it
// are arrays of megabytes that are freed before the next submap. Glibc returns
// such memory to the system, which clears every page before handing it out
// again: half or more of the time it takes to describe a large submap. Does
// nothing with other C libraries.
void KeepFreedMemory();

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_SUBCOMMAND_H_
