// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/tools/flags.h"

#include <algorithm>
#include <filesystem>
#include <thread>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "cartographer_sdf/tools/subcommand.h"

DEFINE_string(input, "", "Map to read, a .pbstream of Cartographer 2D.");
DEFINE_string(map, "", "Map to search in, a .pbstream.");
DEFINE_string(query, "",
              "Second map, whose submaps are searched for in the first.");
DEFINE_string(output, "", "File to write.");
DEFINE_string(places, "",
              "File that caches the descriptions of the submaps of the map, or "
              "with --scan its panoramas, so that later runs start faster. "
              "Written if it is missing or was made for another map or other "
              "options.");
DEFINE_string(truth, "",
              "File of true poses, with lines of "
              "kind,trajectory,index,x,y,yaw [m, rad].");
DEFINE_string(report, "",
              "Directory for an HTML report (index.html), made if it is "
              "missing. No report if empty.");
DEFINE_string(configuration_directory, "",
              "Directories of configuration files, separated by commas, "
              "searched before those installed with the program. "
              "--configuration_directories is the same.");
DEFINE_string(configuration_basename, "sdf_global_constraints.lua",
              "Name of the configuration file; it may include others.");
DEFINE_string(frozen_trajectories, "",
              "Numbers of the trajectories that optimisation must not move, "
              "separated by commas.");
DEFINE_double(seconds_per_scan, 0.1,
              "Time between scans of a recording without a clock [s]: scan i "
              "has the time stamp 1e9 + i * this in the map.");
DEFINE_int32(threads, 0,
             "Number of threads; 0: as many as the machine supports. The "
             "result does not depend on it.");

namespace cartographer_sdf {
namespace {

constexpr int kMaxThreads = 1024;

std::vector<std::string> GivenDirectories() {
  return SplitPaths(FLAGS_configuration_directory);
}

}  // namespace

std::vector<std::string> ConfigurationDirectories() {
  std::vector<std::string> directories = GivenDirectories();
  // Empty in packages, which are made elsewhere.
  const std::string source = CARTOGRAPHER_SDF_SOURCE_CONFIGURATION_DIRECTORY;
  if (!source.empty()) directories.push_back(source);
  std::error_code error;
  const std::filesystem::path program =
      std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) {
    // Wherever an installation was moved to.
    directories.push_back((program.parent_path().parent_path() /
                           CARTOGRAPHER_SDF_CONFIGURATION_BELOW_PREFIX)
                              .string());
  }
  directories.push_back(CARTOGRAPHER_SDF_INSTALLED_CONFIGURATION_DIRECTORY);
  return directories;
}

absl::StatusOr<Options> LoadOptionsOfFlags() {
  if (absl::Status status = CheckConfigurationDirectories(); !status.ok()) {
    return status;
  }
  return LoadOptions(ConfigurationDirectories(), FLAGS_configuration_basename);
}

absl::Status CheckConfigurationDirectories() {
  // Otherwise a misspelt directory would silently yield the defaults.
  for (const std::string& directory : GivenDirectories()) {
    std::error_code ignored;
    if (!std::filesystem::is_directory(directory, ignored)) {
      return absl::NotFoundError(absl::StrCat("--configuration_directory ",
                                              directory, " is no directory"));
    }
  }
  return absl::OkStatus();
}

ReportRequest ReportRequestOfFlags(const Options& options,
                                   const RunDescription& run) {
  return {FLAGS_report, options.report, FormatOptions(options),
          ChangedOptions(options), run};
}

absl::StatusOr<int> NumThreadsOfFlags() {
  if (FLAGS_threads < 0 || FLAGS_threads > kMaxThreads) {
    return UsageError(absl::StrCat("--threads must be from 0 to ", kMaxThreads,
                                   ", it is ", FLAGS_threads));
  }
  if (FLAGS_threads > 0) return FLAGS_threads;
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1,
                    kMaxThreads);
}

absl::StatusOr<std::set<int>> FrozenTrajectoriesOfFlags() {
  std::set<int> trajectories;
  for (const absl::string_view text :
       absl::StrSplit(FLAGS_frozen_trajectories, ',', absl::SkipEmpty())) {
    int trajectory = -1;
    if (!absl::SimpleAtoi(text, &trajectory) || trajectory < 0) {
      return UsageError(
          absl::StrCat("--frozen_trajectories: ", text, " is no trajectory"));
    }
    trajectories.insert(trajectory);
  }
  return trajectories;
}

}  // namespace cartographer_sdf
