// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_TOOLS_AUDIT_REPORT_H_
#define CARTOGRAPHER_SDF_TOOLS_AUDIT_REPORT_H_

#include <string>

#include "absl/status/status.h"
#include "cartographer_sdf/audit/audit.h"
#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/pbstream/map_file.h"

namespace cartographer_sdf {

// Writes `directory`/index.html: the map before and after, and each group with
// a doubtful constraint, drawn at the constraints' own pose, with its evidence.
// Reads the grids of `input` again.
[[nodiscard]] absl::Status WriteAuditReport(
    const std::string& directory, const std::string& input,
    const Options& options, const Audit& audit,
    const ProgressCallback& on_progress);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_AUDIT_REPORT_H_
