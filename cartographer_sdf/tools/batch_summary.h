// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What `batch` says about all its maps: a table, JSON, and a page.

#ifndef CARTOGRAPHER_SDF_TOOLS_BATCH_SUMMARY_H_
#define CARTOGRAPHER_SDF_TOOLS_BATCH_SUMMARY_H_

#include <string>
#include <vector>

#include "cartographer_sdf/report/json.h"
#include "cartographer_sdf/tools/batch_jobs.h"

namespace cartographer_sdf {

struct BatchRow {
  BatchJob job;
  // That of the job's result, or "lost" where it left none: it was killed, or
  // has not run.
  std::string status;
  int exit_code = 0;  // 0 where it is lost
  std::string message;
  std::vector<std::pair<std::string, int64_t>> counts;
  std::vector<std::string> warnings;  // codes
  std::string sha256;                 // of the map that was read
  double seconds = 0.;
  int64_t peak_memory_bytes = 0;

  [[nodiscard]] bool has_failed() const {
    return status == "failed" || status == "lost" || status == "wrong_usage";
  }
};

// Of what the job left.
[[nodiscard]] BatchRow MakeRow(const BatchJob& job);

// Columns name, input, status, exit_code, message, one for each count that a
// row has, warnings, seconds, peak_memory_bytes, output, sha256.
[[nodiscard]] std::string FormatSummaryCsv(const std::vector<BatchRow>& rows);
[[nodiscard]] Json SummaryJson(const std::vector<BatchRow>& rows);
// One file with all pictures; failures come first, by themselves.
[[nodiscard]] std::string FormatSummaryPage(const std::vector<BatchRow>& rows);
// The paths of the maps that failed, one a line.
[[nodiscard]] std::string FormatFailures(const std::vector<BatchRow>& rows);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_BATCH_SUMMARY_H_
