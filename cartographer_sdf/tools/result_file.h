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

// Collects what is known before the run, and writes the file after it. Does
// nothing without --result.
class ResultFile {
 public:
  // The flags are set, and the file of --result may be written.
  ResultFile(const Subcommand& subcommand,
             const std::vector<std::string>& arguments);
  // Before the run, which may replace its input: computes the checksums.
  [[nodiscard]] absl::Status RecordInputs();
  [[nodiscard]] absl::Status Write(const RunRecord& record,
                                   const RunEnd& end) const;

 private:
  const Subcommand& subcommand_;
  const std::vector<std::string>& arguments_;
  const std::chrono::steady_clock::time_point begin_;
  const std::chrono::system_clock::time_point started_;
  Json inputs_ = Json::array();
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_RESULT_FILE_H_
