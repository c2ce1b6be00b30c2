// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Flags that several subcommands share, and their interpretation.

#ifndef CARTOGRAPHER_SDF_TOOLS_FLAGS_H_
#define CARTOGRAPHER_SDF_TOOLS_FLAGS_H_

#include <set>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/config/options.h"
#include "gflags/gflags.h"

DECLARE_string(input);
DECLARE_string(map);
DECLARE_string(query);
DECLARE_string(output);
DECLARE_string(places);
DECLARE_string(truth);
DECLARE_string(report);
DECLARE_string(result);
DECLARE_string(fail_on);
DECLARE_string(configuration_directory);
DECLARE_string(configuration_basename);
DECLARE_string(frozen_trajectories);
DECLARE_double(seconds_per_scan);
DECLARE_int32(threads);

namespace cartographer_sdf {

// Directories to search for configuration files: first those of
// --configuration_directory, then those where the program was built, is, and
// was installed.
[[nodiscard]] std::vector<std::string> ConfigurationDirectories();

// An error if a directory of --configuration_directory does not exist.
[[nodiscard]] absl::Status CheckConfigurationDirectories();

// From --configuration_directory and --configuration_basename.
[[nodiscard]] absl::StatusOr<Options> LoadOptionsOfFlags();

// From --report.
[[nodiscard]] ReportRequest ReportRequestOfFlags(const Options& options,
                                                 const RunDescription& run);

// From --threads; at least 1.
[[nodiscard]] absl::StatusOr<int> NumThreadsOfFlags();

// From --frozen_trajectories.
[[nodiscard]] absl::StatusOr<std::set<int>> FrozenTrajectoriesOfFlags();

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_FLAGS_H_
