// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Runs a recording through a stock Cartographer, with or without the searcher,
// as on a robot, and measures wall and CPU time.

#ifndef CARTOGRAPHER_SDF_LIVE_LOG_RUN_H_
#define CARTOGRAPHER_SDF_LIVE_LOG_RUN_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer/common/time.h"
#include "cartographer/mapping/proto/map_builder_options.pb.h"
#include "cartographer/mapping/proto/trajectory_builder_options.pb.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/live/live_options.h"
#include "cartographer_sdf/live/map_builder.h"
#include "cartographer_sdf/recording/recording.h"

namespace cartographer_sdf {

struct HostOptions {
  cartographer::mapping::proto::MapBuilderOptions map_builder;
  cartographer::mapping::proto::TrajectoryBuilderOptions trajectory_builder;
};

// Loads Cartographer's own options: the tables map_builder and
// trajectory_builder of the returned table, as in a file of cartographer_ros,
// whose other keys are skipped. The file and its includes are searched for in
// the directories, then where Cartographer is installed.
//
// Cartographer's reader does not return errors: a missing file or any problem
// inside one is LOG(FATAL). Only options for 3D are an error here.
[[nodiscard]] absl::StatusOr<HostOptions> LoadHostOptions(
    const std::vector<std::string>& directories, const std::string& basename);

// Seconds of Unix time.
[[nodiscard]] double FromHostTime(cartographer::common::Time time);

struct LogRunOptions {
  HostOptions host;
  // `enabled` false: Cartographer alone.
  LiveOptions live;
  // A frozen map to localise in.
  std::optional<std::string> map_path;
  // Path of the final map, with all trajectories.
  std::optional<std::string> output_path;
  // Seconds of the recording per second of wall time. None: as fast as
  // Cartographer and the searcher can; the run does not wait for Cartographer's
  // own loop search, whose progress cannot be queried.
  std::optional<double> real_time_factor;
};
[[nodiscard]] std::string Validate(const LogRunOptions& options);

// State at the time when a node was created.
struct NodeMoment {
  int node_index = 0;
  // Time of the scan on the recording's clock [s].
  double time = 0.;
  // Odometry path length since the first scan [m].
  double distance = 0.;
  Rigid2 T_map_tracking;
  // Whether constraints connect the trajectory to the frozen map by now; always
  // false without a map.
  bool is_connected = false;
  // CPU time of the whole process since the first scan [s].
  double cpu_seconds = 0.;
};

// Result of a search; if the trajectory was not localised, `result.reason` says
// why.
struct LocalizationMoment {
  LocalizationResult result;
  double time = 0.;
  double distance = 0.;
  double cpu_seconds = 0.;
};

struct LogRunResult {
  int trajectory_id = 0;
  std::vector<NodeMoment> nodes;
  // In the order of arrival. Empty without a map or a searcher.
  std::vector<LocalizationMoment> localizations;
  // None without a searcher.
  std::optional<LiveSummary> summary;
  std::vector<ClosureRecord> closures;
  int num_scans = 0;
  // Duration of each call of AddSensorData, for any sensor [s].
  std::vector<double> sensor_seconds;
  // Duration [s] and distance [m] of the recording.
  double duration = 0.;
  double distance = 0.;
  // Time until the last scan, and time of everything after it: waiting for the
  // searcher and Cartographer's queue, and the final optimisation. CPU time is
  // that of the whole process [s].
  double wall_seconds = 0.;
  double cpu_seconds = 0.;
  double final_wall_seconds = 0.;
  double final_cpu_seconds = 0.;
  // Largest delay in feeding a scan, with a real_time_factor [s].
  double max_delay_seconds = 0.;
};

// `on_progress` is called with fractions of the recording.
[[nodiscard]] absl::StatusOr<LogRunResult> RunLog(
    const Recording& recording, const LogRunOptions& options,
    const std::function<void(double)>& on_progress);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_LOG_RUN_H_
