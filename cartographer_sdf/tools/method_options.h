// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The methods that `match` and `evaluate` know, by name, and their options.

#ifndef CARTOGRAPHER_SDF_TOOLS_METHOD_OPTIONS_H_
#define CARTOGRAPHER_SDF_TOOLS_METHOD_OPTIONS_H_

#include <string>

#include "absl/status/statusor.h"
#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/evaluation/shape_context.h"

namespace cartographer_sdf {

struct MethodOptions {
  Options options;
  // Only where `describes_clouds`.
  CloudPlaceOptions shape_context;
  // Whether places are described by shape contexts of point clouds, and not by
  // features of the distance field; matching is then that of the paper.
  bool describes_clouds = false;
};

// All options that are in force, as Lua.
[[nodiscard]] std::string FormatOptions(const MethodOptions& options);

// Of "sdf", "paper", "shape_context", or, for an empty name, of what the
// configuration file says. paper and shape_context read the file that is called
// as they are, unless --configuration_basename is given.
[[nodiscard]] absl::StatusOr<MethodOptions> LoadOptionsOfMethod(
    const std::string& method);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_METHOD_OPTIONS_H_
