// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Several maps of one building, saved at different times, as one map.

#ifndef CARTOGRAPHER_SDF_APPS_MERGE_H_
#define CARTOGRAPHER_SDF_APPS_MERGE_H_

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/apps/close_loops.h"
#include "cartographer_sdf/apps/fold_check.h"
#include "cartographer_sdf/apps/session.h"
#include "cartographer_sdf/pbstream/joined_map_file.h"

namespace cartographer_sdf {

// What is known of two sessions: where the second lies in the first.
struct SessionLink {
  size_t first = 0;  // indices of sessions, first < second
  size_t second = 0;
  Localization localization;
};

struct MergedSession {
  std::string path;
  // The group of sessions that are connected, by the lowest index in it.
  size_t group = 0;
  // Where it was laid before the optimisation; none of those that are not in
  // the merged map.
  std::optional<Rigid2> T_merged_session;
};

struct MergingResult {
  std::vector<MergedSession> sessions;  // all, in the order given
  std::vector<SessionLink> links;       // all pairs
  // Of those that are in the merged map, with their new numbers.
  std::vector<MapPart> parts;
  // As read, under the new numbers; places that are made of scans are submaps
  // here.
  MapState state;
  // Its pose graph is of the submaps of the files alone, and so for
  // WriteJoinedMap.
  ClosedGraph closed;
  // Pairs of submaps that the merged map lays over each other: how many, and
  // those that contradict each other there.
  int num_overlapping = 0;
  std::vector<Match> contradictions;
  // Why there is no merged map; else empty. The rest is then as far as it went.
  std::string refusal;
  std::vector<std::pair<std::string, double>> stage_seconds;
};

// Finds the links between all sessions and the closures within each, and joins
// what is connected: the largest group, of equally large ones the first. The
// frame is that of the first session in it. Frozen trajectories, by their
// numbers in the order of all sessions' trajectories, stay where they are; they
// must all be of that first session. Fails where a file can't be read.
[[nodiscard]] absl::StatusOr<MergingResult> MergeSessions(
    const FoldCheckOptions& options, const LocalizationOptions& localization,
    const ScanPlaceOptions& scan_places, const LoopClosingOptions& stages,
    const std::vector<std::string>& paths,
    const std::set<int>& frozen_trajectories, const Executor& executor,
    const StageCallback& on_stage = {});

// Attaches a query to a map in which it was localized: every trajectory of the
// map stays where it is, and no closures within either are sought. Fails where
// the two are one file.
[[nodiscard]] absl::StatusOr<MergingResult> AttachQuery(
    const FoldCheckOptions& options, const LoopClosingOptions& stages,
    const Session& map, const Session& query, const Localization& localization,
    const Executor& executor, const StageCallback& on_stage = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_APPS_MERGE_H_
