// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The main task: finds the loop closures of a saved map by the appearance of
// its submaps, and optimises the pose graph with a mutually consistent set of
// them.

#ifndef CARTOGRAPHER_SDF_APPS_CLOSE_LOOPS_H_
#define CARTOGRAPHER_SDF_APPS_CLOSE_LOOPS_H_

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/closing/pipeline.h"
#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/execution/stage_clock.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "cartographer_sdf/recognition/recognize.h"

namespace cartographer_sdf {

struct LoopClosingOptions {
  PlaceOptions place;
  RecognitionOptions recognition;
  ClosingOptions closing;
};
[[nodiscard]] std::string Validate(const LoopClosingOptions& options);

struct LoopClosingResult {
  MapState state;  // as read
  size_t num_places = 0;
  size_t num_matches = 0;  // verified poses, accepted or not
  // Of these, what verification refused.
  std::vector<Match> refused;
  ClosedGraph closed;
  // The options in force, odometry weights as inferred.
  OptimizationOptions optimization;
  std::vector<std::pair<std::string, double>> stage_seconds;
};

// "the map is unchanged", or that it was optimised without its odometry.
[[nodiscard]] std::string DescribeWithoutClosures(
    const LoopClosingResult& result);

// A map whose odometry is dropped is optimised even if no closure is found:
// odometry has shaped it, and Cartographer would move it without.
//
// Fails if the file cannot be read or lacks one of the frozen trajectories,
// which stay fixed. The recognition's method must be kSdf. `describe`, if
// given, describes the map in place of DescribeMap.
[[nodiscard]] absl::StatusOr<LoopClosingResult> CloseLoops(
    const LoopClosingOptions& options, const MapSource& source,
    const std::set<int>& frozen_trajectories, const Executor& executor,
    const StageCallback& on_stage = {}, const MapDescriber& describe = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_APPS_CLOSE_LOOPS_H_
