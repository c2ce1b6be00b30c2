// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/submap_flag.h"

#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "cartographer_sdf/tools/subcommand.h"

DEFINE_string(submap, "",
              "Submap to draw, as trajectory,index; if empty, the first of "
              "those with the most features.");

namespace cartographer_sdf {

absl::StatusOr<SubmapId> ParseSubmap(const std::string& flag,
                                     const std::string& value) {
  const std::vector<std::string> parts = absl::StrSplit(value, ',');
  SubmapId id;
  if (parts.size() != 2 || !absl::SimpleAtoi(parts[0], &id.trajectory) ||
      !absl::SimpleAtoi(parts[1], &id.index) || id.trajectory < 0 ||
      id.index < 0) {
    return UsageError(absl::StrCat("--", flag,
                                   " must be 2 numbers, separated by a comma, "
                                   "it is ",
                                   value));
  }
  return id;
}

}  // namespace cartographer_sdf
