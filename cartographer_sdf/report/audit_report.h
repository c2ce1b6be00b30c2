// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_REPORT_AUDIT_REPORT_H_
#define CARTOGRAPHER_SDF_REPORT_AUDIT_REPORT_H_

#include <string>

#include "absl/status/status.h"
#include "cartographer_sdf/apps/audit.h"
#include "cartographer_sdf/report/map_picture.h"
#include "cartographer_sdf/report/report_options.h"

namespace cartographer_sdf {

// The page of audit --report: the map before and after, and each group with
// a doubtful constraint, drawn at the constraints' own pose, with its evidence.
// Calls the reader once. `input` is the map's name.
[[nodiscard]] absl::Status WriteAuditReport(const ReportRequest& request,
                                            const std::string& input,
                                            const Audit& audit,
                                            const SubmapsReader& read_submaps);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_AUDIT_REPORT_H_
