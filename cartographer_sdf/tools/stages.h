// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What the subcommands that work on maps share.

#ifndef CARTOGRAPHER_SDF_TOOLS_STAGES_H_
#define CARTOGRAPHER_SDF_TOOLS_STAGES_H_

#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/execution/parallel_for.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "cartographer_sdf/report/reports.h"
#include "cartographer_sdf/tools/progress.h"

namespace cartographer_sdf {

// What is to be done to maps, as of the flags.
struct MapTask {
  Options options;
  Executor executor;
  std::set<int> frozen_trajectories;
};

// An error where the configured method verifies nothing.
[[nodiscard]] absl::StatusOr<MapTask> MapTaskOfFlags(
    const std::string& subcommand);

// The map with its places: from the file of --places, if it is given, or
// described, and then left there.
[[nodiscard]] absl::StatusOr<DescribedMap> DescribeMapOfFlags(
    const LoopClosingOptions& options, const std::string& path,
    const Executor& executor, PointClouds point_clouds,
    const ProgressCallback& on_progress);

// Reads --input once: for --output, where it is to have `pose_graph`, and for
// --report, which is made by `write_report`. The map appears last: it stands
// for all having gone well.
[[nodiscard]] absl::Status WriteMapAndReport(
    const PoseGraph& pose_graph,
    const std::function<absl::Status(const SubmapsReader&)>& write_report,
    StageProgress* progress);

// Lines for the standard output: the seconds of stages, whether the last
// optimisation failed, and where --output and --report are.
void PrintStages(const std::vector<std::pair<std::string, double>>& seconds);
void PrintStatuses(const std::string& prefix,
                   const std::vector<Closure>& closures);
void PrintConvergence(const std::vector<OptimizationSummary>& summaries);
void PrintPaths();

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_STAGES_H_
