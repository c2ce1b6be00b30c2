// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The file of --result: JSON with the same members for every subcommand, before
// those of its own. docs/result.schema.json describes it.

#ifndef CARTOGRAPHER_SDF_TOOLS_RESULT_FILE_H_
#define CARTOGRAPHER_SDF_TOOLS_RESULT_FILE_H_

#include <chrono>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_sdf/tools/run_record.h"
#include "cartographer_sdf/tools/subcommand.h"

namespace cartographer_sdf {

constexpr char kResultSchema[] = "cartographer_sdf.result";
// Changes when a member changes its meaning or disappears, not when one is
// added.
constexpr int kResultSchemaVersion = 1;

// How a run ended.
struct RunEnd {
  absl::Status status;
  ExitCode exit_code = ExitCode::kDone;
};

// What is known before the run, its inputs aside.
[[nodiscard]] RunDescription DescribeRun(
    const Subcommand& subcommand, const std::vector<std::string>& arguments);

// Before the run, which may replace its input: computes the checksums, where
// --result or --report tells of them.
[[nodiscard]] absl::Status DescribeInputs(const Subcommand& subcommand,
                                          RunDescription* run);

// Writes the file after the run. Does nothing without --result.
class ResultFile {
 public:
  // When the run begins; the file of --result may be written.
  explicit ResultFile(const Subcommand& subcommand);
  [[nodiscard]] absl::Status Write(const RunRecord& record,
                                   const RunEnd& end) const;

 private:
  const Subcommand& subcommand_;
  const std::chrono::steady_clock::time_point begin_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_RESULT_FILE_H_
