// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/searcher.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include "cartographer_sdf/live/live_metrics.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

namespace mapping = cartographer::mapping;

// Maximum number of latest callback durations kept for the summary.
constexpr size_t kMaxNumDurations = 200000;

// Returns whether the closure is not in the graph but may still get there.
bool IsWaiting(const ClosureStatus status) {
  return status == ClosureStatus::kUnsupported ||
         status == ClosureStatus::kInconsistent ||
         status == ClosureStatus::kReady;
}

// Called by the host after each optimisation.
class Hook : public mapping::PoseGraphTrimmer {
 public:
  Hook(std::shared_ptr<Searcher> searcher, const int generation)
      : searcher_(std::move(searcher)), generation_(generation) {}

  void Trim(mapping::Trimmable* const graph) override {
    searcher_->EnterRound(graph, generation_);
  }
  bool IsFinished() override { return searcher_->IsHookObsolete(generation_); }

 private:
  const std::shared_ptr<Searcher> searcher_;
  const int generation_;
};

}  // namespace

Searcher::Searcher(const LiveOptions& options,
                   mapping::PoseGraph* const pose_graph,
                   LocalizationCallback on_localization)
    : options_(options),
      pose_graph_(pose_graph),
      on_localization_(std::move(on_localization)),
      search_(options),
      scan_search_(options.localization.scan_localization,
                   options.localization.scan_session) {}

void Searcher::Announce() {
  const absl::MutexLock lock(&mutex_);
  gate_.Announce();
}

void Searcher::Settle() {
  int generation;
  {
    const absl::MutexLock lock(&mutex_);
    generation = gate_.Settle();
    if (is_shut_down_) return;
  }
  if (pose_graph_ != nullptr) {
    pose_graph_->AddTrimmer(
        std::make_unique<Hook>(shared_from_this(), generation));
  }
}

void Searcher::AddTrajectory(const int trajectory_id,
                             const bool has_initial_pose,
                             const bool is_trimmed) {
  const absl::MutexLock lock(&mutex_);
  Trajectory& trajectory = trajectories_[trajectory_id];
  trajectory.is_live = true;
  trajectory.is_trimmed = is_trimmed;
  if (options_.localization.enabled && !has_initial_pose) {
    BeginSearch(trajectory_id, &trajectory);
  }
}

void Searcher::BeginSearch(const int trajectory_id,
                           Trajectory* const trajectory) {
  trajectory->was_localized =
      trajectory->was_localized ||
      (trajectory->localization && trajectory->localization->localized);
  trajectory->is_searched = true;
  trajectory->is_restarted = true;
  trajectory->DropScans();
  trajectory->is_session_restarted = true;
  trajectory->is_followed = false;
  trajectory->search_begin = trajectory->distance_driven;
  trajectory->next_query =
      trajectory->distance_driven + options_.localization.query_interval_meters;
  LocalizationResult result;
  result.trajectory_id = trajectory_id;
  result.was_localized = trajectory->was_localized;
  result.verdict = has_map_ ? LocalizationVerdict::kTooLittleSeen
                            : LocalizationVerdict::kNoMap;
  trajectory->localization = result;
}

void Searcher::OnLocalSlamResult(
    const int trajectory_id, const cartographer::sensor::RangeData& range_data,
    const InsertionResult* const insertion) {
  // Null if the scan was filtered out; empty if it comes from a remote builder.
  if (insertion == nullptr || insertion->constant_data == nullptr ||
      insertion->insertion_submaps.empty()) {
    return;
  }
  const auto begin = std::chrono::steady_clock::now();
  const absl::MutexLock lock(&mutex_);
  const auto found = trajectories_.find(trajectory_id);
  if (is_shut_down_ || found == trajectories_.end() ||
      found->second.is_finished) {
    return;
  }
  Trajectory& trajectory = found->second;
  const Rigid2 T_local_tracking =
      FromHost(insertion->constant_data->local_pose);
  if (trajectory.T_local_tracking) {
    trajectory.distance_driven += (T_local_tracking.translation() -
                                   trajectory.T_local_tracking->translation())
                                      .norm();
  }
  trajectory.T_local_tracking = T_local_tracking;
  trajectory.time = insertion->constant_data->time;
  FollowSubmaps(trajectory_id, *insertion, &trajectory);
  if (NeedsScans(trajectory)) {
    CollectScan(trajectory_id, range_data, *insertion, &trajectory);
  }
  const double seconds = SecondsSince(begin);
  callback_seconds_.resize(
      std::min(callback_seconds_.size() + 1, kMaxNumDurations));
  callback_seconds_[static_cast<size_t>(summary_.num_callbacks) %
                    kMaxNumDurations] = static_cast<float>(seconds);
  ++summary_.num_callbacks;
  summary_.callback_mean_seconds += seconds;  // the sum, until GetSummary
  summary_.callback_max_seconds =
      std::max(summary_.callback_max_seconds, seconds);
}

bool Searcher::NeedsScans(const Trajectory& trajectory) const {
  if (!has_map_) return false;
  const bool is_checked = options_.localization.compare_scans &&
                          trajectory.localization &&
                          trajectory.localization->localized;
  return trajectory.is_searched || is_checked;
}

void Searcher::FollowSubmaps(const int trajectory_id,
                             const InsertionResult& insertion,
                             Trajectory* const trajectory) {
  const auto& submaps = insertion.insertion_submaps;
  if (submaps.back().get() != trajectory->newest_submap) {
    // Same numbering as in the pose graph.
    const SubmapId id{trajectory_id, trajectory->num_submaps++};
    trajectory->newest_submap = submaps.back().get();
    trajectory->growing.push_back(id.index);
    SubmapRecord& record = submaps_[id];
    record.submap = submaps.back();
    record.odometry.T_local_submap = FromHost(submaps.back()->local_pose());
  }
  const Rigid2 T_local_node = LocalNodePose(*insertion.constant_data);
  while (trajectory->growing.size() > submaps.size()) {
    trajectory->growing.erase(trajectory->growing.begin());
  }
  for (const int index : trajectory->growing) {
    const auto found = submaps_.find({trajectory_id, index});
    if (found == submaps_.end()) continue;
    SubmapRecord& record = found->second;
    record.nodes.push_back(
        {FromHost(insertion.node_id),
         record.odometry.T_local_submap.Inverse() * T_local_node,
         insertion.constant_data});
    record.sum_of_distances += trajectory->distance_driven;
  }
  if (submaps.front()->insertion_finished() && !trajectory->growing.empty()) {
    ScheduleDescription({trajectory_id, trajectory->growing.front()});
    trajectory->growing.erase(trajectory->growing.begin());
  }
}

void Searcher::ScheduleDescription(const SubmapId& id) {
  const auto found = submaps_.find(id);
  if (found == submaps_.end() || found->second.is_scheduled) return;
  SubmapRecord& record = found->second;
  record.is_scheduled = true;
  if (!record.nodes.empty()) {
    record.odometry.distance_driven =
        record.sum_of_distances / static_cast<double>(record.nodes.size());
  }
  record.nodes = ThinOut(options_.constraints, record.nodes);
  worker_.Schedule([this, id] { DescribeAndRecognize(id); });
}

void Searcher::CollectScan(const int trajectory_id,
                           const cartographer::sensor::RangeData& range_data,
                           const InsertionResult& insertion,
                           Trajectory* const trajectory) {
  DrivenScan scan = MakeDrivenScan(insertion.node_id, *insertion.constant_data,
                                   range_data, trajectory->distance_driven);
  if (options_.localization.compare_scans) {
    QueueForSession(trajectory_id,
                    MakeOdometryScan(*insertion.constant_data, scan),
                    trajectory);
  }
  if (!trajectory->is_searched) return;
  trajectory->scans.push_back({insertion.constant_data, std::move(scan)});
  if (trajectory->is_query_scheduled ||
      trajectory->distance_driven < trajectory->next_query) {
    return;
  }
  trajectory->is_query_scheduled = true;
  worker_.Schedule([this, trajectory_id] { QueryLocalization(trajectory_id); });
}

void Searcher::FinishTrajectory(const int trajectory_id,
                                const std::function<void()>& forward) {
  {
    const Announcement announcement(this);
    forward();
  }
  const absl::MutexLock lock(&mutex_);
  const auto found = trajectories_.find(trajectory_id);
  const bool is_known = found != trajectories_.end();
  if (is_shut_down_ || !is_known || found->second.is_finished) return;
  Trajectory& trajectory = found->second;
  trajectory.is_finished = true;
  trajectory.complete_generation = gate_.newest_generation();
  // The growing submaps no longer change.
  if (!trajectory.is_trimmed) {
    for (const int index : trajectory.growing) {
      ScheduleDescription({trajectory_id, index});
    }
  }
  trajectory.growing.clear();
  if (trajectory.is_searched && has_map_) {
    trajectory.localization->verdict = LocalizationVerdict::kFinished;
    TheMetrics().localizations.Increment(LocalizationVerdict::kFinished);
    worker_.Schedule([this, result = *trajectory.localization] {
      search_.StopLocalizing(result.trajectory_id);
      if (on_localization_) on_localization_(result);
    });
    LOG(INFO) << "trajectory " << trajectory_id
              << " ended before it was localised in the map";
  }
  trajectory.is_searched = false;
  trajectory.DropScans();
  worker_.Schedule([this, trajectory_id] { scan_search_.Stop(trajectory_id); });
}

void Searcher::ForgetTrajectory(const int trajectory_id) {
  const absl::MutexLock lock(&mutex_);
  std::vector<SubmapId> ids;
  for (const auto& [id, record] : submaps_) {
    if (id.trajectory == trajectory_id) ids.push_back(id);
  }
  for (const SubmapId& id : ids) ForgetSubmap(id);
  // Closures of growing submaps, which have no record.
  ForgetSubmap({trajectory_id, kGrowingSubmapIndex});
  const auto found = trajectories_.find(trajectory_id);
  if (found == trajectories_.end()) return;
  found->second.is_finished = true;
  found->second.is_searched = false;
  found->second.DropScans();
  worker_.Schedule([this, trajectory_id] { scan_search_.Stop(trajectory_id); });
}

void Searcher::ForgetSubmap(const SubmapId& id) {
  const auto trajectory = trajectories_.find(id.trajectory);
  if (trajectory == trajectories_.end() || !trajectory->second.is_live) {
    gone_.insert(id);
  }
  submaps_.erase(id);
  for (LiveClosure& closure : closures_) {
    const PairPose& pair = closure.closure.match.pair;
    if (IsWaiting(closure.closure.status) &&
        (pair.reference == id || pair.query == id)) {
      SetStatus(ClosureStatus::kGone, &closure);
    }
  }
  worker_.Schedule([this, id] {
    search_.Forget(id);
    map_odometry_.erase(id);
    if (map_layout_) map_layout_->T_map_submap.erase(id);
    RetireClosures();
    CountPlaces();
  });
}

Searcher::LiveClosure Searcher::MakeLiveClosure(Closure closure) {
  LiveClosure live;
  live.num_inliers = static_cast<int>(closure.match.inliers.size());
  live.num_constraints = static_cast<int>(closure.constraints.size());
  live.closure = std::move(closure);
  // Not clear(), which keeps the memory.
  decltype(Match::inliers)().swap(live.closure.match.inliers);
  decltype(Match::rivals)().swap(live.closure.match.rivals);
  return live;
}

ClosureRecord Searcher::MakeRecord(const LiveClosure& closure) {
  const Match& match = closure.closure.match;
  return {match.pair, match.evidence, closure.num_inliers,
          closure.closure.status, closure.num_constraints};
}

void Searcher::SetStatus(const ClosureStatus status,
                         LiveClosure* const closure) {
  if (closure->closure.status == status) return;
  closure->closure.status = status;
  TheMetrics().closures.Increment(status);
  if (status != ClosureStatus::kReady) {
    std::vector<Constraint>().swap(closure->closure.constraints);
  }
}

void Searcher::LogClosure(const LiveClosure& closure) const {
  if (!options_.log_closures) return;
  const Match& match = closure.closure.match;
  LOG(INFO) << "closure of submap " << match.pair.query << " with "
            << match.pair.reference << ": "
            << ClosureStatusName(closure.closure.status) << ", score "
            << match.pair.score << ", " << closure.num_inliers
            << " inliers, overlap " << match.evidence.overlap
            << ", wall distance " << match.evidence.WallDistance() << " m, "
            << closure.num_constraints << " constraints";
}

std::map<int, int> Searcher::CountSubmaps(
    const std::map<int, int>& trajectory_ids) const {
  const auto poses = pose_graph_->GetAllSubmapPoses();
  std::map<int, int> num_submaps;
  for (const auto& entry : trajectory_ids) {
    const int trajectory_id = entry.second;
    if (poses.SizeOfTrajectoryOrZero(trajectory_id) == 0) continue;
    num_submaps[trajectory_id] =
        (*std::prev(poses.EndOfTrajectory(trajectory_id))).id.submap_index + 1;
  }
  return num_submaps;
}

void Searcher::OnStateLoaded(const std::map<int, int>& trajectory_ids,
                             const bool is_frozen, const std::string& path) {
  std::map<int, int> num_submaps;
  if (pose_graph_ != nullptr) num_submaps = CountSubmaps(trajectory_ids);
  const absl::MutexLock lock(&mutex_);
  if (is_shut_down_) return;
  for (const auto& entry : trajectory_ids) {
    Trajectory& trajectory = trajectories_[entry.second];
    trajectory.num_submaps = num_submaps[entry.second];
    trajectory.complete_generation = gate_.newest_generation();
  }
  if (pose_graph_ == nullptr) return;
  has_map_ = true;
  for (auto& [id, trajectory] : trajectories_) {
    // Earlier driving does not count: its scans were not collected.
    if (trajectory.is_searched) BeginSearch(id, &trajectory);
  }
  worker_.Schedule([this, trajectory_ids, is_frozen, path] {
    DescribeLoaded(trajectory_ids, is_frozen, path);
  });
}

void Searcher::Shutdown() {
  {
    const absl::MutexLock lock(&mutex_);
    if (is_shut_down_) return;
    is_shut_down_ = true;
  }
  worker_.Stop();
  const LiveSummary summary = GetSummary();
  LOG(INFO) << "searched " << summary.num_submaps
            << " submaps: " << summary.num_candidates << " candidates, "
            << summary.num_closures << " closures, of which "
            << summary.num_injected << " were injected as "
            << summary.num_constraints << " constraints; "
            << summary.worker_cpu_seconds << " s of the worker, at most "
            << 1e3 * summary.callback_p99_seconds
            << " ms added to 99 % of the local SLAM results";
}

std::optional<LocalizationResult> Searcher::GetLocalization(
    const int trajectory_id) const {
  const absl::MutexLock lock(&mutex_);
  const auto found = trajectories_.find(trajectory_id);
  if (found == trajectories_.end()) return std::nullopt;
  return found->second.localization;
}

void Searcher::Localize(const int trajectory_id) {
  const absl::MutexLock lock(&mutex_);
  const auto found = trajectories_.find(trajectory_id);
  if (is_shut_down_ || found == trajectories_.end() || !found->second.is_live ||
      found->second.is_finished) {
    LOG(WARNING) << "trajectory " << trajectory_id
                 << " is not active and cannot be localised";
    return;
  }
  BeginSearch(trajectory_id, &found->second);
}

std::optional<StartPose> Searcher::GetStartPose(const int trajectory_id) const {
  StartPose start;
  Rigid2 T_map_tracking;
  {
    const absl::MutexLock lock(&mutex_);
    const auto found = trajectories_.find(trajectory_id);
    if (found == trajectories_.end()) return std::nullopt;
    const Trajectory& trajectory = found->second;
    if (!trajectory.localization || !trajectory.localization->localized) {
      return std::nullopt;
    }
    start.to_trajectory_id = trajectory.localization->reference->trajectory;
    start.time = trajectory.time;
    T_map_tracking =
        *trajectory.localization->T_map_local * *trajectory.T_local_tracking;
  }
  const auto nodes = pose_graph_->GetTrajectoryNodePoses();
  if (nodes.SizeOfTrajectoryOrZero(start.to_trajectory_id) == 0) {
    return std::nullopt;
  }
  const cartographer::transform::Rigid3d& T_map_first =
      nodes.BeginOfTrajectory(start.to_trajectory_id)->data.global_pose;
  start.relative_pose = T_map_first.inverse() * ToHost(T_map_tracking);
  return start;
}

LiveSummary Searcher::GetSummary() const {
  const double cpu_seconds = worker_.CpuSeconds();
  const size_t num_waiting_tasks = worker_.NumWaiting();
  const absl::MutexLock lock(&mutex_);
  LiveSummary summary = summary_;
  summary.worker_cpu_seconds = cpu_seconds;
  summary.num_waiting_tasks = num_waiting_tasks;
  if (summary.num_callbacks > 0) {
    summary.callback_mean_seconds /= static_cast<double>(summary.num_callbacks);
    std::vector<float> seconds = callback_seconds_;
    const auto p99 = seconds.begin() + static_cast<std::ptrdiff_t>(
                                           (seconds.size() - 1) * 99 / 100);
    std::nth_element(seconds.begin(), p99, seconds.end());
    summary.callback_p99_seconds = *p99;
  }
  return summary;
}

std::vector<ClosureRecord> Searcher::GetClosures() const {
  const absl::MutexLock lock(&mutex_);
  std::vector<ClosureRecord> records(retired_closures_.begin(),
                                     retired_closures_.end());
  std::transform(closures_.begin(), closures_.end(),
                 std::back_inserter(records), MakeRecord);
  return records;
}

std::vector<RefusedMatch> Searcher::GetRefusedMatches() const {
  const absl::MutexLock lock(&mutex_);
  return {refused_.begin(), refused_.end()};
}

}  // namespace cartographer_sdf
