// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Options of `--method shape_context`, the method that the paper compares
// itself with: those of the program, and how it describes submaps.

#ifndef CARTOGRAPHER_SDF_EVALUATION_COMPARISON_OPTIONS_H_
#define CARTOGRAPHER_SDF_EVALUATION_COMPARISON_OPTIONS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/evaluation/shape_context.h"

namespace cartographer_sdf {

struct ComparisonOptions {
  Options options;
  CloudPlaceOptions shape_context;
};
[[nodiscard]] std::string Validate(const ComparisonOptions& options);

// As LoadOptions, of a file whose table has `shape_context` besides, such as
// shape_context.lua.
[[nodiscard]] absl::StatusOr<ComparisonOptions> LoadComparisonOptions(
    const std::vector<std::string>& directories, const std::string& basename);

// As Lua that LoadComparisonOptions would read.
[[nodiscard]] std::string FormatOptions(const ComparisonOptions& options);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_COMPARISON_OPTIONS_H_
