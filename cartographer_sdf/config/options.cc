// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/config/options.h"

#include "cartographer_sdf/config/option_binding.h"
#include "cartographer_sdf/config/option_keys.h"

namespace cartographer_sdf {
namespace {

constexpr char kTableName[] = "SDF_GLOBAL_CONSTRAINTS";

}  // namespace

std::string Validate(const Options&) { return ""; }

absl::StatusOr<Options> LoadOptions(const std::vector<std::string>& directories,
                                    const std::string& basename) {
  const absl::StatusOr<LuaDictionary> dictionary =
      LoadLuaDictionary(directories, basename, kTableName);
  if (!dictionary.ok()) return dictionary.status();
  return ReadOptions<Options>(*dictionary);
}

std::string FormatOptions(const Options& options) {
  return FormatOptions(kTableName, options) + "\nreturn " + kTableName + "\n";
}

}  // namespace cartographer_sdf
