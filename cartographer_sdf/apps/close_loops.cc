// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/close_loops.h"

#include <algorithm>
#include <iterator>

#include "glog/logging.h"

namespace cartographer_sdf {

namespace {

// If odometry was dropped and no closure was found. Odometry has shaped the
// map, and Cartographer would move it without.
void OptimizeWithoutOdometry(const std::set<int>& frozen_trajectories,
                             StageClock* const clock,
                             LoopClosingResult* const result) {
  ClosedGraph& closed = result->closed;
  if (!closed.optimizations.empty() ||
      result->state.num_dropped_odometry_records == 0) {
    return;
  }
  clock->Begin("optimise without odometry");
  closed.optimizations.push_back(
      Optimize(result->optimization, frozen_trajectories, &closed.pose_graph));
}

}  // namespace

std::string Validate(const LoopClosingOptions& options) {
  for (const std::string& error :
       {Validate(options.place), Validate(options.recognition),
        Validate(options.closing)}) {
    if (!error.empty()) return error;
  }
  return "";
}

std::string DescribeWithoutClosures(const LoopClosingResult& result) {
  return result.closed.optimizations.empty()
             ? "the map is unchanged"
             : "the map was optimised without its odometry";
}

absl::StatusOr<LoopClosingResult> CloseLoops(
    const LoopClosingOptions& options, const MapSource& source,
    const std::set<int>& frozen_trajectories, const Executor& executor,
    const StageCallback& on_stage, const MapDescriber& describe) {
  CHECK_EQ(Validate(options), "");
  CHECK(options.recognition.match.method == Method::kSdf)
      << "the paper's method verifies nothing";
  absl::Status status = CheckHasTrajectories(source.path, frozen_trajectories);
  if (!status.ok()) return status;
  LoopClosingResult result;
  StageClock clock(on_stage, &result.stage_seconds);
  const ProgressCallback on_progress = clock.Begin("read and describe");
  absl::StatusOr<DescribedMap> map =
      describe ? describe(source, on_progress)
               : DescribeMap(options.place, options.recognition.match, source,
                             executor, on_progress, PointClouds::kKeep);
  if (!map.ok()) return map.status();
  result.num_places = map->places.size();
  std::vector<Match> matches = RecognizeWithin(
      options.recognition, map->trajectory_places(), executor, &clock);
  result.num_matches = matches.size();
  std::copy_if(matches.begin(), matches.end(),
               std::back_inserter(result.refused),
               [](const Match& match) { return !IsLikely(match.verdict); });
  ClosingOptions closing = options.closing;
  closing.optimization = OptimizationInForce(closing, map->state.pose_graph);
  result.optimization = closing.optimization;
  result.closed =
      CloseGraph(closing,
                 {&map->state.pose_graph, &map->odometry, &map->places,
                  &map->point_clouds},
                 std::move(matches), frozen_trajectories, executor, &clock);
  result.state = std::move(map->state);
  OptimizeWithoutOdometry(frozen_trajectories, &clock, &result);
  clock.End();
  return result;
}

}  // namespace cartographer_sdf
