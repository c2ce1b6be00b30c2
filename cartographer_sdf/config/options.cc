// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/config/options.h"

#include "cartographer_sdf/config/option_keys.h"

namespace cartographer_sdf {

std::string Validate(const Options&) { return ""; }

absl::StatusOr<Options> LoadOptions(const std::vector<std::string>& directories,
                                    const std::string& basename) {
  return LoadTable<Options>(directories, basename, kOptionsTable);
}

std::string FormatPlaceOptions(PlaceOptions place, const MatchOptions& match) {
  // What no place depends on.
  place.max_field_megabytes = PlaceOptions().max_field_megabytes;
  return FormatTable("place", place) + FormatTable("match", match);
}

std::string FormatOptions(const Options& options) {
  return FormatFile(kOptionsTable, options);
}

std::vector<ChangedOption> ChangedOptions(const Options& options) {
  return ListChangedOptions(options);
}

}  // namespace cartographer_sdf
