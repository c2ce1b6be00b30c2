// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Test data for the audit: a good map with wrong constraints among its own,
// optimised as Cartographer would have, so that its poses are bent too. The
// wrong ones are of the kinds that scan matching takes for right: they are
// registered where they are wrong, and most of them have walls on walls.

#ifndef CARTOGRAPHER_SDF_EVALUATION_FALSE_CONSTRAINTS_H_
#define CARTOGRAPHER_SDF_EVALUATION_FALSE_CONSTRAINTS_H_

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/apps/close_loops.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

enum class FalseKind {
  kCorridor,  // submaps that overlap, one slid 1.5 to 6 m along the walls
  kDoor,      // the same, where along the walls it looks most alike
  kHalfTurn,  // submaps that overlap, one turned by half a turn
  kTwin,      // submaps of different places, as alike as any
  kRow,       // such submaps and their neighbours, which agree with each other
  kRandom,    // any two submaps in any pose
};
// "corridor", ..., in the order above.
[[nodiscard]] const char* FalseKindName(FalseKind kind);
[[nodiscard]] std::vector<FalseKind> AllFalseKinds();

struct FalsificationOptions {
  std::vector<FalseKind> kinds = AllFalseKinds();
  // Pairs of submaps of each kind; of a row of neighbours, rows.
  int num_pairs = 3;
  uint32_t seed = 1;
};
[[nodiscard]] std::string Validate(const FalsificationOptions& options);

struct FalseConstraint {
  size_t constraint;  // index in PoseGraph::constraints
  FalseKind kind;
  size_t pair;  // or row; counted through all kinds
};

struct FalsifiedMap {
  // The map's constraints and then the wrong ones, optimised.
  PoseGraph pose_graph;
  // Fewer than asked for where the map has no such pairs.
  std::vector<FalseConstraint> false_constraints;
};

// The map's poses are taken for right. Of the options of loop closing those of
// places, matching, lifting and optimisation apply. Seconds for a hundred
// submaps; the same for any number of threads. Fails where the file can't be
// read.
[[nodiscard]] absl::StatusOr<FalsifiedMap> FalsifyMap(
    const LoopClosingOptions& loop_closing, const FalsificationOptions& options,
    const std::string& path, const std::set<int>& frozen_trajectories,
    const Executor& executor);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_FALSE_CONSTRAINTS_H_
