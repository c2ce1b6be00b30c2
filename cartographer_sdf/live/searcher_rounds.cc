// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The part of the searcher that meets the host's pose graph: what is left of it
// after each optimisation, and when constraints are added to it.

#include <algorithm>
#include <iterator>
#include <utility>

#include "cartographer_sdf/live/live_metrics.h"
#include "cartographer_sdf/live/searcher.h"
#include "glog/logging.h"

namespace cartographer_sdf {

namespace mapping = cartographer::mapping;

bool Searcher::IsHookObsolete(const int generation) const {
  const absl::MutexLock lock(&mutex_);
  return gate_.IsObsolete(generation);
}

void Searcher::EnterRound(mapping::Trimmable* const graph,
                          const int generation) {
  std::set<int> live, loaded;
  {
    const absl::MutexLock lock(&mutex_);
    if (is_shut_down_) return;
    for (const auto& [id, trajectory] : trajectories_) {
      (trajectory.is_live ? live : loaded).insert(id);
    }
  }
  // Without our mutex, so that sensor threads don't wait for it. No node is
  // added meanwhile, as the host's mutex is held.
  const NodeCounts counts = CountNodes(live, loaded, *graph);
  const std::vector<SubmapId> gone = FindGone(live, loaded, *graph);
  const absl::MutexLock lock(&mutex_);
  if (is_shut_down_) return;
  for (const SubmapId& id : gone) ForgetSubmap(id);
  if (!gate_.EnterRound(generation, counts.num_done, counts.num_waiting) ||
      !MayInject()) {
    return;
  }
  const auto& nodes = graph->GetTrajectoryNodes();
  InjectReady(
      [this](const SubmapId& id) {
        const auto submaps = submaps_in_graph_.find(id.trajectory);
        return submaps != submaps_in_graph_.end() &&
               submaps->second.count(id.index) > 0;
      },
      [&nodes](const NodeId& id) {
        const auto node = nodes.find(ToHost(id));
        return node != nodes.end() && (*node).data.constant_data != nullptr;
      });
}

// Work on a node ends with its intra-submap constraints.
Searcher::NodeCounts Searcher::CountNodes(
    const std::set<int>& live_trajectories,
    const std::set<int>& loaded_trajectories, const mapping::Trimmable& graph) {
  const auto& nodes = graph.GetTrajectoryNodes();
  NodeCounts counts;
  std::map<int, int> newest, unknown;
  for (const int trajectory : nodes.trajectory_ids()) {
    if (loaded_trajectories.count(trajectory) > 0) continue;
    if (live_trajectories.count(trajectory) == 0) {
      // Not known to us: any of them may wait.
      counts.num_waiting +=
          static_cast<int64_t>(nodes.SizeOfTrajectoryOrZero(trajectory));
      continue;
    }
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
    const std::set<int>& live_trajectories,
    const std::set<int>& loaded_trajectories, const mapping::Trimmable& graph) {
  std::vector<SubmapId> gone;
  const auto compare = [&](const int trajectory, const bool is_live) {
    std::set<int>& known = submaps_in_graph_[trajectory];
    // Loaded trajectories don't grow.
    if (!is_live && !known.empty() &&
        graph.num_submaps(trajectory) == static_cast<int>(known.size())) {
      return;
    }
    std::set<int> now;
    for (const mapping::SubmapId& id : graph.GetSubmapIds(trajectory)) {
      now.insert(id.submap_index);
    }
    for (const int index : known) {
      if (now.count(index) == 0) gone.push_back({trajectory, index});
    }
    known = std::move(now);
  };
  for (const int trajectory : live_trajectories) compare(trajectory, true);
  for (const int trajectory : loaded_trajectories) compare(trajectory, false);
  return gone;
}

void Searcher::InjectReady(
    const std::function<bool(const SubmapId&)>& has_submap,
    const std::function<bool(const NodeId&)>& has_node) {
  std::vector<HostConstraint> constraints;
  for (LiveClosure& closure : closures_) {
    if (closure.closure.status != ClosureStatus::kReady) continue;
    size_t num_constraints = 0;
    bool is_gone = false;
    for (const HostConstraint& constraint : closure.constraints) {
      const SubmapId submap = FromHost(constraint.submap_id);
      is_gone = is_gone || gone_.count(submap) > 0;
      if (!has_submap(submap) || !has_node(FromHost(constraint.node_id))) {
        continue;
      }
      constraints.push_back(constraint);
      ++num_constraints;
    }
    if (num_constraints > 0) {
      closure.num_constraints = static_cast<int>(num_constraints);
      SetStatus(ClosureStatus::kInGraph, &closure);
      ++summary_.num_injected;
    } else if (is_gone) {
      SetStatus(ClosureStatus::kGone, &closure);
    }
    // Else a submap is still on its way into the graph, or its nodes are gone
    // and it soon will be.
  }
  if (constraints.empty()) return;
  summary_.num_constraints += static_cast<int>(constraints.size());
  CountConstraints(static_cast<double>(constraints.size()));
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
    // The host does all that waits in its queue. Nodes are not added meanwhile,
    // as that is the host's own condition for a final optimisation; so where
    // nothing else was announced by the time we are done, no round comes
    // between our look at the graph and our constraints.
    const Announcement announcement(this);
    pose_graph_->RunFinalOptimization();
    const auto submaps = pose_graph_->GetAllSubmapPoses();
    const auto nodes = pose_graph_->GetTrajectoryNodePoses();
    const absl::MutexLock lock(&mutex_);
    if (!is_shut_down_ && gate_.num_announced() == num_announced + 1 &&
        gate_.num_unsettled() == 1) {
      InjectReady(
          [&submaps](const SubmapId& id) {
            return submaps.Contains(ToHost(id));
          },
          [&nodes](const NodeId& id) {
            const auto node = nodes.find(ToHost(id));
            return node != nodes.end() &&
                   (*node).data.constant_pose_data.has_value();
          });
    }
  }
  const Announcement announcement(this);
  pose_graph_->RunFinalOptimization();
}

}  // namespace cartographer_sdf
