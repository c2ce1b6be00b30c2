// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/operator_desk.h"

#include <algorithm>
#include <utility>

#include "cartographer_sdf/live/host_conversion.h"
#include "cartographer_sdf/live/worker.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

namespace mapping = cartographer::mapping;
using TrajectoryState = mapping::PoseGraphInterface::TrajectoryState;

}  // namespace

void OperatorDesk::SetMapBuilder(
    mapping::MapBuilderInterface* const map_builder) {
  live_ = AsLiveMapBuilder(map_builder);
}

void OperatorDesk::OnLocalization(const LocalizationResult& result) {
  const absl::MutexLock lock(&mutex_);
  results_.push_back(result);
}

std::vector<int> OperatorDesk::ActiveTrajectories() const {
  std::vector<int> active;
  const auto states = live_->pose_graph()->GetTrajectoryStates();
  for (int id = 0; id < live_->num_trajectory_builders(); ++id) {
    const auto state = states.find(id);
    if (ended_.count(id) == 0 && live_->GetTrajectoryBuilder(id) != nullptr &&
        (state == states.end() || state->second == TrajectoryState::ACTIVE)) {
      active.push_back(id);
    }
  }
  return active;
}

std::vector<LocalizationResult> OperatorDesk::TakeResults() {
  const absl::MutexLock lock(&mutex_);
  return std::exchange(results_, {});
}

std::optional<int> OperatorDesk::NewestTrajectory() const {
  if (live_ == nullptr) return std::nullopt;
  const std::vector<int> active = ActiveTrajectories();
  if (active.empty()) return std::nullopt;
  return active.back();
}

std::optional<LocalizationResult> OperatorDesk::GetLocalization(
    const int trajectory_id) const {
  if (live_ == nullptr) return std::nullopt;
  std::optional<LocalizationResult> result =
      live_->GetLocalization(trajectory_id);
  if (result && carried_away_.count(trajectory_id) > 0) {
    result->was_localized = true;
  }
  return result;
}

std::optional<StartPose> OperatorDesk::GetStartPose(
    const int trajectory_id) const {
  if (live_ == nullptr) return std::nullopt;
  return live_->GetStartPose(trajectory_id);
}

std::optional<int> OperatorDesk::SearchAgain(
    const int trajectory_id, const std::optional<TrajectoryActions>& restart) {
  if (live_ == nullptr) return std::nullopt;
  const std::vector<int> active = ActiveTrajectories();
  if (std::count(active.begin(), active.end(), trajectory_id) == 0) {
    return std::nullopt;
  }
  if (!restart) {
    live_->Localize(trajectory_id);
    return trajectory_id;
  }
  if (!restart->finish(trajectory_id)) return std::nullopt;
  ended_.insert(trajectory_id);
  restart->start();
  const std::optional<int> next = NewestTrajectory();
  if (!next) return std::nullopt;
  // It is searched for already, unless options say otherwise.
  if (!live_->GetLocalization(*next)) live_->Localize(*next);
  carried_away_.insert(*next);
  LOG(INFO) << "trajectory " << trajectory_id << " ended, as the robot was "
            << "carried away; trajectory " << *next << " is searched for";
  return next;
}

int OperatorDesk::SearchForAll(
    const std::optional<TrajectoryActions>& restart) {
  if (live_ == nullptr) return 0;
  int count = 0;
  for (const int id : ActiveTrajectories()) {
    if (SearchAgain(id, restart)) ++count;
  }
  return count;
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
