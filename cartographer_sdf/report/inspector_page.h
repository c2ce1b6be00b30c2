// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// One self-contained HTML page that shows an inspection: nothing from the
// network, so that it can be mailed, archived and printed. Without JavaScript
// it still shows the verdict, all numbers and the maps. All texts are escaped.

#ifndef CARTOGRAPHER_SDF_REPORT_INSPECTOR_PAGE_H_
#define CARTOGRAPHER_SDF_REPORT_INSPECTOR_PAGE_H_

#include <string>

#include "absl/status/status.h"
#include "cartographer_sdf/report/inspection.h"
#include "cartographer_sdf/report/report_options.h"

namespace cartographer_sdf {

[[nodiscard]] std::string RenderInspector(const ReportRequest& request,
                                          const Inspection& inspection);

// Writes index.html into the directory of the request, which is made if it is
// missing.
[[nodiscard]] absl::Status WriteInspector(const ReportRequest& request,
                                          const Inspection& inspection);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_INSPECTOR_PAGE_H_
