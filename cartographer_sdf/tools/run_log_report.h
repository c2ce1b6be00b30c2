// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_TOOLS_RUN_LOG_REPORT_H_
#define CARTOGRAPHER_SDF_TOOLS_RUN_LOG_REPORT_H_

#include <string>

#include "absl/status/status.h"
#include "cartographer_sdf/live/log_run.h"
#include "cartographer_sdf/report/run_description.h"

namespace cartographer_sdf {

// A few lines for a terminal.
[[nodiscard]] std::string FormatRunSummary(const LogRunResult& result);

// `directory` gets
// - run.json: all numbers, see docs/live.md;
// - nodes.csv: the pose estimate when each node was made;
// - index.html: the final map with closures, and charts. Reads the grids of
//   `map`, the final map. `run` is what the page says of the program.
[[nodiscard]] absl::Status WriteRunReport(const std::string& directory,
                                          const std::string& log,
                                          const std::string& map,
                                          const LogRunOptions& options,
                                          const LogRunResult& result,
                                          const RunDescription& run);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_RUN_LOG_REPORT_H_
