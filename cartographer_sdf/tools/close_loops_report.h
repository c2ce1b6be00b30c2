// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_TOOLS_CLOSE_LOOPS_REPORT_H_
#define CARTOGRAPHER_SDF_TOOLS_CLOSE_LOOPS_REPORT_H_

#include <string>

#include "absl/status/status.h"
#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/loop_closing/loop_closing.h"

namespace cartographer_sdf {

// Writes `directory`/index.html: the map before and after, every closure with
// its evidence, residuals, and the time that the stages took. Reads the grids
// of `input` again.
[[nodiscard]] absl::Status WriteCloseLoopsReport(
    const std::string& directory, const std::string& input,
    const Options& options, const LoopClosingResult& result,
    const ProgressCallback& on_progress);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_CLOSE_LOOPS_REPORT_H_
