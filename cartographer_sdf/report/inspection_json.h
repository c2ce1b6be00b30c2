// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The document of an inspection, which its page carries and shows:
// docs/inspection.schema.json. It shares its vocabulary with the file of
// --result. Not installed, as json.h.

#ifndef CARTOGRAPHER_SDF_REPORT_INSPECTION_JSON_H_
#define CARTOGRAPHER_SDF_REPORT_INSPECTION_JSON_H_

#include "cartographer_sdf/report/inspection.h"
#include "cartographer_sdf/report/json.h"
#include "cartographer_sdf/report/report_options.h"

namespace cartographer_sdf {

constexpr char kInspectionSchema[] = "cartographer_sdf.inspection";
// Changes when a member changes its meaning or disappears, not when one is
// added.
constexpr int kInspectionSchemaVersion = 1;

[[nodiscard]] Json ToJson(const ReportRequest& request,
                          const Inspection& inspection);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_INSPECTION_JSON_H_
