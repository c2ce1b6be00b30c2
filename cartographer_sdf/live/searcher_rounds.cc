// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The part of the searcher that accesses the host's pose graph: checks its
// content after each optimisation, and adds constraints to it.

#include <algorithm>
#include <iterator>
#include <utility>

#include "cartographer_sdf/live/live_metrics.h"
#include "cartographer_sdf/live/searcher.h"

namespace cartographer_sdf {

namespace mapping = cartographer::mapping;

bool Searcher::IsHookObsolete(const int generation) const {
  const absl::MutexLock lock(&mutex_);
  return gate_.IsObsolete(generation);
}

void Searcher::EnterRound(mapping::Trimmable* const graph,
                          const int generation) {
  TrajectoriesInRound trajectories;
  {
    const absl::MutexLock lock(&mutex_);
    if (is_shut_down_) return;
    for (const auto& [id, trajectory] : trajectories_) {
      TrajectoryInRound& copy = trajectories[id];
      copy.is_live = trajectory.is_live;
      if (trajectory.complete_generation &&
          generation >= *trajectory.complete_generation) {
        copy.num_submaps = trajectory.num_submaps;
      }
    }
  }
  // Without our mutex, so that sensor threads do not wait for it. No node is
  // added meanwhile, because the host's mutex is held.
  const NodeCounts counts = CountNodes(trajectories, *graph);
  const std::vector<SubmapId> gone = FindGone(trajectories, *graph);
  const absl::MutexLock lock(&mutex_);
  if (is_shut_down_) return;
  for (const SubmapId& id : gone) ForgetSubmap(id);
  if (!gate_.EnterRound(generation, counts.num_done, counts.num_waiting) ||
      !MayInject()) {
    return;
  }
  InjectReady(
      [this](const SubmapId& id) { return submaps_in_graph_.Contains(id); },
      graph->GetTrajectoryNodes());
}

// A node is done when it has its intra-submap constraints.
Searcher::NodeCounts Searcher::CountNodes(
    const TrajectoriesInRound& trajectories, const mapping::Trimmable& graph) {
  const auto& nodes = graph.GetTrajectoryNodes();
  NodeCounts counts;
  std::map<int, int> newest, unknown;
  for (const int trajectory : nodes.trajectory_ids()) {
    const auto found = trajectories.find(trajectory);
    if (found == trajectories.end()) {
      // Unknown trajectory: any of its nodes may be waiting.
      counts.num_waiting +=
          static_cast<int64_t>(nodes.SizeOfTrajectoryOrZero(trajectory));
      continue;
    }
    if (!found->second.is_live) continue;
    newest[trajectory] =
        (*std::prev(nodes.EndOfTrajectory(trajectory))).id.node_index;
    const int done = newest_node_done_.emplace(trajectory, -1).first->second;
    if (newest[trajectory] > done) unknown[trajectory] = done;
  }
  const auto& constraints = graph.GetConstraints();
  for (auto constraint = constraints.rbegin();
       constraint != constraints.rend() && !unknown.empty(); ++constraint) {
    if (constraint->tag != HostConstraint::INTRA_SUBMAP) continue;
    const mapping::NodeId& node = constraint->node_id;
    if (unknown.erase(node.trajectory_id) == 0) continue;
    int& done = newest_node_done_[node.trajectory_id];
    done = std::max(done, node.node_index);
  }
  for (const auto& [trajectory, newest_node] : newest) {
    counts.num_waiting +=
        std::max(newest_node - newest_node_done_[trajectory], 0);
  }
  for (const auto& [trajectory, done] : newest_node_done_) {
    counts.num_done += done + 1;
  }
  return counts;
}

std::vector<SubmapId> Searcher::FindGone(
    const TrajectoriesInRound& trajectories, const mapping::Trimmable& graph) {
  std::vector<SubmapId> gone;
  for (const auto& [id, trajectory] : trajectories) {
    if (trajectory.num_submaps &&
        submaps_in_graph_.IsUpToDate(id,
                                     static_cast<size_t>(graph.num_submaps(id)),
                                     *trajectory.num_submaps)) {
      continue;
    }
    std::vector<int> indices;
    for (const mapping::SubmapId& submap : graph.GetSubmapIds(id)) {
      indices.push_back(submap.submap_index);
    }
    int num_entered = trajectory.num_submaps.value_or(0);
    // A file may have loaded submaps in any order.
    if (trajectory.is_live && !indices.empty()) {
      num_entered = std::max(num_entered, indices.back() + 1);
    }
    for (const int index : submaps_in_graph_.Update(id, indices, num_entered)) {
      gone.push_back({id, index});
    }
  }
  return gone;
}

void Searcher::InjectReady(
    const std::function<bool(const SubmapId&)>& has_submap,
    const HostNodes& nodes) {
  std::vector<HostConstraint> constraints;
  for (LiveClosure& closure : closures_) {
    if (closure.closure.status != ClosureStatus::kReady) continue;
    int num_constraints = 0;
    bool is_gone = false;
    for (const Constraint& constraint : closure.closure.constraints) {
      is_gone = is_gone || submaps_.count(constraint.submap) == 0;
      const auto node = nodes.find(ToHost(constraint.node));
      if (!has_submap(constraint.submap) || node == nodes.end() ||
          (*node).data.constant_data == nullptr) {
        continue;
      }
      constraints.push_back(
          ToHost(constraint, (*node).data.constant_data->gravity_alignment));
      ++num_constraints;
    }
    if (num_constraints > 0) {
      closure.num_constraints = num_constraints;
      SetStatus(ClosureStatus::kInGraph, &closure);
      ++summary_.num_injected;
    } else if (is_gone) {
      SetStatus(ClosureStatus::kGone, &closure);
    }
    // Otherwise a submap is still on its way into the graph, or its nodes are
    // gone and it soon will be.
  }
  if (constraints.empty()) return;
  summary_.num_constraints += static_cast<int>(constraints.size());
  TheMetrics().constraints->Increment(static_cast<double>(constraints.size()));
  pose_graph_->AddSerializedConstraints(constraints);
}

void Searcher::RunFinalOptimization() {
  worker_.WaitUntilIdle();
  const auto is_ready = [](const LiveClosure& closure) {
    return closure.closure.status == ClosureStatus::kReady;
  };
  bool has_ready;
  int64_t num_announced;
  {
    const absl::MutexLock lock(&mutex_);
    has_ready = MayInject() && !is_shut_down_ &&
                std::any_of(closures_.begin(), closures_.end(), is_ready);
    num_announced = gate_.num_announced();
  }
  if (has_ready) {
    // The host processes its whole queue. Nodes are not added meanwhile: that
    // is the host's own condition for a final optimisation. So if nothing else
    // was announced by the end, no round comes between our look at the graph
    // and our constraints.
    const Announcement announcement(this);
    pose_graph_->RunFinalOptimization();
    const auto submaps = pose_graph_->GetAllSubmapPoses();
    const HostNodes nodes = pose_graph_->GetTrajectoryNodes();
    const absl::MutexLock lock(&mutex_);
    if (!is_shut_down_ && gate_.num_announced() == num_announced + 1 &&
        gate_.num_unsettled() == 1) {
      InjectReady(
          [&submaps](const SubmapId& id) {
            return submaps.Contains(ToHost(id));
          },
          nodes);
    }
  }
  const Announcement announcement(this);
  pose_graph_->RunFinalOptimization();
}

}  // namespace cartographer_sdf
