// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A recording goes through a stock Cartographer, with the searcher around it or
// without: as a robot would have lived it, and with the time and the CPU time
// that it takes.

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

// Cartographer's own options: the tables map_builder and trajectory_builder of
// what the file returns, as in a file of cartographer_ros, whose other keys are
// passed over. It and what it includes is looked for in the directories, then
// where Cartographer is installed.
//
// Cartographer's reader knows no errors: a missing file and whatever is wrong
// inside of one is LOG(FATAL). Only options for 3D are an error here.
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
  // Where the map goes in the end, all trajectories together.
  std::optional<std::string> output_path;
  // How many seconds of the recording pass in one. None: as fast as
  // Cartographer and the searcher can; Cartographer's own loop search is not
  // waited for, as it cannot be asked.
  std::optional<double> real_time_factor;
};
[[nodiscard]] std::string Validate(const LogRunOptions& options);

// What was believed when a node was made.
struct NodeMoment {
  int node_index = 0;
  // The scan's, of the recording's clock [s].
  double time = 0.;
  // Along the odometry, since the first scan [m].
  double distance = 0.;
  Rigid2 T_map_tracking;
  // Whether a constraint binds the trajectory to the frozen map by now; without
  // a map always false.
  bool is_connected = false;
  // Of the whole process, since the first scan [s].
  double cpu_seconds = 0.;
};

// When the searcher localised the trajectory; `result.reason` says why it did
// not.
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
  // What each call of AddSensorData took, of any sensor [s].
  std::vector<double> sensor_seconds;
  // Of the recording [s], [m].
  double duration = 0.;
  double distance = 0.;
  // Until the last scan, and for all that came after: waiting for the searcher
  // and Cartographer's queue, and the final optimisation. CPU time is that of
  // the whole process [s].
  double wall_seconds = 0.;
  double cpu_seconds = 0.;
  double final_wall_seconds = 0.;
  double final_cpu_seconds = 0.;
  // How late a scan was fed at most, where there is a real_time_factor [s].
  double max_delay_seconds = 0.;
};

// `on_progress` is called with fractions of the recording.
[[nodiscard]] absl::StatusOr<LogRunResult> RunLog(
    const Recording& recording, const LogRunOptions& options,
    const std::function<void(double)>& on_progress);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_LOG_RUN_H_
