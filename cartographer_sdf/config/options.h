// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// All options of the program, and their keys in SDF_GLOBAL_CONSTRAINTS.

#ifndef CARTOGRAPHER_SDF_CONFIG_OPTIONS_H_
#define CARTOGRAPHER_SDF_CONFIG_OPTIONS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/apps/audit.h"
#include "cartographer_sdf/apps/close_loops.h"
#include "cartographer_sdf/apps/fold_check.h"
#include "cartographer_sdf/apps/session_links.h"
#include "cartographer_sdf/localization/localizer.h"
#include "cartographer_sdf/localization/scan_localizer.h"
#include "cartographer_sdf/localization/scan_places.h"
#include "cartographer_sdf/localization/scan_session.h"
#include "cartographer_sdf/report/report_options.h"

namespace cartographer_sdf {

// The name of the table in the configuration files.
constexpr char kOptionsTable[] = "SDF_GLOBAL_CONSTRAINTS";

struct Options {
  LoopClosingOptions loop_closing;
  LocalizationOptions localization;
  ScanPlaceOptions scan_places;
  ScanLocalizationOptions scan_localization;
  ScanSessionOptions scan_session;
  SessionLinkOptions session_links;
  FoldCheckOptions fold_check;
  AuditOptions audit;
  ReportOptions report;
};

// Checks options that concern several stages; each stage's own options are
// validated separately.
[[nodiscard]] std::string Validate(const Options& options);

// Looks for the file and the files it includes in the directories, in order.
[[nodiscard]] absl::StatusOr<Options> LoadOptions(
    const std::vector<std::string>& directories, const std::string& basename);

// The options that places depend on, as text: the key of place files
// (place_file.h).
[[nodiscard]] std::string FormatPlaceOptions(PlaceOptions place,
                                             const MatchOptions& match);

// As Lua that LoadOptions would read.
[[nodiscard]] std::string FormatOptions(const Options& options);

// Those that differ from their defaults.
[[nodiscard]] std::vector<ChangedOption> ChangedOptions(const Options& options);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CONFIG_OPTIONS_H_
