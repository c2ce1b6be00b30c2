// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The subcommands of the program, and its command line: gflags holds the flags,
// but its own parser exits with code 1 and accepts every flag that is linked
// in. To add a subcommand: a file with its function "Subcommand Foo()", which
// names its flags and what runs; and its name in AllSubcommands.

#ifndef CARTOGRAPHER_SDF_TOOLS_SUBCOMMAND_H_
#define CARTOGRAPHER_SDF_TOOLS_SUBCOMMAND_H_

#include <string>
#include <vector>

#include "absl/status/status.h"

namespace cartographer_sdf {

// The user is at fault, not the world: flags that do not go together, numbers
// out of range.
[[nodiscard]] absl::Status UsageError(const std::string& message);
[[nodiscard]] bool IsUsageError(const absl::Status& status);

// Control characters become spaces.
[[nodiscard]] std::string OneLine(std::string text);

struct Subcommand {
  // Empty where the program has one command only.
  std::string name;
  // One line, without a full stop.
  std::string summary;
  // The arguments after the name, e.g. "--input A.pbstream [--report DIR]".
  std::string usage;
  // What the help says beyond the summary; paragraphs are separated by an empty
  // line.
  std::string description;
  // Names of gflags. Required ones must be given and not be empty; others that
  // are in neither list are wrong usage.
  std::vector<std::string> required_flags;
  std::vector<std::string> optional_flags;
  // Called once, with the flags set. An error's message becomes the one line on
  // stderr and the exit code 1, or 2 for a UsageError.
  absl::Status (*run)() = nullptr;
  std::string program = "cartographer_sdf";
  // For those who work on the project: the general help does not list it.
  bool is_for_developers = false;

  // What the user types before the flags.
  [[nodiscard]] std::string Invocation() const {
    return name.empty() ? program : program + " " + name;
  }
};

// In the order of the help.
[[nodiscard]] std::vector<Subcommand> AllSubcommands();

// Sets the flags of the subcommand: "--flag value", "--flag=value", with one
// dash or two, "--flag" and "--noflag" for booleans. Returns a UsageError for
// everything that is not exactly that, and for missing required flags.
[[nodiscard]] absl::Status SetFlags(const Subcommand& subcommand,
                                    const std::vector<std::string>& arguments);

// One command, with its flags. Messages go to stdout and stderr; returns the
// exit code.
[[nodiscard]] int RunSubcommand(const Subcommand& subcommand,
                                const std::vector<std::string>& arguments);

// The whole program, of AllSubcommands, in the same way.
[[nodiscard]] int RunProgram(const std::vector<std::string>& arguments);

// Makes the allocator of this process keep freed memory for what is allocated
// next; to be called before there are threads. The field of a submap and what
// is made of it are arrays of megabytes, freed before the next submap. Glibc
// gives such memory back, and the system clears every page that it hands out
// anew: half and more of the time that it takes to describe a large submap.
// Does nothing where the C library is another one.
void KeepFreedMemory();

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_SUBCOMMAND_H_
