// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Checks the walls of a merged map for folds: a fold superimposes submaps whose
// walls lie in each other's free space.

#ifndef CARTOGRAPHER_SDF_APPS_FOLD_CHECK_H_
#define CARTOGRAPHER_SDF_APPS_FOLD_CHECK_H_

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/apps/session.h"
#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/recognition/recognize.h"

namespace cartographer_sdf {

struct FoldCheckOptions {
  // Two submaps contradict each other if a larger fraction of their walls lies
  // in the other's free space (mean of both directions). The ratio is about
  // 0.01 for correctly placed walls, up to 0.13 where furniture was moved, and
  // mostly more where a building is laid over another one.
  double max_contradiction_ratio = 0.15;
  // Largest fraction of contradicting pairs among the pairs of submaps of two
  // sessions, or within one, that overlap in the merged map. A larger fraction
  // is a fold.
  double max_folded_fraction = 0.2;
};
[[nodiscard]] std::string Validate(const FoldCheckOptions& options);

// The pairs of submaps of two sessions, or within one.
struct SessionOverlap {
  int num_overlapping = 0;            // pairs that overlap in the merged map
  std::vector<Match> contradictions;  // of them
};

// Keyed by the two sessions, the lower first. Contradictions within a session
// that existed before the merge are not counted.
[[nodiscard]] std::map<std::pair<size_t, size_t>, SessionOverlap> CheckOverlaps(
    const FoldCheckOptions& options, const RecognitionOptions& recognition,
    const JoinedSessions& joined, const PoseGraph& merged,
    const Executor& executor);

// Why a merged map cannot be right, and the session that is most likely at
// fault.
struct MergingFault {
  std::string reason;
  size_t session = 0;
};

// Returns none if the merged map is not folded; otherwise the reason is a
// sentence with an example, and at fault is the session of the folded pair that
// is folded with more others, on ties the later. Each pair of sessions is
// judged separately: a long map that agrees with itself must not outweigh the
// contradictions of a short one.
[[nodiscard]] std::optional<MergingFault> FindFold(
    const FoldCheckOptions& options,
    const std::map<std::pair<size_t, size_t>, SessionOverlap>& overlaps,
    const std::vector<const Session*>& sessions);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_APPS_FOLD_CHECK_H_
