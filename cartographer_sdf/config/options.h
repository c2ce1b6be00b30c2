// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// All options of the program, and the one place that says under which keys of
// SDF_GLOBAL_CONSTRAINTS they are found.

#ifndef CARTOGRAPHER_SDF_CONFIG_OPTIONS_H_
#define CARTOGRAPHER_SDF_CONFIG_OPTIONS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/apps/audit.h"
#include "cartographer_sdf/apps/close_loops.h"
#include "cartographer_sdf/apps/fold_check.h"
#include "cartographer_sdf/localization/localizer.h"
#include "cartographer_sdf/localization/scan_places.h"
#include "cartographer_sdf/report/report_options.h"

namespace cartographer_sdf {

// The table of the configuration files.
constexpr char kOptionsTable[] = "SDF_GLOBAL_CONSTRAINTS";

struct Options {
  LoopClosingOptions loop_closing;
  LocalizationOptions localization;
  ScanPlaceOptions scan_places;
  FoldCheckOptions fold_check;
  AuditOptions audit;
  ReportOptions report;
};

// Of what concerns several stages; each stage's own options are validated by
// themselves.
[[nodiscard]] std::string Validate(const Options& options);

// Looks for the file and what it includes in the directories, in their order.
[[nodiscard]] absl::StatusOr<Options> LoadOptions(
    const std::vector<std::string>& directories, const std::string& basename);

// What places depend on, as text: the key of place files (place_file.h).
[[nodiscard]] std::string FormatPlaceOptions(const PlaceOptions& place,
                                             const MatchOptions& match);

// As Lua that LoadOptions would read.
[[nodiscard]] std::string FormatOptions(const Options& options);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CONFIG_OPTIONS_H_
