// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_FILE_WHOLE_FILE_H_
#define CARTOGRAPHER_SDF_FILE_WHOLE_FILE_H_

#include <string>

#include "absl/status/status.h"

namespace cartographer_sdf {

// Stands for the standard output where a path is expected.
constexpr char kStandardOutput[] = "-";

// Writes a PendingFile, so that `path` always holds the complete old file or
// the complete new one; or to the standard output. Errors name the path.
[[nodiscard]] absl::Status WriteWholeFile(const std::string& path,
                                          const std::string& content);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_FILE_WHOLE_FILE_H_
