// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The subcommands of the program. To add one, add a file with a function
// "Subcommand Foo()" that names its flags, what becomes of the files that they
// name, and the function to run, and list it in AllSubcommands.

#ifndef CARTOGRAPHER_SDF_TOOLS_SUBCOMMAND_H_
#define CARTOGRAPHER_SDF_TOOLS_SUBCOMMAND_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_sdf/tools/file_flags.h"
#include "cartographer_sdf/tools/run_record.h"

namespace cartographer_sdf {

// An error in the use of the program: incompatible flags, numbers out of range.
[[nodiscard]] absl::Status UsageError(const std::string& message);
[[nodiscard]] bool IsUsageError(const absl::Status& status);

// A refusal to give an answer that is not certain, where a file would have been
// made of it: the exit code is 3.
[[nodiscard]] absl::Status RefusalError(const std::string& message);
[[nodiscard]] bool IsRefusal(const absl::Status& status);

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
  // stderr and sets the exit code to 1, 2 for a UsageError, 3 for a
  // RefusalError.
  absl::Status (*run)(RunRecord*) = nullptr;
  std::string program = "cartographer_sdf";
  // If not null, called before the files are checked: wrong combinations of
  // flags are a UsageError.
  absl::Status (*check_flags)() = nullptr;
  // For developers of the project: the general help does not list it.
  bool is_for_developers = false;
  // Flags that arguments without a dash set, in this order; the last one, if it
  // takes several files, takes all that are left.
  std::vector<std::string> positional_flags = {};

  // The command that precedes the flags.
  [[nodiscard]] std::string Invocation() const {
    return name.empty() ? program : program + " " + name;
  }
  // Required, optional, and those that every subcommand has.
  [[nodiscard]] std::vector<SubcommandFlag> AllFlags() const;
  // Null if it has no flag of this name.
  [[nodiscard]] const SubcommandFlag* FindFlag(const std::string& flag) const;
};

// The flags that every subcommand has.
[[nodiscard]] const std::vector<SubcommandFlag>& CommonFlags();

// In the order of the help text.
[[nodiscard]] std::vector<Subcommand> AllSubcommands();

// Runs one command with its flags. Prints to stdout and stderr, writes the file
// of --result, and returns the exit code.
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
