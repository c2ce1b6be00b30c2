// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_REPORT_CLOSE_LOOPS_REPORT_H_
#define CARTOGRAPHER_SDF_REPORT_CLOSE_LOOPS_REPORT_H_

#include <string>

#include "absl/status/status.h"
#include "cartographer_sdf/apps/close_loops.h"
#include "cartographer_sdf/report/map_picture.h"
#include "cartographer_sdf/report/report_options.h"

namespace cartographer_sdf {

// The page of close_loops --report: the map before and after, every closure
// with its evidence, residuals, and the time that the stages took. Calls the
// reader once. `input` is the map's name.
[[nodiscard]] absl::Status WriteCloseLoopsReport(
    const ReportRequest& request, const std::string& input,
    const LoopClosingResult& result, const SubmapsReader& read_submaps);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_CLOSE_LOOPS_REPORT_H_
