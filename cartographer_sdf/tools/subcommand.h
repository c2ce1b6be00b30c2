// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The subcommands of the program. To add one: a file with its function
// "Subcommand Foo()", which names its flags and what runs; and its name in the
// table of subcommand.cc.

#ifndef CARTOGRAPHER_SDF_TOOLS_SUBCOMMAND_H_
#define CARTOGRAPHER_SDF_TOOLS_SUBCOMMAND_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_sdf/tools/usage_error.h"

namespace cartographer_sdf {

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

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_SUBCOMMAND_H_
