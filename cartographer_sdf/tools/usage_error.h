// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_TOOLS_USAGE_ERROR_H_
#define CARTOGRAPHER_SDF_TOOLS_USAGE_ERROR_H_

#include <string>

#include "absl/status/status.h"

namespace cartographer_sdf {

// The user is at fault, not the world: flags that do not go together, numbers
// out of range.
[[nodiscard]] absl::Status UsageError(const std::string& message);
[[nodiscard]] bool IsUsageError(const absl::Status& status);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_USAGE_ERROR_H_
