// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Test data for the audit: a good map with added wrong constraints, optimised
// as Cartographer would, so that its poses are distorted too. The wrong
// constraints are of the kinds that scan matching accepts: they are registered
// at their wrong poses, and most of them align walls with walls.

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
  kCorridor,  // overlapping submaps, one slid 1.5 to 6 m along the walls
  kDoor,      // the same, at the slide that looks most alike
  kHalfTurn,  // overlapping submaps, one rotated by half a turn
  kTwin,      // submaps of different places that look most alike
  kRow,       // such submaps with their neighbours, mutually consistent
  kRandom,    // any two submaps at any pose
};
// "corridor", ..., in the order above.
[[nodiscard]] const char* FalseKindName(FalseKind kind);
[[nodiscard]] std::vector<FalseKind> AllFalseKinds();

struct FalsificationOptions {
  std::vector<FalseKind> kinds = AllFalseKinds();
  // Pairs of submaps of each kind; for kRow, rows.
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
  // The map's constraints followed by the wrong ones, optimised.
  PoseGraph pose_graph;
  // Fewer than requested if the map has too few such pairs.
  std::vector<FalseConstraint> false_constraints;
};

// Assumes that the map's poses are right. Uses the loop closing options of
// places, matching, constraint generation and optimisation. Takes seconds for a
// hundred submaps; independent of the number of threads. Fails if the file
// cannot be read.
[[nodiscard]] absl::StatusOr<FalsifiedMap> FalsifyMap(
    const LoopClosingOptions& loop_closing, const FalsificationOptions& options,
    const std::string& path, const std::set<int>& frozen_trajectories,
    const Executor& executor);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_FALSE_CONSTRAINTS_H_
