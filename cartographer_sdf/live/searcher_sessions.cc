// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The part of the searcher that compares each scan with the whole loaded map:
// what sessions find is confirmed by submaps and reported like what queries
// find, and where scans contradict it, the trajectory is lost.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/geometry/distinct_poses.h"
#include "cartographer_sdf/live/host_conversion.h"
#include "cartographer_sdf/live/live_metrics.h"
#include "cartographer_sdf/live/searcher.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// A scan that waits longer is no news of where the robot is.
constexpr size_t kMaxNumWaitingScans = 20;
// Poses nearer than this mean the same place; both may be off [m], [rad].
constexpr PoseTolerance kSamePose{1., 0.2};
// Probabilities are no more certain than this when they become log-odds.
constexpr double kLeastProbability = 1e-6;

// Log-odds against the robot being elsewhere, as LocalizationResult has them.
double ScoreOf(const ScanLocalization& found, const double probability) {
  return std::log(
      std::max(probability, kLeastProbability) /
      std::max(found.elsewhere_probability.value_or(1.), kLeastProbability));
}

}  // namespace

void Searcher::QueueForSession(const int trajectory_id, OdometryScan scan,
                               Trajectory* const trajectory) {
  if (trajectory->waiting_scans.size() >= kMaxNumWaitingScans) {
    trajectory->waiting_scans.pop_front();
    ++summary_.num_dropped_scans;
    TheMetrics().dropped_scans->Increment();
  }
  trajectory->waiting_scans.push_back(std::move(scan));
  if (std::exchange(trajectory->is_session_scheduled, true)) return;
  worker_.Schedule([this, trajectory_id] { ContinueSession(trajectory_id); });
}

void Searcher::DrawMap() {
  std::vector<int> loaded;
  {
    const absl::MutexLock lock(&mutex_);
    for (const auto& [id, trajectory] : trajectories_) {
      if (!trajectory.is_live) loaded.push_back(id);
    }
  }
  scan_search_.SetMap(
      DrawLoadedMap(options_.localization.scan_localization.viewpoints,
                    *pose_graph_, loaded));
  RefreshMapPoses();
  T_map_submap_drawn_ = map_layout_->T_map_submap;
  if (!scan_search_.HasMap()) {
    LOG(WARNING) << "scans cannot be compared with the loaded map: it has no "
                    "walls, or no place for a robot";
  }
}

Searcher::ScansOfSession Searcher::TakeSessionScans(const int trajectory_id) {
  ScansOfSession taken;
  const absl::MutexLock lock(&mutex_);
  Trajectory& trajectory = trajectories_.at(trajectory_id);
  trajectory.is_session_scheduled = false;
  if (is_shut_down_ || trajectory.is_finished) return taken;
  taken.scans.swap(trajectory.waiting_scans);
  if (taken.scans.empty()) return taken;
  taken.is_restarted = std::exchange(trajectory.is_session_restarted, false);
  return taken;
}

void Searcher::ContinueSession(const int trajectory_id) {
  if (!scan_search_.HasMap() || !map_layout_) {
    const absl::MutexLock lock(&mutex_);
    trajectories_.at(trajectory_id).is_session_scheduled = false;
    return;
  }
  const ScansOfSession taken = TakeSessionScans(trajectory_id);
  if (taken.scans.empty()) return;
  const double cpu_begin = ThreadCpuSeconds();
  if (taken.is_restarted) scan_search_.Start(trajectory_id);
  SessionAnswer answer;
  bool is_lost = false;
  int num_looks = 0;
  for (const OdometryScan& scan : taken.scans) {
    ScanSearch::Step step = scan_search_.Add(trajectory_id, scan);
    is_lost = is_lost || step.is_lost;
    answer = std::move(step.answer);
    num_looks += answer.use == ScanUse::kCompared ? 1 : 0;
  }
  TheMetrics().looks->Increment(num_looks);
  {
    const absl::MutexLock lock(&mutex_);
    summary_.num_looks += num_looks;
    Trajectory& trajectory = trajectories_.at(trajectory_id);
    if (trajectory.is_searched) {
      trajectory.localization->cpu_seconds += ThreadCpuSeconds() - cpu_begin;
    }
  }
  if (is_lost) LoseTrajectory(trajectory_id);
  if (!answer.T_map_robot) return;
  UseSession(trajectory_id, answer, taken.scans.back().T_odometry_robot);
}

void Searcher::UseSession(const int trajectory_id, const SessionAnswer& answer,
                          const Rigid2& T_local_robot) {
  {
    const absl::MutexLock lock(&mutex_);
    const Trajectory& trajectory = trajectories_.at(trajectory_id);
    if (trajectory.is_session_restarted || trajectory.is_followed) return;
  }
  RefreshMapPoses();
  {
    const absl::MutexLock lock(&mutex_);
    Trajectory& trajectory = trajectories_.at(trajectory_id);
    if (!trajectory.is_searched) {
      FollowSession(MoveWithMap(*answer.T_map_robot) * T_local_robot.Inverse(),
                    &trajectory);
      return;
    }
  }
  // The latest looks by themselves must say so, as several queries must.
  if (answer.localization.verdict == LocalizationVerdict::kLocalized &&
      answer.num_looks >= options_.localization.min_num_queries) {
    ConfirmSession(trajectory_id, answer, T_local_robot);
  }
}

void Searcher::FollowSession(const Rigid2& T_map_local,
                             Trajectory* const trajectory) {
  const std::optional<LocalizationResult>& found = trajectory->localization;
  if (!found || !found->localized) return;
  const Rigid2& T_local_tracking = *trajectory->T_local_tracking;
  trajectory->is_followed = AreNear(*found->T_map_local * T_local_tracking,
                                    T_map_local * T_local_tracking,
                                    Eigen::Vector2d::Zero(), kSamePose);
}

void Searcher::ConfirmSession(const int trajectory_id,
                              const SessionAnswer& answer,
                              const Rigid2& T_local_robot) {
  const double cpu_begin = ThreadCpuSeconds();
  std::optional<ScansOfQuery> taken = TakeScans(trajectory_id);
  if (!taken) return;
  LocalizationResult result;
  result.trajectory_id = trajectory_id;
  result.distance_driven = taken->distance_driven;
  const NodeData newest = AddScans(trajectory_id, *std::move(taken));
  if (newest == nullptr) return;
  const Rigid2 T_robot_local = T_local_robot.Inverse();
  const Rigid2 T_map_local = MoveWithMap(*answer.T_map_robot) * T_robot_local;
  const BackgroundSearch::Query query =
      search_.ConfirmPose(trajectory_id, *map_layout_, T_map_local);
  // Asked again with the next scan.
  if (query.closures.empty()) return;
  result.time = newest->time;
  result.localized = true;
  result.verdict = LocalizationVerdict::kLocalized;
  result.reason = absl::StrFormat(
      "of all poses in the map, only this one explains the latest %d scans",
      answer.num_looks);
  result.T_map_local = T_map_local;
  result.T_map_tracking = T_map_local * FromHost(newest->local_pose);
  result.reference = query.closures.front().match.pair.reference;
  const std::vector<ScanCandidate>& candidates = answer.localization.candidates;
  result.score = ScoreOf(answer.localization, candidates.front().probability);
  result.covariance = candidates.front().covariance;
  if (candidates.size() > 1) {
    result.runner_up_score =
        ScoreOf(answer.localization, candidates[1].probability);
    result.T_map_runner_up = MoveWithMap(candidates[1].T_map_robot) *
                             T_robot_local * FromHost(newest->local_pose);
  }
  TheMetrics().localizations.Increment(result.verdict);
  ConcludeQuery(query, ThreadCpuSeconds() - cpu_begin, &result);
  const absl::MutexLock lock(&mutex_);
  trajectories_.at(trajectory_id).is_followed = true;
}

Rigid2 Searcher::MoveWithMap(const Rigid2& T_map_robot) const {
  if (!map_moves_) return T_map_robot;
  const Rigid2* nearest_drawn = nullptr;
  const Rigid2* nearest_now = nullptr;
  double least_distance = std::numeric_limits<double>::infinity();
  for (const auto& [id, T_map_submap] : map_layout_->T_map_submap) {
    const auto drawn = T_map_submap_drawn_.find(id);
    if (drawn == T_map_submap_drawn_.end()) continue;
    const double distance =
        (drawn->second.translation() - T_map_robot.translation()).norm();
    if (distance >= least_distance) continue;
    least_distance = distance;
    nearest_drawn = &drawn->second;
    nearest_now = &T_map_submap;
  }
  if (nearest_drawn == nullptr) return T_map_robot;
  return *nearest_now * nearest_drawn->Inverse() * T_map_robot;
}

void Searcher::LoseTrajectory(const int trajectory_id) {
  LocalizationResult result;
  {
    const absl::MutexLock lock(&mutex_);
    Trajectory& trajectory = trajectories_.at(trajectory_id);
    if (!trajectory.is_followed || trajectory.is_searched ||
        trajectory.is_finished || trajectory.is_session_restarted) {
      return;
    }
    BeginSearch(trajectory_id, &trajectory);
    // It has begun anew by itself.
    trajectory.is_session_restarted = false;
    trajectory.localization->verdict = LocalizationVerdict::kContradicted;
    trajectory.localization->reason =
        "the latest scans contradict the pose that was found: the robot was "
        "carried away, or local SLAM went astray";
    trajectory.localization->time = trajectory.time;
    result = *trajectory.localization;
  }
  TheMetrics().localizations.Increment(result.verdict);
  LOG(WARNING) << "trajectory " << trajectory_id
               << " is lost: " << result.reason;
  if (on_localization_) on_localization_(result);
}

}  // namespace cartographer_sdf
