// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Are the loop closures of a saved map right? Every inter-submap constraint is
// held against what the submaps look like at its own pose, against the cycles
// that it forms with the others, and against the map that the undoubted ones
// make. None is believed because it is there: the map's own poses, which wrong
// constraints have bent, take no part.
//
//   audit = AuditMap(options, audit_options, path, {}, executor);
//   for (const AuditedGroup& group : audit->groups) ...
//   if (audit->num_doubtful > 0) WriteMap(path, output, audit->pose_graph);

#ifndef CARTOGRAPHER_SDF_APPS_AUDIT_H_
#define CARTOGRAPHER_SDF_APPS_AUDIT_H_

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/apps/close_loops.h"
#include "cartographer_sdf/closing/consistency.h"
#include "cartographer_sdf/closing/constraint_groups.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/pose_graph/optimization.h"

namespace cartographer_sdf {

struct AuditOptions {
  GroupingOptions grouping;
  // Constraints of a pair whose walls contradict more are doubtful: the worse
  // of both directions, in the registered pose.
  double max_contradiction_ratio = 0.1;
  // A pose must be better than any other of its pair by so much, else it is
  // ambiguous; log-odds.
  double min_margin = 0.;
  // The least score of what looks right; log-odds.
  double min_score = 0.;
  // A doubtful constraint stays where the map that is made without any of them
  // agrees with it to this [m], [rad].
  double max_agreeing_translation_meters = 0.3;
  double max_agreeing_rotation = 0.1;
  // What that map contradicts is doubtful, too. Wider than for closures that
  // close_loops adds: here right ones of others are at stake.
  OutlierRejectionOptions outlier_rejection = {0.5, 0.1, 10};
};
[[nodiscard]] std::string Validate(const AuditOptions& options);

enum class AuditVerdict {
  // Kept.
  kConfirmed,      // looks right, and nothing speaks against it
  kAgreesWithMap,  // not certain by itself, but where the map has it anyway
  kUnchecked,      // relates no two submaps that have walls
  // Doubtful.
  kContradicted,       // walls of one stand in free space of the other
  kAmbiguous,          // another pose of the pair is as good
  kUnlikely,           // too little agrees
  kOutvoted,           // weightier constraints contradict it, in cycles
  kUnsupported,        // no other supports it, and it is not certain alone
  kContradictedByMap,  // the map made of the others has it elsewhere
};
// "confirmed", ...
[[nodiscard]] const char* AuditVerdictName(AuditVerdict verdict);
[[nodiscard]] bool IsDoubtful(AuditVerdict verdict);

// What the walls and free space of two submaps say of a pose that a constraint
// claims.
struct ClaimEvidence {
  // The claimed pose, registered; as claimed where the walls do not hold it
  // near there.
  Rigid2 T_reference_query;
  // How far registration moves the centroid of the query [m], [rad]; none where
  // the walls fix no pose.
  std::optional<double> shift;
  std::optional<double> turn;
  bool is_held = false;
  PairEvidence evidence;
  // Lead over the best distinct pose, as VerifiedPose::margin.
  double margin = 0.;
  double score = 0.;  // log-odds of being right, as verification scores matches
};

struct AuditedConstraint {
  size_t constraint;  // index in PoseGraph::constraints
  AuditVerdict verdict;
  // In the map as it was, and in the map made without doubtful constraints.
  ConstraintError error_before;
  ConstraintError error_after;
};

struct AuditedGroup {
  ConstraintGroup group;
  ClaimEvidence claim;
  // What others say of it in cycles: their scores. It is among the others where
  // it is selected.
  SelectionResult cycles;
  // By what it looks like and by the cycles; single constraints can fare
  // otherwise, by the map.
  AuditVerdict verdict;
};

struct Audit {
  MapState state;  // as read
  std::vector<AuditedGroup> groups;
  // All inter-submap constraints, in their order.
  std::vector<AuditedConstraint> constraints;
  size_t num_doubtful = 0;
  // Without the doubtful ones, optimised; as it was where there are none.
  PoseGraph pose_graph;
  OptimizationOptions optimization;  // in force, odometry weights as inferred
  std::vector<OptimizationSummary> optimizations;
  std::vector<std::pair<std::string, double>> stage_seconds;
};

// Fails where the file can't be read. Of the options of loop closing those of
// places, matching, consistency and optimisation apply. The same
// for any number of threads.
[[nodiscard]] absl::StatusOr<Audit> AuditMap(
    const LoopClosingOptions& loop_closing, const AuditOptions& options,
    const std::string& path, const std::set<int>& frozen_trajectories,
    const Executor& executor, const StageCallback& on_stage = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_APPS_AUDIT_H_
