// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The worker's tasks.

#include <algorithm>
#include <chrono>
#include <utility>

#include "absl/strings/str_format.h"
#include "cartographer_sdf/config/options.h"
#include "cartographer_sdf/live/live_metrics.h"
#include "cartographer_sdf/live/searcher.h"
#include "cartographer_sdf/place_store/place_file.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

namespace mapping = cartographer::mapping;

// Number of latest closures that are searched for consistency: time grows with
// its square.
constexpr size_t kMaxNumClosuresToAgree = 400;
// Fraction of the distance driven that counts as drifting odometry in a loaded
// map: its loops are closed.
constexpr double kDriftOfMaps = 0.2;
// Latest candidates that are kept to be shown.
constexpr size_t kMaxNumRefused = 200;
// Latest closures of submaps that are gone, which are kept for reports.
constexpr size_t kMaxNumRetiredClosures = 10000;
constexpr char kPlaceFileSuffix[] = ".places";
// In a long search, the interval between queries is this fraction of the
// distance driven since it began.
constexpr double kQueryBackoff = 0.05;

// Sets the result of a query for the trajectory.
void FillIn(const BackgroundSearch::Query& query,
            const mapping::TrajectoryNode::Data& newest,
            const int min_num_queries, LocalizationResult* const result) {
  const Localization& found = query.localization;
  result->verdict = found.verdict;
  result->reason = found.reason;
  if (found.placements.empty()) return;
  const Placement& best = found.placements.front();
  result->T_map_local = best.T_map_query * query.T_local_query.Inverse();
  const Rigid2 T_local_tracking = FromHost(newest.local_pose);
  result->T_map_tracking = *result->T_map_local * T_local_tracking;
  result->covariance = query.covariance;
  const auto runner_up = std::find_if(
      found.placements.begin() + 1, found.placements.end(),
      [](const Placement& placement) { return placement.is_rival; });
  if (runner_up != found.placements.end()) {
    result->T_map_runner_up = runner_up->T_map_query *
                              query.T_local_query.Inverse() * T_local_tracking;
  }
  result->score = best.score;
  result->runner_up_score = found.runner_up_score.value_or(0.);
  result->reference = found.matches[best.votes.front()].pair.reference;
  result->localized = !query.closures.empty();
  if (found.verdict == LocalizationVerdict::kLocalized && !result->localized) {
    result->verdict = LocalizationVerdict::kUncertain;
    result->reason =
        query.num_certain < min_num_queries
            ? absl::StrFormat(
                  "%d of the %d queries in a row that are needed "
                  "agree",
                  query.num_certain, min_num_queries)
            : "the scans of too few nodes fit where the matches put them";
  }
}

}  // namespace

void Searcher::CountPlaces() {
  TheMetrics().places->Set(static_cast<double>(search_.places().size()));
  const absl::MutexLock lock(&mutex_);
  summary_.num_places = static_cast<int>(search_.places().size());
}

void Searcher::CountQuery(const double seconds, const size_t num_candidates) {
  TheMetrics().queries->Increment();
  TheMetrics().candidates->Increment(static_cast<double>(num_candidates));
  TheMetrics().query_seconds->Observe(seconds);
  const absl::MutexLock lock(&mutex_);
  ++summary_.num_queries;
  summary_.num_candidates += static_cast<int>(num_candidates);
}

void Searcher::DescribeAndRecognize(const SubmapId& id) {
  HostSubmap submap;
  {
    const absl::MutexLock lock(&mutex_);
    const auto found = submaps_.find(id);
    if (is_shut_down_ || found == submaps_.end()) return;
    submap = std::exchange(found->second.submap, nullptr);
  }
  const auto describe_begin = std::chrono::steady_clock::now();
  const std::optional<OccupancyGrid> grid = CopyGrid(*submap);
  submap.reset();
  std::optional<Place> place;
  if (grid) place = search_.Describe(id, *grid);
  TheMetrics().submaps->Increment();
  TheMetrics().describe_seconds->Observe(SecondsSince(describe_begin));
  std::map<SubmapId, OdometryPose> odometry;
  {
    const absl::MutexLock lock(&mutex_);
    ++summary_.num_submaps;
    for (const auto& [other, record] : submaps_) {
      odometry[other] = record.odometry;
    }
  }
  if (!place) {
    LOG(INFO) << "submap " << id << " shows no walls and is skipped";
    return;
  }
  search_.Remember(*std::move(place));
  CountPlaces();
  const auto begin = std::chrono::steady_clock::now();
  const PlaceRecognizer::Recognition recognition =
      search_.Recognize(id, odometry);
  CountQuery(SecondsSince(begin), recognition.num_candidates);
  if (AddClosures(id, recognition)) UpdateClosures(id);
}

bool Searcher::AddClosures(const SubmapId& id,
                           const PlaceRecognizer::Recognition& recognition) {
  const absl::MutexLock lock(&mutex_);
  bool has_closures = false;
  for (const Match& match : recognition.matches) {
    TheMetrics().matches.Increment(match.verdict);
    ++summary_.num_matches[VerdictName(match.verdict)];
    // A submap was forgotten meanwhile, or is about to be.
    if (submaps_.count(match.pair.reference) == 0 || submaps_.count(id) == 0) {
      continue;
    }
    if (match.verdict != Verdict::kAccepted) {
      if (match.verdict == Verdict::kTooLittleOverlap) continue;
      refused_.push_back({match.pair, match.verdict});
      if (refused_.size() > kMaxNumRefused) refused_.pop_front();
      continue;
    }
    closures_.push_back(
        MakeLiveClosure({match, ClosureStatus::kUnsupported, {}, {}}));
    ++summary_.num_closures;
    has_closures = true;
  }
  return has_closures;
}

Searcher::ClosureSnapshot Searcher::TakeClosureSnapshot() const {
  ClosureSnapshot snapshot;
  const absl::MutexLock lock(&mutex_);
  for (size_t k = closures_.size();
       k-- > 0 && snapshot.indices.size() < kMaxNumClosuresToAgree;) {
    const Closure& closure = closures_[k].closure;
    const auto reference = submaps_.find(closure.match.pair.reference);
    const auto query = submaps_.find(closure.match.pair.query);
    if (closure.status == ClosureStatus::kScansDisagree ||
        reference == submaps_.end() || query == submaps_.end()) {
      continue;
    }
    snapshot.indices.push_back(k);
    snapshot.closures.push_back(closure);
    for (const auto& submap : {reference, query}) {
      snapshot.odometry[submap->first] = submap->second.odometry;
      snapshot.nodes[submap->first] = submap->second.nodes;
    }
  }
  return snapshot;
}

void Searcher::UpdateClosures(const SubmapId& newest) {
  const ClosureSnapshot snapshot = TakeClosureSnapshot();
  std::vector<Closure> decided = snapshot.closures;
  for (const size_t k :
       SelectClosures(options_.consistency, snapshot.odometry, {}, &decided)) {
    LOG(WARNING) << "the closure of submap " << decided[k].match.pair.query
                 << " with " << decided[k].match.pair.reference
                 << " is in the pose graph, but others now contradict it";
  }
  for (size_t k = 0; k < decided.size(); ++k) {
    // It already has its constraints.
    if (snapshot.closures[k].status == ClosureStatus::kReady &&
        decided[k].status == ClosureStatus::kSelected) {
      decided[k].status = ClosureStatus::kReady;
    }
  }
  search_.GenerateConstraints(snapshot.nodes, &decided);
  ApplyDecisions(newest, snapshot, decided);
}

void Searcher::ApplyDecisions(const SubmapId& newest,
                              const ClosureSnapshot& before,
                              const std::vector<Closure>& decided) {
  const absl::MutexLock lock(&mutex_);
  for (size_t k = decided.size(); k-- > 0;) {
    LiveClosure& closure = closures_[before.indices[k]];
    // Skip closures whose status changed meanwhile.
    if (closure.closure.status != before.closures[k].status) continue;
    const bool is_new = decided[k].match.pair.query == newest;
    if (decided[k].status == closure.closure.status && !is_new) continue;
    if (decided[k].status == ClosureStatus::kInGraph &&
        before.closures[k].status != ClosureStatus::kInGraph) {
      closure.num_constraints = static_cast<int>(decided[k].constraints.size());
      closure.closure.constraints = decided[k].constraints;
      SetStatus(
          MayInject() ? ClosureStatus::kReady : ClosureStatus::kDetectedOnly,
          &closure);
    } else {
      SetStatus(decided[k].status, &closure);
    }
    LogClosure(closure);
  }
}

void Searcher::RetireClosures() {
  const absl::MutexLock lock(&mutex_);
  std::vector<LiveClosure> kept;
  for (LiveClosure& live : closures_) {
    const PairPose& pair = live.closure.match.pair;
    const bool has_places =
        submaps_.count(pair.reference) > 0 && submaps_.count(pair.query) > 0;
    if (has_places || live.closure.status == ClosureStatus::kReady) {
      kept.push_back(std::move(live));
      continue;
    }
    retired_closures_.push_back(MakeRecord(live));
    if (retired_closures_.size() > kMaxNumRetiredClosures) {
      retired_closures_.pop_front();
    }
  }
  closures_ = std::move(kept);
}

void Searcher::DescribeLoaded(const std::map<int, int>& trajectory_ids,
                              const bool is_frozen, const std::string& path) {
  std::map<SubmapId, Place> places;  // by ids in the file
  std::optional<PlaceFileKey> key;
  if (options_.use_place_files && !path.empty()) {
    absl::StatusOr<PlaceFileKey> made = MakePlaceFileKey(
        path, FormatPlaceOptions(options_.place, options_.match));
    if (made.ok()) {
      key = *std::move(made);
      absl::StatusOr<std::map<SubmapId, Place>> read =
          ReadPlaces(path + kPlaceFileSuffix, *key);
      if (read.ok()) {
        places = *std::move(read);
      } else if (!absl::IsNotFound(read.status())) {
        LOG(INFO) << read.status().message()
                  << "; describing its submaps again";
      }
    }
  }
  if (!is_frozen) map_moves_ = true;
  const std::optional<bool> has_new = DescribeMissing(trajectory_ids, &places);
  if (!has_new) return;
  if (key && *has_new) {
    const absl::Status status =
        WritePlaces(path + kPlaceFileSuffix, *key, places);
    if (!status.ok()) LOG(WARNING) << status.message();
  }
  RememberLoaded(trajectory_ids, std::move(places));
  if (options_.localization.enabled && options_.localization.compare_scans) {
    DrawMap();
  }
}

std::optional<bool> Searcher::DescribeMissing(
    const std::map<int, int>& trajectory_ids,
    std::map<SubmapId, Place>* const places) {
  const auto submaps = pose_graph_->GetAllSubmapData();
  bool has_new = false;
  for (const auto& [id_in_file, trajectory_id] : trajectory_ids) {
    double distance = 0.;
    std::optional<Eigen::Vector2d> position;
    for (const auto& submap : submaps.trajectory(trajectory_id)) {
      if (submap.data.submap == nullptr) continue;
      const SubmapId id = FromHost(submap.id);
      const SubmapId id_of_file{id_in_file, id.index};
      if (places->count(id_of_file) == 0) {
        const std::optional<OccupancyGrid> grid = CopyGrid(*submap.data.submap);
        std::optional<Place> place;
        if (grid) place = search_.Describe(id_of_file, *grid);
        const absl::MutexLock lock(&mutex_);
        ++summary_.num_submaps;
        if (!place) continue;
        has_new = true;
        places->emplace(id_of_file, *std::move(place));
      }
      SubmapRecord record;
      record.is_scheduled = true;
      record.odometry.T_local_submap = FromHost(submap.data.pose);
      const Eigen::Vector2d& p_map =
          record.odometry.T_local_submap.translation();
      if (position) distance += (p_map - *position).norm();
      position = p_map;
      record.odometry.distance_driven = kDriftOfMaps * distance;
      const absl::MutexLock lock(&mutex_);
      if (is_shut_down_) return std::nullopt;
      if (gone_.count(id) > 0) continue;
      map_odometry_[id] = record.odometry;
      submaps_[id] = std::move(record);
    }
  }
  return has_new;
}

void Searcher::RememberLoaded(const std::map<int, int>& trajectory_ids,
                              std::map<SubmapId, Place>&& places) {
  size_t num_places = 0;
  for (auto& [id_of_file, place] : places) {
    const auto trajectory_id = trajectory_ids.find(id_of_file.trajectory);
    if (trajectory_id == trajectory_ids.end()) continue;
    const SubmapId id{trajectory_id->second, id_of_file.index};
    if (map_odometry_.count(id) == 0) continue;
    place.id = id;
    search_.Remember(std::move(place));
    ++num_places;
  }
  PoseGraph graph = ConstraintsFromHost(pose_graph_->constraints());
  for (const auto& [id, pose] : map_odometry_) {
    graph.submap_poses[id] = pose.T_local_submap;
  }
  map_layout_ = MakeMapLayout(graph, map_odometry_, search_.places());
  CountPlaces();
  LOG(INFO) << num_places << " submaps of the loaded map can be recognised";
}

void Searcher::RefreshMapPoses() {
  if (!map_moves_ || !map_layout_) return;
  const auto poses = pose_graph_->GetAllSubmapPoses();
  for (auto& [id, T_map_submap] : map_layout_->T_map_submap) {
    const auto pose = poses.find(ToHost(id));
    if (pose != poses.end()) T_map_submap = FromHost((*pose).data.pose);
  }
}

std::optional<Searcher::ScansOfQuery> Searcher::TakeScans(
    const int trajectory_id) {
  const absl::MutexLock lock(&mutex_);
  Trajectory& trajectory = trajectories_.at(trajectory_id);
  if (is_shut_down_ || !trajectory.is_searched) return std::nullopt;
  ScansOfQuery result;
  result.scans = std::move(trajectory.scans);
  trajectory.scans.clear();
  result.is_restarted = trajectory.is_restarted;
  trajectory.is_restarted = false;
  result.distance_driven = trajectory.distance_driven - trajectory.search_begin;
  return result;
}

NodeData Searcher::AddScans(const int trajectory_id, ScansOfQuery scans) {
  if (scans.is_restarted) search_.StartLocalizing(trajectory_id);
  search_.AddScans(trajectory_id, std::move(scans.scans));
  return search_.NewestNode(trajectory_id);
}

void Searcher::QueryLocalization(const int trajectory_id) {
  {
    const absl::MutexLock lock(&mutex_);
    trajectories_.at(trajectory_id).is_query_scheduled = false;
  }
  std::optional<ScansOfQuery> taken = TakeScans(trajectory_id);
  if (!taken) return;
  const double cpu_begin = ThreadCpuSeconds();
  const auto begin = std::chrono::steady_clock::now();
  LocalizationResult result;
  result.trajectory_id = trajectory_id;
  result.distance_driven = taken->distance_driven;
  const NodeData newest = AddScans(trajectory_id, *std::move(taken));
  if (newest == nullptr) return;
  result.time = newest->time;
  RefreshMapPoses();
  BackgroundSearch::Query query;
  if (map_odometry_.empty() || !map_layout_) {
    result.verdict = LocalizationVerdict::kNoMap;
  } else {
    query = search_.Localize(trajectory_id, *map_layout_);
    FillIn(query, *newest, options_.localization.min_num_queries, &result);
  }
  CountQuery(SecondsSince(begin), query.num_candidates);
  TheMetrics().localizations.Increment(result.verdict);
  ConcludeQuery(query, ThreadCpuSeconds() - cpu_begin, &result);
}

void Searcher::ConcludeQuery(const BackgroundSearch::Query& query,
                             const double cpu_seconds,
                             LocalizationResult* const result) {
  if (!RecordQuery(query, cpu_seconds, result)) return;
  RetireClosures();  // of earlier searches
  search_.StopLocalizing(result->trajectory_id);
  LOG(INFO) << "trajectory " << result->trajectory_id
            << " is localised in the map at " << *result->T_map_tracking
            << " after " << result->distance_driven << " m and "
            << result->num_queries << " queries, score " << result->score
            << ", the next best pose " << result->runner_up_score;
  if (on_localization_) on_localization_(*result);
}

bool Searcher::RecordQuery(const BackgroundSearch::Query& query,
                           const double cpu_seconds,
                           LocalizationResult* const result) {
  const absl::MutexLock lock(&mutex_);
  Trajectory& trajectory = trajectories_.at(result->trajectory_id);
  // The search ended or was restarted meanwhile.
  if (!trajectory.is_searched || trajectory.is_restarted) return false;
  result->was_localized = trajectory.was_localized;
  result->num_queries = trajectory.localization->num_queries + 1;
  result->cpu_seconds = trajectory.localization->cpu_seconds + cpu_seconds;
  trajectory.localization = *result;
  trajectory.next_query = trajectory.distance_driven +
                          std::max(options_.localization.query_interval_meters,
                                   kQueryBackoff * result->distance_driven);
  if (!result->localized) return false;
  trajectory.is_searched = false;
  std::vector<NodeWithScan>().swap(trajectory.scans);
  // If the trajectory was localised before, constraints from before the
  // kidnapping would pull against those from after it.
  const bool may_inject = MayInject() && !trajectory.was_localized;
  for (const Closure& found : query.closures) {
    LiveClosure closure = MakeLiveClosure(found);
    SetStatus(may_inject ? ClosureStatus::kReady : ClosureStatus::kDetectedOnly,
              &closure);
    LogClosure(closure);
    closures_.push_back(std::move(closure));
    ++summary_.num_closures;
  }
  return true;
}

}  // namespace cartographer_sdf
