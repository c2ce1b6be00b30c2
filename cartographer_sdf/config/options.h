// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// All options of the program, and the one place that says under which keys of
// SDF_GLOBAL_CONSTRAINTS they are found.

#ifndef CARTOGRAPHER_SDF_CONFIG_OPTIONS_H_
#define CARTOGRAPHER_SDF_CONFIG_OPTIONS_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/audit/audit.h"
#include "cartographer_sdf/evaluation/shape_context.h"
#include "cartographer_sdf/loop_closing/loop_closing.h"
#include "cartographer_sdf/report/report_options.h"
#include "cartographer_sdf/sessions/merging.h"
#include "cartographer_sdf/sessions/relocalization.h"

namespace cartographer_sdf {

struct Options {
  LoopClosingOptions loop_closing;
  // The comparison method's description of submaps, `--method shape_context`.
  CloudPlaceOptions shape_context;
  RelocalizationOptions relocalization;
  MergingOptions merging;
  AuditOptions audit;
  ReportOptions report;
};

// Of what concerns several stages; each stage's own options are validated by
// themselves.
[[nodiscard]] std::string Validate(const Options& options);

// Looks for the file and what it includes in the directories, in their order.
[[nodiscard]] absl::StatusOr<Options> LoadOptions(
    const std::vector<std::string>& directories, const std::string& basename);

// As Lua that LoadOptions would read.
[[nodiscard]] std::string FormatOptions(const Options& options);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CONFIG_OPTIONS_H_
