// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Several maps of one building, saved at different times, as one map.

#ifndef CARTOGRAPHER_SDF_SESSIONS_MERGING_H_
#define CARTOGRAPHER_SDF_SESSIONS_MERGING_H_

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/loop_closing/described_map.h"
#include "cartographer_sdf/loop_closing/loop_closing.h"
#include "cartographer_sdf/pbstream/joined_map_file.h"
#include "cartographer_sdf/sessions/relocalization.h"

namespace cartographer_sdf {

struct MergingOptions {
  // Two submaps that the merged map lays over each other contradict each other
  // where a larger fraction of their walls stands in the other's free space
  // (mean of both directions). Walls that are laid right have some 0.01, half a
  // building that is laid over another one 0.05 and more.
  double max_contradiction_ratio = 0.05;
  // Of the pairs of submaps of two sessions, or within one, that the merged map
  // lays over each other: the largest fraction that may contradict each other.
  // More than that is a map that is folded.
  double max_folded_fraction = 0.2;
};
[[nodiscard]] std::string Validate(const MergingOptions& options);

// What is known of two sessions: where the second lies in the first.
struct SessionLink {
  size_t first = 0;  // indices of sessions, first < second
  size_t second = 0;
  Relocalization relocalization;
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
  // Optimised, with the new constraints at the end; of the submaps of the files
  // alone, and so for WriteJoinedMap.
  PoseGraph pose_graph;
  std::vector<ClosureOutcome> closures;
  std::map<SubmapId, Tear> torn_submaps;
  std::vector<OptimizationSummary> optimizations;
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
    const MergingOptions& options, const RelocalizationOptions& relocalization,
    const LoopClosingOptions& stages, const std::vector<std::string>& paths,
    const std::set<int>& frozen_trajectories, const Executor& executor,
    const StageCallback& on_stage = {});

// Attaches a query to a map in which it was localized: every trajectory of the
// map stays where it is, and no closures within either are sought. Fails where
// a file can't be read.
[[nodiscard]] absl::StatusOr<MergingResult> AttachQuery(
    const MergingOptions& options, const LoopClosingOptions& stages,
    const Session& map, const Session& query,
    const Relocalization& relocalization, const Executor& executor,
    const StageCallback& on_stage = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SESSIONS_MERGING_H_
