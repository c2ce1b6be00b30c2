// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Merges several maps of one building, saved at different times, into one.

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
#include "cartographer_sdf/apps/session_links.h"
#include "cartographer_sdf/pbstream/joined_map_file.h"

namespace cartographer_sdf {

struct MergedSession {
  std::string path;
  // The group of connected sessions, by its lowest index.
  size_t group = 0;
  // Its placement before the optimisation; none if it is not in the merged map.
  std::optional<Rigid2> T_merged_session;
  // Why it is not in the merged map; empty if it is.
  std::string left_out;
};

struct MergingResult {
  std::vector<MergedSession> sessions;  // all, in the order given
  std::vector<SessionLink> links;       // those that were compared
  // Of the sessions in the merged map, with their new numbers.
  std::vector<MapPart> parts;
  // As read, under the new numbers. Here, places made of scans are submaps.
  MapState state;
  // Its pose graph contains only submaps that are in the files, as
  // WriteJoinedMap requires.
  ClosedGraph closed;
  // Number of pairs of submaps that overlap in the merged map, and those that
  // contradict each other.
  int num_overlapping = 0;
  std::vector<Match> contradictions;
  // Why there is no merged map; empty if there is one. If there is none, the
  // other fields hold the results up to that point.
  std::string refusal;
  std::vector<std::pair<std::string, double>> stage_seconds;
};

// Finds links between the sessions and the closures within each, and joins
// the largest connected group, on ties the first. While the map would be folded
// and more than two sessions are in it, leaves out the session that is most
// likely at fault. The map frame is that of the first session that stays.
// Frozen trajectories, numbered in the order of all sessions' trajectories,
// stay fixed; all must belong to that first session. `describe` is that of
// DescribeSession. Fails if a file cannot be read, or if there is no such
// trajectory.
[[nodiscard]] absl::StatusOr<MergingResult> MergeSessions(
    const FoldCheckOptions& options, const SessionLinkOptions& session_links,
    const LocalizationOptions& localization,
    const ScanPlaceOptions& scan_places, const LoopClosingOptions& stages,
    const std::vector<MapSource>& sources,
    const std::set<int>& frozen_trajectories, const Executor& executor,
    const StageCallback& on_stage = {}, const MapDescriber& describe = {});

// Attaches a query to a map in which it was localized. Every trajectory of the
// map stays fixed, and no closures within either are sought. Fails if both are
// the same file.
[[nodiscard]] absl::StatusOr<MergingResult> AttachQuery(
    const FoldCheckOptions& options, const LoopClosingOptions& stages,
    const Session& map, const Session& query, const Localization& localization,
    const Executor& executor, const StageCallback& on_stage = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_APPS_MERGE_H_
