// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Stages that the subcommands on maps share.

#ifndef CARTOGRAPHER_SDF_TOOLS_STAGES_H_
#define CARTOGRAPHER_SDF_TOOLS_STAGES_H_

#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_sdf/closing/pipeline.h"
#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/pose_graph/slips.h"
#include "cartographer_sdf/report/reports.h"
#include "cartographer_sdf/tools/progress.h"
#include "cartographer_sdf/tools/run_record.h"

namespace cartographer_sdf {

// What the flags specify for a task on maps.
struct MapTask {
  Options options;
  Executor executor;
  std::set<int> frozen_trajectories;
};

// An error if the configured method does not verify matches.
[[nodiscard]] absl::StatusOr<MapTask> MapTaskOfFlags(
    const std::string& subcommand);

// Returns the map with its places. Reads them from the file at `places_path`,
// unless it is empty, if that fits; otherwise describes them, writes the file,
// and records a warning if there was one.
[[nodiscard]] absl::StatusOr<DescribedMap> DescribeOrRemember(
    const LoopClosingOptions& options, const MapSource& source,
    const std::string& places_path, const Executor& executor,
    PointClouds point_clouds, const ProgressCallback& on_progress,
    RunRecord* record);

// Describes maps with their point clouds: each of `maps` with the file of
// --places in its turn, or without one. The arguments must outlive it.
[[nodiscard]] MapDescriber DescriberOfFlags(
    const MapTask& task, const std::vector<std::string>& maps,
    RunRecord* record);

// An error if --picture_pixels is no size.
[[nodiscard]] absl::Status CheckPictureFlags();

// Reads --input once, for --output, which gets `pose_graph`, for --report,
// which `write_report` makes, and for --picture. Writes the map last, so that
// its existence shows that everything succeeded. `state` is that of the input.
[[nodiscard]] absl::Status WriteMapAndReport(
    const MapState& state, const PoseGraph& pose_graph,
    const std::function<absl::Status(const SubmapsReader&)>& write_report,
    StageProgress* progress);

// How many closures have each status, by name.
[[nodiscard]] std::map<std::string, int> CountStatuses(
    const std::vector<Closure>& closures);

void RecordTornSubmaps(const std::map<SubmapId, Tear>& torn_submaps,
                       RunRecord* record);
void RecordSlips(const Slips& slips, const PoseGraph& pose_graph,
                 RunRecord* record);

// These print the durations of stages, the statuses of closures, a failure of
// the last optimisation, and the paths of --output and --report.
void PrintStages(const std::vector<std::pair<std::string, double>>& seconds);
void PrintStatuses(const std::string& prefix,
                   const std::vector<Closure>& closures);
void PrintConvergence(const std::vector<OptimizationSummary>& summaries);
void PrintPaths();

// For a task that has written a map: prints and records how far Cartographer,
// with the weights of `closing.optimization`, would move it; nothing if that is
// little. `in_force` are those with which the map was optimised.
void WarnOfHostMotion(const ClosingOptions& closing,
                      const OptimizationOptions& in_force,
                      const PoseGraph& pose_graph, RunRecord* record);

// An error if --drop_odometry is given, but no map is written.
[[nodiscard]] absl::Status CheckDropOdometry();

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_STAGES_H_
