// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// From the arguments of a subcommand to its flags. gflags holds them, as in
// Cartographer; its own parser exits with code 1, and accepts every flag that
// is linked in.

#ifndef CARTOGRAPHER_SDF_TOOLS_COMMAND_LINE_H_
#define CARTOGRAPHER_SDF_TOOLS_COMMAND_LINE_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_sdf/tools/subcommand.h"

namespace cartographer_sdf {

// Sets the flags of the subcommand: "--flag value", "--flag=value", with one
// dash or two; "--flag" and "--noflag" for booleans; "-o" for the output, and
// other short names (LongName). Arguments without a dash, and all after "--",
// are for its positional flags. Flags of several files add up. Returns a
// UsageError for anything else, and for missing required flags.
[[nodiscard]] absl::Status SetFlags(const Subcommand& subcommand,
                                    const std::vector<std::string>& arguments);

// A part of a message: ", did you mean '--input'?", or which other subcommands
// have this flag; empty if neither. `flag` has no dashes.
[[nodiscard]] std::string FlagSuggestion(const Subcommand& subcommand,
                                         const std::string& flag);

// As above, among given names; what begins with `name` is near, too.
[[nodiscard]] std::string NameSuggestion(
    const std::string& name, const std::string& prefix,
    const std::vector<std::string>& candidates);

// The flag of this subcommand that another name stands for: "o", "i", "j", and
// names under which Cartographer or earlier versions know a flag. The name
// itself if it stands for none.
[[nodiscard]] std::string LongName(const Subcommand& subcommand,
                                   const std::string& name);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_COMMAND_LINE_H_
