// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The methods of `match` and `evaluate`, by name, and their options.

#ifndef CARTOGRAPHER_SDF_TOOLS_METHOD_OPTIONS_H_
#define CARTOGRAPHER_SDF_TOOLS_METHOD_OPTIONS_H_

#include <string>

#include "absl/status/statusor.h"
#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/evaluation/shape_context.h"

namespace cartographer_sdf {

struct MethodOptions {
  Options options;
  // Only used if `describes_clouds`.
  CloudPlaceOptions shape_context;
  // Whether places are described by shape contexts of point clouds, not by
  // features of the distance field; matching then follows the paper.
  bool describes_clouds = false;
};

// All options in force, as Lua.
[[nodiscard]] std::string FormatOptions(const MethodOptions& options);

// Loads the options of "sdf", "paper", "shape_context", or, for an empty name,
// of the method in the configuration file. paper and shape_context read the
// configuration file of their name, unless --configuration_basename is given.
[[nodiscard]] absl::StatusOr<MethodOptions> LoadOptionsOfMethod(
    const std::string& method);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_METHOD_OPTIONS_H_
