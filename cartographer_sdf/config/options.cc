// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/config/options.h"

#include "cartographer_sdf/config/option_binding.h"
#include "cartographer_sdf/config/option_keys.h"

namespace cartographer_sdf {
std::string Validate(const Options&) { return ""; }

absl::StatusOr<Options> LoadOptions(const std::vector<std::string>& directories,
                                    const std::string& basename) {
  const absl::StatusOr<LuaDictionary> dictionary =
      LoadLuaDictionary(directories, basename, kOptionsTable);
  if (!dictionary.ok()) return dictionary.status();
  return ReadOptions<Options>(*dictionary);
}

std::string FormatPlaceOptions(const PlaceOptions& place,
                               const MatchOptions& match) {
  return FormatOptions("place", place) + FormatOptions("match", match);
}

std::string FormatOptions(const Options& options) {
  return FormatOptions(kOptionsTable, options) + "\nreturn " + kOptionsTable +
         "\n";
}

}  // namespace cartographer_sdf
