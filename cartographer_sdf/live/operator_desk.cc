// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/operator_desk.h"

#include <algorithm>
#include <utility>

#include "cartographer/transform/transform.h"
#include "cartographer_sdf/live/host_conversion.h"
#include "cartographer_sdf/live/worker.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

namespace mapping = cartographer::mapping;
using TrajectoryState = mapping::PoseGraphInterface::TrajectoryState;

// Trajectories that still grow, oldest first. The pose graph knows a trajectory
// from its first node on; a loaded one has no builder.
std::vector<int> ActiveTrajectories(LiveMapBuilder* const live) {
  std::vector<int> active;
  const auto states = live->pose_graph()->GetTrajectoryStates();
  for (int id = 0; id < live->num_trajectory_builders(); ++id) {
    const auto state = states.find(id);
    if (live->GetTrajectoryBuilder(id) != nullptr &&
        (state == states.end() || state->second == TrajectoryState::ACTIVE)) {
      active.push_back(id);
    }
  }
  return active;
}

}  // namespace

void OperatorDesk::SetMapBuilder(
    mapping::MapBuilderInterface* const map_builder) {
  live_ = AsLiveMapBuilder(map_builder);
}

void OperatorDesk::OnLocalization(const LocalizationResult& result) {
  const absl::MutexLock lock(&mutex_);
  results_.push_back(result);
}

std::vector<LocalizationResult> OperatorDesk::TakeResults() {
  const absl::MutexLock lock(&mutex_);
  return std::exchange(results_, {});
}

std::optional<int> OperatorDesk::NewestTrajectory() const {
  if (live_ == nullptr) return std::nullopt;
  const std::vector<int> active = ActiveTrajectories(live_);
  if (active.empty()) return std::nullopt;
  return active.back();
}

std::optional<LocalizationResult> OperatorDesk::GetLocalization(
    const int trajectory_id) const {
  if (live_ == nullptr) return std::nullopt;
  return live_->GetLocalization(trajectory_id);
}

std::optional<StartPose> OperatorDesk::GetStartPose(
    const int trajectory_id) const {
  if (live_ == nullptr) return std::nullopt;
  return live_->GetStartPose(trajectory_id);
}

bool OperatorDesk::SearchAgain(const int trajectory_id, const bool restart) {
  if (live_ == nullptr) return false;
  const std::vector<int> active = ActiveTrajectories(live_);
  if (std::count(active.begin(), active.end(), trajectory_id) == 0) {
    return false;
  }
  to_restart_.erase(trajectory_id);
  if (restart) to_restart_.insert(trajectory_id);
  live_->Localize(trajectory_id);
  return true;
}

int OperatorDesk::SearchForAll(const bool restart) {
  if (live_ == nullptr) return 0;
  int count = 0;
  for (const int id : ActiveTrajectories(live_)) {
    if (SearchAgain(id, restart)) ++count;
  }
  return count;
}

bool OperatorDesk::Restart(const LocalizationResult& result,
                           const TrajectoryActions& actions) {
  if (to_restart_.erase(result.trajectory_id) == 0 || !result.localized) {
    return false;
  }
  const std::optional<StartPose> start =
      live_->GetStartPose(result.trajectory_id);
  if (!start || !actions.finish(result.trajectory_id)) {
    LOG(WARNING) << "trajectory " << result.trajectory_id
                 << " cannot go on where it was found";
    return false;
  }
  mapping::proto::InitialTrajectoryPose initial_pose;
  initial_pose.set_to_trajectory_id(start->to_trajectory_id);
  *initial_pose.mutable_relative_pose() =
      cartographer::transform::ToProto(start->relative_pose);
  // Relative to the first node: before all of them.
  initial_pose.set_timestamp(0);
  actions.start(initial_pose);
  const std::optional<int> next = NewestTrajectory();
  if (!next) return false;
  live_->Localize(*next);
  LOG(INFO) << "trajectory " << result.trajectory_id << " goes on as " << *next
            << ", where it was found";
  return true;
}

std::vector<SegmentGroup> OperatorDesk::DrawMatches() const {
  if (live_ == nullptr) return {};
  std::map<SubmapId, Rigid2> T_map_submap;
  for (const auto& submap : live_->pose_graph()->GetAllSubmapPoses()) {
    T_map_submap[FromHost(submap.id)] = FromHost(submap.data.pose);
  }
  return cartographer_sdf::DrawMatches(
      live_->GetClosures(), live_->GetRefusedMatches(), T_map_submap);
}

NodeStatus OperatorDesk::DescribeStatus() {
  if (live_ == nullptr) return {true, "the searcher is not enabled", {}};
  const LiveSummary summary = live_->GetSummary();
  const double seconds = SecondsSince(last_status_);
  const double cpu_share =
      seconds > 0. ? (summary.worker_cpu_seconds - last_cpu_seconds_) / seconds
                   : 0.;
  last_status_ = std::chrono::steady_clock::now();
  last_cpu_seconds_ = summary.worker_cpu_seconds;
  const std::optional<int> newest = NewestTrajectory();
  return cartographer_sdf::DescribeStatus(
      summary, newest ? GetLocalization(*newest) : std::nullopt, cpu_share);
}

}  // namespace cartographer_sdf
