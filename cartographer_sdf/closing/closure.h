// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A loop closure: a match that verification accepted, and its status on the way
// into the pose graph.

#ifndef CARTOGRAPHER_SDF_CLOSING_CLOSURE_H_
#define CARTOGRAPHER_SDF_CLOSING_CLOSURE_H_

#include <vector>

#include "cartographer_sdf/pose_graph/optimization.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/recognition/match.h"

namespace cartographer_sdf {

enum class ClosureStatus {
  kSelected,        // consistent with the others; no constraints yet
  kInGraph,         // its constraints are in the pose graph
  kInconsistent,    // weightier closures contradict it, through odometry
  kUnsupported,     // no other supports it, and its own score is too low
  kScansDisagree,   // too few scans of its nodes fit where it puts them
  kOutlier,         // the optimised pose graph contradicts it
  kAlreadyInGraph,  // constraints of the input say the same
  kRedundant,       // better closures tie its submaps often enough
  // Only beside a live Cartographer.
  kReady,         // its constraints enter with the next optimisation
  kDetectedOnly,  // injection is switched off, or there is no pose graph
  kGone,          // one of its submaps was trimmed or deleted before
};
// "selected", "in_graph", ...
[[nodiscard]] const char* ClosureStatusName(ClosureStatus status);

struct Closure {
  Match match;
  ClosureStatus status = ClosureStatus::kSelected;
  // Inter-submap constraints; empty unless kInGraph.
  std::vector<Constraint> constraints;
  // Mean error of the constraints in the last optimised graph that contained
  // them; zero if none did.
  ConstraintError graph_error;
};

// Makes a closure of each likely match, in the order of the matches: closures
// may support each other through odometry (consistency.h).
[[nodiscard]] std::vector<Closure> MakeClosures(std::vector<Match> matches);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CLOSING_CLOSURE_H_
