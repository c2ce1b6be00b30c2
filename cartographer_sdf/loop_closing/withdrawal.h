// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The last guard against false closures: one that the optimised graph
// contradicts is withdrawn, and the rest is optimised again.

#ifndef CARTOGRAPHER_SDF_LOOP_CLOSING_WITHDRAWAL_H_
#define CARTOGRAPHER_SDF_LOOP_CLOSING_WITHDRAWAL_H_

#include <set>
#include <string>
#include <vector>

#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/pose_graph/optimization.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/recognition/match.h"

namespace cartographer_sdf {

struct WithdrawalOptions {
  // Largest mean error of a closure's constraints [m], [rad].
  double max_translation_error_meters = 0.3;
  double max_rotation_error = 0.052;
  int max_num_rounds = 10;
};
[[nodiscard]] std::string Validate(const WithdrawalOptions& options);

// What became of a match that verification accepted.
enum class Fate {
  kInGraph,
  kContradicted,   // by weightier closures
  kUnsupported,    // by no other, and not certain enough alone
  kScansDisagree,  // the scans of its nodes do not fit
  kWithdrawn,      // the optimised graph contradicts it
};
// "in_graph", ...
[[nodiscard]] const char* FateName(Fate fate);

struct ClosureOutcome {
  Match match;
  Fate fate;
  // Its constraints in the final graph; empty unless kInGraph.
  std::vector<Constraint> constraints;
  // Mean error of its constraints in the last optimised graph that had them;
  // zero for those that were never in one.
  ConstraintError error;
};

struct OptimizedGraph {
  // With the constraints of the closures that are left at the end; as given
  // where none is.
  PoseGraph pose_graph;
  std::vector<OptimizationSummary> optimizations;  // one for each round
};

// Sets fate, constraints and error of the closures that are in the graph.
[[nodiscard]] OptimizedGraph OptimizeAndWithdraw(
    const WithdrawalOptions& options, const OptimizationOptions& optimization,
    const std::set<int>& frozen_trajectories, const PoseGraph& pose_graph,
    std::vector<ClosureOutcome>* closures,
    const ProgressCallback& on_progress = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOOP_CLOSING_WITHDRAWAL_H_
