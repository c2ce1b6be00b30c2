// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Checks the walls of a merged map: a fold lays submaps over each other whose
// walls stand in each other's free space.

#ifndef CARTOGRAPHER_SDF_APPS_FOLD_CHECK_H_
#define CARTOGRAPHER_SDF_APPS_FOLD_CHECK_H_

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/apps/session.h"
#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/recognition/recognize.h"

namespace cartographer_sdf {

struct FoldCheckOptions {
  // Two submaps contradict each other where a larger fraction of their walls
  // stands in the other's free space (mean of both directions). Walls that are
  // laid right have some 0.01, half a building that is laid over another one
  // 0.05 and more.
  double max_contradiction_ratio = 0.05;
  // Of the pairs of submaps of two sessions, or within one, that the merged map
  // lays over each other: the largest fraction that may contradict each other.
  // More than that is a fold.
  double max_folded_fraction = 0.2;
};
[[nodiscard]] std::string Validate(const FoldCheckOptions& options);

// The pairs of submaps of two sessions, or within one.
struct SessionOverlap {
  int num_overlapping = 0;  // that the merged map lays over each other
  std::vector<Match> contradictions;  // of them
};

// By the sessions, the lower first. What contradicted itself before the merge,
// within a session, is not counted.
[[nodiscard]] std::map<std::pair<size_t, size_t>, SessionOverlap> CheckOverlaps(
    const FoldCheckOptions& options, const RecognitionOptions& recognition,
    const JoinedSessions& joined, const PoseGraph& merged,
    const Executor& executor);

// Why the merged map is folded, a sentence with an example; empty where it is
// not. Each pair of sessions is judged apart from the others: a long map that
// agrees with itself must not outweigh what a short one contradicts.
[[nodiscard]] std::string DescribeFold(
    const FoldCheckOptions& options,
    const std::map<std::pair<size_t, size_t>, SessionOverlap>& overlaps,
    const std::vector<const Session*>& sessions);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_APPS_FOLD_CHECK_H_
