// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The jobs of `batch`: one map each, in a process of its own, with a result
// file that tells how it ended.

#ifndef CARTOGRAPHER_SDF_TOOLS_BATCH_JOBS_H_
#define CARTOGRAPHER_SDF_TOOLS_BATCH_JOBS_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/report/json.h"

namespace cartographer_sdf {

// Paths are absolute.
struct BatchJob {
  std::string name;  // unique, also as the stem of files
  std::string input;
  std::vector<std::string> arguments;  // from the subcommand on
  std::string result;
  std::string log;  // what it prints
  // Empty where it writes none.
  std::string output;
  std::string picture;
};

struct BatchSettings {
  std::string directory;
  std::string subcommand;               // "close_loops" or "audit"
  std::vector<std::string> more_flags;  // for every job
  bool writes_reports = false;
};

// One job for each map, in their order, none twice. Maps of the same file name
// get a part of the checksum of their path, so that names do not depend on
// other maps.
[[nodiscard]] std::vector<BatchJob> MakeJobs(
    const BatchSettings& settings, const std::vector<std::string>& maps);

// Makes the directories that the jobs write to.
[[nodiscard]] absl::Status MakeDirectories(const BatchSettings& settings);

// The list of all jobs, which the summary is made of: batch.json.
[[nodiscard]] std::string FormatJobs(const std::vector<BatchJob>& jobs);
[[nodiscard]] absl::StatusOr<std::vector<BatchJob>> ReadJobs(
    const std::string& path);

// What a job left in its result file; none if there is none.
[[nodiscard]] std::optional<Json> ReadResult(const BatchJob& job);

// Whether its result is that of the same program, arguments and map, and no
// failure.
[[nodiscard]] bool IsFinished(const BatchJob& job);

// A line for a POSIX shell.
[[nodiscard]] std::string ShellCommand(const std::string& program,
                                       const BatchJob& job);

// Runs the jobs, up to `num_processes` at a time, and waits for them. They end
// when this process does. Calls back with the number of ended jobs.
[[nodiscard]] absl::Status RunJobs(const std::string& program,
                                   const std::vector<const BatchJob*>& jobs,
                                   int num_processes,
                                   const std::function<void(size_t)>& on_ended);

// The file of this program.
[[nodiscard]] std::string ThisProgram();

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_BATCH_JOBS_H_
