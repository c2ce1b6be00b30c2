// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_TOOLS_SUBMAP_FLAG_H_
#define CARTOGRAPHER_SDF_TOOLS_SUBMAP_FLAG_H_

#include <string>

#include "absl/status/statusor.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "gflags/gflags.h"

DECLARE_string(submap);

namespace cartographer_sdf {

// The value of a flag that names a submap: "trajectory,index". A UsageError for
// anything else.
[[nodiscard]] absl::StatusOr<SubmapId> ParseSubmap(const std::string& flag,
                                                   const std::string& value);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_SUBMAP_FLAG_H_
