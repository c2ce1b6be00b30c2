// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Checks the loop closures of a saved map. Every inter-submap constraint is
// tested against the submaps at its own pose, against the cycles that it forms
// with the others, and against the map that results from the constraints that
// are not doubtful. No constraint is trusted in advance, and the map's own
// poses, which wrong constraints have distorted, are not used.
//
//   audit = AuditMap(options, audit_options, path, {}, executor);
//   for (const AuditedGroup& group : audit->groups) ...
//   if (audit->refusal.empty()) WriteMap(path, output, audit->pose_graph);

#ifndef CARTOGRAPHER_SDF_APPS_AUDIT_H_
#define CARTOGRAPHER_SDF_APPS_AUDIT_H_

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/apps/close_loops.h"
#include "cartographer_sdf/apps/map_quality.h"
#include "cartographer_sdf/closing/consistency.h"
#include "cartographer_sdf/closing/constraint_groups.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/pose_graph/optimization.h"

namespace cartographer_sdf {

struct AuditOptions {
  GroupingOptions grouping;
  // Constraints of a pair with a larger contradiction ratio, the worse of both
  // directions in the registered pose, are doubtful.
  double max_contradiction_ratio = 0.1;
  // Least lead over any other pose of the pair; with less the pose is
  // ambiguous; log-odds.
  double min_margin = 0.;
  // Least score of a likely pose; log-odds.
  double min_score = 0.;
  // A doubtful constraint is kept if the map optimised without any doubtful
  // ones agrees with it to within this [m], [rad].
  double max_agreeing_translation_meters = 0.3;
  double max_agreeing_rotation = 0.1;
  // Constraints that this map contradicts are doubtful too. Looser than for
  // closures that close_loops adds: here correct constraints of the input are
  // at stake.
  OutlierRejectionOptions outlier_rejection = {0.5, 0.1, 10};
};
[[nodiscard]] std::string Validate(const AuditOptions& options);

enum class AuditVerdict {
  // Kept.
  kConfirmed,      // likely, and nothing contradicts it
  kAgreesWithMap,  // uncertain by itself, but the map agrees
  kUnchecked,      // does not relate two submaps with walls
  // Doubtful.
  kContradicted,       // walls of one stand in free space of the other
  kAmbiguous,          // another pose of the pair is as good
  kUnlikely,           // too little agreement
  kOutvoted,           // cycles with stronger constraints contradict it
  kUnsupported,        // no support from others, and uncertain alone
  kContradictedByMap,  // the map made of the others disagrees
};
// "confirmed", ...
[[nodiscard]] const char* AuditVerdictName(AuditVerdict verdict);
[[nodiscard]] bool IsDoubtful(AuditVerdict verdict);

// Evidence from the walls and free space of two submaps for the pose that a
// constraint claims.
struct ClaimEvidence {
  // The claimed pose after registration; as claimed if the walls do not hold it
  // near there.
  Rigid2 T_reference_query;
  // Motion of the query's centroid by registration [m], [rad]; none where the
  // walls do not determine a pose.
  std::optional<double> shift;
  std::optional<double> turn;
  bool is_held = false;
  PairEvidence evidence;
  // Lead over the best distinct pose, as in VerifiedPose::margin.
  double margin = 0.;
  double score = 0.;  // log-odds of being correct, as for matches
};

struct AuditedConstraint {
  size_t constraint;  // index in PoseGraph::constraints
  AuditVerdict verdict;
  // Errors in the input map, and in the map made without doubtful constraints.
  ConstraintError error_before;
  ConstraintError error_after;
};

struct AuditedGroup {
  ConstraintGroup group;
  ClaimEvidence claim;
  // Agreement of other groups with it in cycles: their scores. It is itself
  // among them if selected.
  SelectionResult cycles;
  // Based on appearance and cycles; the map may change the verdict of single
  // constraints.
  AuditVerdict verdict;
};

// A constraint of a list of those to drop, as audit wrote it or a person chose.
struct ListedConstraint {
  size_t constraint = 0;  // index in PoseGraph::constraints
  SubmapId submap;
  NodeId node;
};

struct Audit {
  MapState state;  // as read
  std::vector<AuditedGroup> groups;
  // All inter-submap constraints, in their order.
  std::vector<AuditedConstraint> constraints;
  size_t num_doubtful = 0;
  // Indices of the constraints that the map below lacks: those of the list, if
  // one was given, else the doubtful ones.
  std::set<size_t> dropped;
  // Optimised without them; the input graph if there are none.
  PoseGraph pose_graph;
  // In force, odometry weights as inferred; zero if odometry contradicts
  // constraints that are kept.
  OptimizationOptions optimization;
  bool leaves_out_odometry = false;
  // Of the map as read, and of the one without those that are dropped.
  MapQuality quality_before;
  MapQuality quality_after;
  // Why the map without doubtful constraints must not replace the one that was
  // read: its walls agree less. Empty otherwise, and where a list says what to
  // drop.
  std::string refusal;
  std::vector<OptimizationSummary> optimizations;
  std::vector<std::pair<std::string, double>> stage_seconds;
};

// Fails if the file cannot be read, or if `drop_list` names a constraint that
// the map does not have so, or twice. With a list, the verdicts are the same,
// but it says which constraints are dropped. Of the loop closing options, those
// for places, matching, consistency and optimisation apply. The result does not
// depend on the number of threads.
[[nodiscard]] absl::StatusOr<Audit> AuditMap(
    const LoopClosingOptions& loop_closing, const AuditOptions& options,
    const MapSource& source, const std::set<int>& frozen_trajectories,
    const Executor& executor, const StageCallback& on_stage = {},
    const std::optional<std::vector<ListedConstraint>>& drop_list = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_APPS_AUDIT_H_
