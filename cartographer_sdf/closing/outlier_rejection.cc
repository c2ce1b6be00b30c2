// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/closing/outlier_rejection.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

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

// The error relative to its limit.
double Excess(const OutlierRejectionOptions& options,
              const ConstraintError& error) {
  return std::max(error.translation / options.max_translation_error_meters,
                  error.rotation / options.max_rotation_error);
}

PoseGraph WithClosures(PoseGraph pose_graph,
                       const std::vector<Closure>& closures) {
  for (const Closure& closure : closures) {
    pose_graph.constraints.insert(pose_graph.constraints.end(),
                                  closure.constraints.begin(),
                                  closure.constraints.end());
  }
  return pose_graph;
}

void MeasureErrors(const PoseGraph& pose_graph,
                   std::vector<Closure>* const closures) {
  for (Closure& closure : *closures) {
    if (closure.status == ClosureStatus::kInGraph) {
      closure.graph_error = MeanError(pose_graph, closure.constraints);
    }
  }
}

// Adds the run that continued one to its summary.
void Continue(const OptimizationSummary& continued,
              OptimizationSummary* const summary) {
  summary->final_cost = continued.final_cost;
  summary->num_iterations += continued.num_iterations;
  summary->seconds += continued.seconds;
  summary->converged = continued.converged;
  summary->message = continued.message;
}

// For each trajectory with constraints, the lowest of those that it is
// connected with.
std::map<int, int> ConnectedTrajectories(const PoseGraph& pose_graph) {
  std::set<std::pair<int, int>> connections;
  for (const Constraint& constraint : pose_graph.constraints) {
    connections.emplace(constraint.submap.trajectory,
                        constraint.node.trajectory);
  }
  std::map<int, int> connected;
  for (const auto& [a, b] : connections) {
    const int root_a = connected.emplace(a, a).first->second;
    const int root_b = connected.emplace(b, b).first->second;
    for (auto& [trajectory, root] : connected) {
      if (root == std::max(root_a, root_b)) root = std::min(root_a, root_b);
    }
  }
  return connected;
}

// Removes the closures that the graph contradicts most, in each part of it that
// is connected: they strain nothing in another. Returns false if there are
// none.
bool RejectWorst(const OutlierRejectionOptions& options,
                 const std::map<int, int>& connected,
                 std::vector<Closure>* const closures) {
  std::map<int, std::vector<std::optional<ConstraintError>>> errors_of_parts;
  for (size_t k = 0; k < closures->size(); ++k) {
    const Closure& closure = (*closures)[k];
    if (closure.status != ClosureStatus::kInGraph) continue;
    auto& errors =
        errors_of_parts[connected.at(closure.match.pair.reference.trajectory)];
    errors.resize(closures->size());
    errors[k] = closure.graph_error;
  }
  bool has_outliers = false;
  for (const auto& [part, errors] : errors_of_parts) {
    for (const size_t k : FindOutliers(options, errors)) {
      (*closures)[k].status = ClosureStatus::kOutlier;
      (*closures)[k].constraints.clear();
      has_outliers = true;
    }
  }
  return has_outliers;
}

}  // namespace

std::string Validate(const OutlierRejectionOptions& options) {
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

std::vector<size_t> FindOutliers(
    const OutlierRejectionOptions& options,
    const std::vector<std::optional<ConstraintError>>& errors) {
  double worst = 0.;
  for (const std::optional<ConstraintError>& error : errors) {
    if (error) worst = std::max(worst, Excess(options, *error));
  }
  std::vector<size_t> outliers;
  if (worst <= 1.) return outliers;
  for (size_t k = 0; k < errors.size(); ++k) {
    if (errors[k] && Excess(options, *errors[k]) > std::max(1., 0.5 * worst)) {
      outliers.push_back(k);
    }
  }
  return outliers;
}

OptimizedGraph OptimizeAndRejectOutliers(
    const OutlierRejectionOptions& options,
    const OptimizationOptions& optimization,
    const std::set<int>& frozen_trajectories, const PoseGraph& pose_graph,
    std::vector<Closure>* const closures, const ProgressCallback& on_progress) {
  CHECK_EQ(Validate(options), "");
  const std::map<int, int> connected =
      ConnectedTrajectories(WithClosures(pose_graph, *closures));
  OptimizedGraph result;
  for (int round = 0;; ++round) {
    // Starts from the given poses each time, so that removed closures leave no
    // trace.
    result.pose_graph = WithClosures(pose_graph, *closures);
    // Without new constraints, the map stays identical to the last bit.
    if (result.pose_graph.constraints.size() == pose_graph.constraints.size()) {
      return result;
    }
    result.optimizations.push_back(Optimize(optimization, frozen_trajectories,
                                            &result.pose_graph, kRoughRun));
    MeasureErrors(result.pose_graph, closures);
    if (on_progress) {
      on_progress(static_cast<double>(round + 1) /
                  (options.max_num_rounds + 1));
    }
    // Nothing may be removed after the last round, as the graph would not be
    // optimised again.
    const bool is_last = round >= options.max_num_rounds;
    if (!is_last && RejectWorst(options, connected, closures)) continue;
    Continue(Optimize(optimization, frozen_trajectories, &result.pose_graph,
                      kSettlingRun),
             &result.optimizations.back());
    MeasureErrors(result.pose_graph, closures);
    if (is_last || !RejectWorst(options, connected, closures)) return result;
  }
}

}  // namespace cartographer_sdf
