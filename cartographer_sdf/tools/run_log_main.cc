// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// cartographer_sdf_run_log: runs the searcher without ROS.

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "cartographer_sdf/file/pending_file.h"
#include "cartographer_sdf/live/live_options.h"
#include "cartographer_sdf/live/log_run.h"
#include "cartographer_sdf/recording/carmen_log.h"
#include "cartographer_sdf/tools/flags.h"
#include "cartographer_sdf/tools/host_messages.h"
#include "cartographer_sdf/tools/progress.h"
#include "cartographer_sdf/tools/run_log_report.h"
#include "cartographer_sdf/tools/subcommand.h"
#include "gflags/gflags.h"
#include "glog/logging.h"

DEFINE_string(log, "", "Recording to run, a CARMEN log, plain or gzip.");
DEFINE_string(sdf_configuration_basename, "sdf_live.lua",
              "Name of the searcher's configuration file. If empty, "
              "Cartographer runs alone.");
DEFINE_double(start, 0., "Time to skip at the beginning of the recording [s].");
DEFINE_double(duration, 0., "Time of the recording to use [s]; 0: all of it.");
DEFINE_double(real_time_factor, 0.,
              "Speed relative to real time; 1: real time, 0: as fast as "
              "Cartographer and the searcher can.");
DEFINE_double(
    field_of_view, 0.,
    "Field of view of the laser [degrees]. 0: derived from the number of "
    "beams, 180 for 180, 181 and 360 beams, 270 for others.");
DEFINE_bool(verbose, false, "Whether to show Cartographer's log.");

namespace cartographer_sdf {
namespace {

constexpr char kProgram[] = "cartographer_sdf_run_log";

template <typename T>
std::optional<T> GivenUnless(const T& absent, const T& value) {
  if (value == absent) return std::nullopt;
  return value;
}

absl::StatusOr<LogRunOptions> OptionsOfFlags() {
  if (absl::Status status = CheckConfigurationDirectories(); !status.ok()) {
    return status;
  }
  const std::vector<std::string> directories = ConfigurationDirectories();
  LogRunOptions options;
  options.live.enabled = false;
  if (!FLAGS_sdf_configuration_basename.empty()) {
    const absl::StatusOr<LiveOptions> live =
        LoadLiveOptions(directories, FLAGS_sdf_configuration_basename);
    if (!live.ok()) return live.status();
    options.live = *live;
  }
  const absl::StatusOr<HostOptions> host =
      LoadHostOptions(directories, FLAGS_configuration_basename);
  if (!host.ok()) return host.status();
  options.host = *host;
  options.map_path = GivenUnless(std::string(), FLAGS_map);
  options.output_path = GivenUnless(std::string(), FLAGS_output);
  options.real_time_factor = GivenUnless(0., FLAGS_real_time_factor);
  return options;
}

// The report draws the map from a file: if the user wants none, a temporary
// one.
std::filesystem::path TemporaryMapPath(const pid_t process) {
  return std::filesystem::temp_directory_path() /
         absl::StrCat(kProgram, "-", process, ".pbstream");
}

// Removes those that dead processes left.
void RemoveTemporaryMaps() {
  std::error_code error;
  std::vector<std::filesystem::path> leftovers;
  for (std::filesystem::directory_iterator
           it(std::filesystem::temp_directory_path(), error),
       end;
       !error && it != end; it.increment(error)) {
    const std::string stem = it->path().stem().string();
    pid_t process = 0;
    if (absl::SimpleAtoi(absl::StripPrefix(stem, absl::StrCat(kProgram, "-")),
                         &process) &&
        process > 0 && it->path() == TemporaryMapPath(process) &&
        kill(process, 0) != 0 && errno == ESRCH) {
      leftovers.push_back(it->path());
    }
  }
  for (const std::filesystem::path& path : leftovers) {
    std::filesystem::remove(path, error);
  }
}

CarmenLogOptions LogOptionsOfFlags() {
  CarmenLogOptions options;
  if (FLAGS_field_of_view != 0.) {
    options.field_of_view = FLAGS_field_of_view * M_PI / 180.;
  }
  options.seconds_per_scan = FLAGS_seconds_per_scan;
  return options;
}

absl::Status CheckFlagsOfRunLog() {
  if (!(FLAGS_start >= 0.) || !(FLAGS_duration >= 0.)) {
    return UsageError("--start and --duration must not be negative");
  }
  if (!(FLAGS_real_time_factor >= 0.)) {
    return UsageError("--real_time_factor must not be negative");
  }
  const std::string problem = Validate(LogOptionsOfFlags());
  return problem.empty() ? absl::OkStatus()
                         : UsageError(absl::StrCat("--", problem));
}

absl::StatusOr<Recording> RecordingOfFlags() {
  absl::StatusOr<Recording> recording =
      ReadCarmenLog(FLAGS_log, LogOptionsOfFlags());
  if (!recording.ok()) return recording.status();
  const double duration = FLAGS_duration > 0.
                              ? FLAGS_duration
                              : std::numeric_limits<double>::infinity();
  return Cut(*recording, FLAGS_start, duration);
}

void RecordRun(const LogRunResult& result, RunRecord* const record) {
  record->Count("scans", static_cast<size_t>(result.num_scans));
  record->Count("nodes", result.nodes.size());
  const auto num_in_graph =
      std::count_if(result.closures.begin(), result.closures.end(),
                    [](const ClosureRecord& closure) {
                      return closure.status == ClosureStatus::kInGraph;
                    });
  record->Count("closures", static_cast<size_t>(num_in_graph));
  if (FLAGS_map.empty()) return;
  const auto num_localized = std::count_if(
      result.localizations.begin(), result.localizations.end(),
      [](const LocalizationMoment& moment) { return moment.result.localized; });
  record->Count("localized", static_cast<size_t>(num_localized));
  if (num_localized == 0) {
    record->End(Outcome::kRefused, "the robot was not localized in the map");
  }
}

absl::Status RunAndReport(const Recording& recording,
                          const LogRunOptions& options,
                          RunRecord* const record) {
  absl::StatusOr<LogRunResult> result;
  {
    StageProgress progress(record);
    result = RunLog(recording, options, progress.Begin("run"));
  }
  if (!result.ok()) return result.status();
  RecordRun(*result, record);
  if (!FLAGS_report.empty()) {
    if (absl::Status status =
            WriteRunReport(FLAGS_report, FLAGS_log, *options.output_path,
                           options, *result, record->run);
        !status.ok()) {
      return status;
    }
  }
  std::cout << FormatRunSummary(*result);
  return absl::OkStatus();
}

absl::Status RunLogOfFlags(RunRecord* const record) {
  absl::StatusOr<LogRunOptions> options = OptionsOfFlags();
  if (!options.ok()) return options.status();
  const absl::StatusOr<Recording> recording = RecordingOfFlags();
  if (!recording.ok()) return recording.status();
  if (FLAGS_report.empty() || options->output_path) {
    return RunAndReport(*recording, *options, record);
  }
  RemoveTemporaryMaps();
  options->output_path = TemporaryMapPath(getpid()).string();
  const absl::Status status = RunAndReport(*recording, *options, record);
  std::error_code ignored;
  std::filesystem::remove(*options->output_path, ignored);
  return status;
}

// Long: a description, with all flags.
Subcommand RunLogCommand() {
  Subcommand command{
      "",
      "run a recording through Cartographer and the searcher",
      "--log drive.log.gz --configuration_basename cartographer_mapping.lua "
      "[--map A.pbstream] [--output B.pbstream] [--report DIR]",
      "A stock Cartographer gets the laser scans, odometry and yaw rates of "
      "the log, as from a robot; between sparse scans, odometry and yaw rates "
      "are interpolated. The searcher recognises places and adds constraints; "
      "with --map it localises the robot in a frozen map.\n\n"
      "Prints a summary to the standard output and writes the map to --output. "
      "--report gets index.html to read, and run.json and nodes.csv for "
      "programs.",
      {{"log", FileUse::kRead},
       {"configuration_basename",
        FileUse::kNone,
        {},
        "Name of Cartographer's configuration file; it may include others."}},
      {{"configuration_directory",
        FileUse::kNone,
        {},
        "Directories of configuration files, separated by commas, searched "
        "before those installed with this program and with Cartographer. "
        "--configuration_directories is the same."},
       "sdf_configuration_basename",
       {"map",
        FileUse::kRead,
        {},
        "Frozen map to localise in, a .pbstream. Without it, the robot maps."},
       {"output", FileUse::kWriteMap, {}, "Map to write, a .pbstream."},
       {"report", FileUse::kWriteInto, {"index.html", "run.json", "nodes.csv"}},
       "start",
       "duration",
       "real_time_factor",
       "field_of_view",
       "seconds_per_scan",
       "verbose"},
      &RunLogOfFlags,
      kProgram,
      &CheckFlagsOfRunLog};
  command.positional_flags = {"log"};
  return command;
}

}  // namespace
}  // namespace cartographer_sdf

int main(int argc, char** argv) {
  cartographer_sdf::KeepFreedMemory();
  cartographer_sdf::RemovePendingFilesOnSignals();
  google::InitGoogleLogging(argc > 0 ? argv[0] : cartographer_sdf::kProgram);
  const cartographer_sdf::HostMessages messages(
      cartographer_sdf::kProgram, [](const google::LogSeverity severity) {
        return severity >= google::GLOG_ERROR || FLAGS_verbose;
      });
  return cartographer_sdf::RunSubcommand(
      cartographer_sdf::RunLogCommand(),
      std::vector<std::string>(argv + (argc > 0 ? 1 : 0), argv + argc));
}
