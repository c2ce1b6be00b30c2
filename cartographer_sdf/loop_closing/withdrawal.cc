// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/loop_closing/withdrawal.h"

#include <algorithm>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

ConstraintError MeanError(const PoseGraph& pose_graph,
                          const std::vector<Constraint>& constraints) {
  ConstraintError mean;
  for (const Constraint& constraint : constraints) {
    const ConstraintError error = ConstraintResidual(pose_graph, constraint);
    mean.translation += error.translation;
    mean.rotation += error.rotation;
  }
  mean.translation /= static_cast<double>(constraints.size());
  mean.rotation /= static_cast<double>(constraints.size());
  return mean;
}

// In units of what is allowed.
double Excess(const WithdrawalOptions& options, const ConstraintError& error) {
  return std::max(error.translation / options.max_translation_error_meters,
                  error.rotation / options.max_rotation_error);
}

PoseGraph WithClosures(PoseGraph pose_graph,
                       const std::vector<ClosureOutcome>& closures) {
  for (const ClosureOutcome& closure : closures) {
    pose_graph.constraints.insert(pose_graph.constraints.end(),
                                  closure.constraints.begin(),
                                  closure.constraints.end());
  }
  return pose_graph;
}

void MeasureErrors(const PoseGraph& pose_graph,
                   std::vector<ClosureOutcome>* const closures) {
  for (ClosureOutcome& closure : *closures) {
    if (closure.fate == Fate::kInGraph) {
      closure.error = MeanError(pose_graph, closure.constraints);
    }
  }
}

// Withdraws what the graph contradicts most; false where there is nothing. A
// false closure strains true ones beside it, so that only those at least half
// as bad as the worst go at once.
bool Withdraw(const WithdrawalOptions& options,
              std::vector<ClosureOutcome>* const closures) {
  double worst = 0.;
  for (const ClosureOutcome& closure : *closures) {
    if (closure.fate != Fate::kInGraph) continue;
    worst = std::max(worst, Excess(options, closure.error));
  }
  if (worst <= 1.) return false;
  for (ClosureOutcome& closure : *closures) {
    if (closure.fate == Fate::kInGraph &&
        Excess(options, closure.error) > std::max(1., 0.5 * worst)) {
      closure.fate = Fate::kWithdrawn;
      closure.constraints.clear();
    }
  }
  return true;
}

}  // namespace

std::string Validate(const WithdrawalOptions& options) {
  if (!(options.max_translation_error_meters > 0. &&
        options.max_rotation_error > 0.)) {
    return "max_translation_error_meters and max_rotation_error must be "
           "positive";
  }
  if (options.max_num_rounds < 0 || options.max_num_rounds > 1000) {
    return "max_num_rounds must lie between 0 and 1000";
  }
  return "";
}

const char* FateName(const Fate fate) {
  switch (fate) {
    case Fate::kInGraph:
      return "in_graph";
    case Fate::kContradicted:
      return "contradicted_by_others";
    case Fate::kUnsupported:
      return "unsupported";
    case Fate::kScansDisagree:
      return "scans_disagree";
    case Fate::kWithdrawn:
      return "withdrawn";
  }
  LOG(FATAL) << "not a fate: " << static_cast<int>(fate);
}

OptimizedGraph OptimizeAndWithdraw(const WithdrawalOptions& options,
                                   const OptimizationOptions& optimization,
                                   const std::set<int>& frozen_trajectories,
                                   const PoseGraph& pose_graph,
                                   std::vector<ClosureOutcome>* const closures,
                                   const ProgressCallback& on_progress) {
  CHECK_EQ(Validate(options), "");
  OptimizedGraph result;
  for (int round = 0;; ++round) {
    // From the given poses each time: a withdrawn closure leaves no trace.
    result.pose_graph = WithClosures(pose_graph, *closures);
    // Nothing new: the map stays as it is, to the last bit.
    if (result.pose_graph.constraints.size() == pose_graph.constraints.size()) {
      return result;
    }
    result.optimizations.push_back(
        Optimize(optimization, frozen_trajectories, &result.pose_graph));
    MeasureErrors(result.pose_graph, closures);
    if (on_progress) {
      on_progress(static_cast<double>(round + 1) /
                  (options.max_num_rounds + 1));
    }
    // The last round's graph has been optimised without what was withdrawn
    // before; nothing may be withdrawn after it.
    if (round >= options.max_num_rounds || !Withdraw(options, closures)) {
      return result;
    }
  }
}

}  // namespace cartographer_sdf
