// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_REPORT_SESSION_REPORT_H_
#define CARTOGRAPHER_SDF_REPORT_SESSION_REPORT_H_

#include <string>

#include "absl/status/status.h"
#include "cartographer_sdf/apps/merge.h"
#include "cartographer_sdf/report/report_options.h"

namespace cartographer_sdf {

// The page of relocalize --report: both maps overlaid where the query was
// found, or would best fit; the matches, and where they contradict.
[[nodiscard]] absl::Status WriteRelocalizationReport(
    const ReportRequest& request, const Session& map, const Session& query,
    const Localization& result, const ProgressCallback& on_progress);

// The page of merge --report.
[[nodiscard]] absl::Status WriteMergingReport(
    const ReportRequest& request, const MergingResult& result,
    const ProgressCallback& on_progress);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_SESSION_REPORT_H_
