// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The tasks that the searcher gives its worker.

#include <algorithm>
#include <chrono>
#include <utility>

#include "cartographer_sdf/live/live_metrics.h"
#include "cartographer_sdf/live/searcher.h"
#include "cartographer_sdf/place_store/place_file.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

namespace mapping = cartographer::mapping;

// Fewer scans that fit do not bear out a closure.
constexpr size_t kMinNumConstraints = 3;
// Of the latest so many closures, those that agree are looked for: time grows
// with the square.
constexpr size_t kMaxNumClosuresToAgree = 400;
// Fraction of what was driven for a loaded map that counts as odometry that
// drifts: its loops are closed.
constexpr double kDriftOfMaps = 0.2;
constexpr char kPlaceFileSuffix[] = ".places";
// A query of a search that has gone on for long comes after so much of what was
// driven since it began.
constexpr double kQueryBackoff = 0.05;

double SecondsSince(const std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin)
      .count();
}

std::vector<HostConstraint> ConstraintsToHost(
    const std::vector<Constraint>& constraints,
    const std::map<NodeId, Eigen::Quaterniond>& gravity_alignments) {
  std::vector<HostConstraint> result;
  for (const Constraint& constraint : constraints) {
    result.push_back(
        ToHost(constraint, gravity_alignments.at(constraint.node)));
  }
  return result;
}

// What places depend on.
std::string PlaceOptionsText(const LiveOptions& options) {
  LiveOptions relevant;
  relevant.place = options.place;
  relevant.match = options.match;
  return FormatLiveOptions(relevant);
}

// By ids as in the map; empty where there are none that fit.
std::map<SubmapId, Place> ReadPlacesOf(const PlaceFileKey& key,
                                       const std::string& places_path) {
  absl::StatusOr<std::map<SubmapId, Place>> places =
      ReadPlaces(places_path, key);
  if (places.ok()) return *std::move(places);
  if (!absl::IsNotFound(places.status())) {
    LOG(INFO) << places.status().message()
              << "; its submaps are described anew";
  }
  return {};
}

}  // namespace

void Searcher::DescribeAndRecognize(const SubmapId& id) {
  HostSubmap submap;
  {
    const absl::MutexLock lock(&mutex_);
    const auto found = submaps_.find(id);
    if (is_shut_down_ || found == submaps_.end()) return;
    submap = std::move(found->second.submap);
    found->second.submap.reset();
  }
  const auto begin = std::chrono::steady_clock::now();
  const std::optional<OccupancyGrid> grid = CopyGrid(*submap);
  submap.reset();
  std::optional<Place> place;
  if (grid) place = search_.Describe(id, *grid);
  CountDescribedSubmap(SecondsSince(begin));
  if (!place) {
    LOG(INFO) << "submap " << id << " shows no walls, and is left out";
    const absl::MutexLock lock(&mutex_);
    ++summary_.num_submaps;
    return;
  }
  const auto query_begin = std::chrono::steady_clock::now();
  const BackgroundSearch::Found found = search_.Recognize(*place);
  CountQuery(SecondsSince(query_begin),
             static_cast<double>(found.num_candidates));
  search_.Remember(*std::move(place));
  SetNumPlaces(static_cast<double>(search_.places().size()));
  bool has_closures = false;
  {
    const absl::MutexLock lock(&mutex_);
    ++summary_.num_submaps;
    ++summary_.num_queries;
    summary_.num_candidates += static_cast<int>(found.num_candidates);
    summary_.num_places = static_cast<int>(search_.places().size());
    for (const Match& match : found.matches) {
      CountMatch(match.verdict);
      ++summary_.num_matches[VerdictName(match.verdict)];
      if (match.verdict != Verdict::kAccepted) continue;
      // Forgotten meanwhile, or about to be.
      if (submaps_.count(match.closure.reference) == 0 ||
          submaps_.count(id) == 0) {
        continue;
      }
      closures_.push_back({{match.closure, ClosureFate::kPending, 0}, {}});
      has_closures = true;
    }
  }
  if (has_closures) SelectAndLift(id);
}

void Searcher::SelectAndLift(const SubmapId& newest) {
  std::vector<size_t> indices;
  std::vector<LoopClosure> closures;
  std::map<SubmapId, OdometryPose> odometry;
  {
    const absl::MutexLock lock(&mutex_);
    for (size_t k = closures_.size();
         k-- > 0 && indices.size() < kMaxNumClosuresToAgree;) {
      const ClosureRecord& record = closures_[k].record;
      const LoopClosure& closure = record.closure;
      const auto reference = submaps_.find(closure.reference);
      const auto query = submaps_.find(closure.query);
      if (record.fate == ClosureFate::kScansDisagree ||
          reference == submaps_.end() || query == submaps_.end()) {
        continue;
      }
      odometry[closure.reference] = reference->second.odometry;
      odometry[closure.query] = query->second.odometry;
      indices.push_back(k);
      closures.push_back(closure);
    }
  }
  const std::vector<SelectionResult> selections =
      SelectConsistent(options_.consistency, odometry, closures);
  for (size_t k = closures.size(); k-- > 0;) {
    std::vector<SubmapNode> reference_nodes, query_nodes;
    {
      const absl::MutexLock lock(&mutex_);
      Closure& closure = closures_[indices[k]];
      const ClosureFate fate = closure.record.fate;
      const bool is_undecided = fate == ClosureFate::kPending ||
                                fate == ClosureFate::kContradicted ||
                                fate == ClosureFate::kReady;
      const bool is_new = closure.record.closure.query == newest;
      if (selections[k].selection != Selection::kSelected) {
        if (is_undecided) {
          SetFate(selections[k].selection == Selection::kContradicted
                      ? ClosureFate::kContradicted
                      : ClosureFate::kPending,
                  &closure);
          if (is_new) LogClosure(closure);
        } else if (fate == ClosureFate::kInjected &&
                   selections[k].selection == Selection::kContradicted) {
          LOG(WARNING) << "the closure of submap " << closures[k].query
                       << " with " << closures[k].reference
                       << " is in the pose graph, but is now contradicted by "
                          "others";
        }
        continue;
      }
      if (!is_undecided || fate == ClosureFate::kReady) continue;
      const auto reference = submaps_.find(closures[k].reference);
      const auto query = submaps_.find(closures[k].query);
      if (reference == submaps_.end() || query == submaps_.end()) continue;
      reference_nodes = reference->second.nodes;
      query_nodes = query->second.nodes;
    }
    std::map<NodeId, Eigen::Quaterniond> gravity_alignments;
    for (const auto* const nodes : {&reference_nodes, &query_nodes}) {
      for (const SubmapNode& node : *nodes) {
        gravity_alignments[node.id] = node.data->gravity_alignment;
      }
    }
    const std::vector<Constraint> constraints =
        search_.Lift(closures[k], reference_nodes, query_nodes);
    const absl::MutexLock lock(&mutex_);
    Closure& closure = closures_[indices[k]];
    if (closure.record.fate == ClosureFate::kGone) continue;
    if (constraints.size() < kMinNumConstraints) {
      SetFate(ClosureFate::kScansDisagree, &closure);
    } else if (!MayInject()) {
      SetFate(ClosureFate::kDetectedOnly, &closure);
    } else {
      closure.constraints = ConstraintsToHost(constraints, gravity_alignments);
      closure.record.num_constraints = static_cast<int>(constraints.size());
      SetFate(ClosureFate::kReady, &closure);
    }
    LogClosure(closure);
  }
}

void Searcher::DescribeLoaded(const std::map<int, int>& trajectory_ids,
                              const bool is_frozen, const std::string& path) {
  std::map<SubmapId, Place> places;  // by ids in the file
  PlaceFileKey key;
  const bool has_key = options_.use_place_files && !path.empty();
  if (has_key) {
    absl::StatusOr<PlaceFileKey> made =
        MakePlaceFileKey(path, PlaceOptionsText(options_));
    if (made.ok()) {
      key = *std::move(made);
      places = ReadPlacesOf(key, path + kPlaceFileSuffix);
    }
  }
  const auto submaps = pose_graph_->GetAllSubmapData();
  if (!is_frozen) map_moves_ = true;
  bool has_new = false;
  for (const auto& [id_in_file, trajectory_id] : trajectory_ids) {
    double distance = 0.;
    std::optional<Eigen::Vector2d> position;
    for (const auto& submap : submaps.trajectory(trajectory_id)) {
      if (IsStopping()) return;
      if (submap.data.submap == nullptr) continue;
      const SubmapId id = FromHost(submap.id);
      const SubmapId id_of_file{id_in_file, id.index};
      if (places.count(id_of_file) == 0) {
        const std::optional<OccupancyGrid> grid = CopyGrid(*submap.data.submap);
        std::optional<Place> place;
        if (grid) place = search_.Describe(id_of_file, *grid);
        const absl::MutexLock lock(&mutex_);
        ++summary_.num_submaps;
        if (!place) continue;
        has_new = true;
        places.emplace(id_of_file, *std::move(place));
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
      if (gone_.count(id) > 0) continue;
      map_poses_[id] = record.odometry.T_local_submap;
      submaps_[id] = std::move(record);
    }
  }
  if (has_key && has_new) {
    const absl::Status status =
        WritePlaces(path + kPlaceFileSuffix, key, places);
    if (!status.ok()) LOG(WARNING) << status.message();
  }
  size_t num_places = 0;
  for (auto& [id_of_file, place] : places) {
    const auto trajectory_id = trajectory_ids.find(id_of_file.trajectory);
    if (trajectory_id == trajectory_ids.end()) continue;
    const SubmapId id{trajectory_id->second, id_of_file.index};
    if (map_poses_.count(id) == 0) continue;
    place.id = id;
    search_.Remember(std::move(place));
    ++num_places;
  }
  SetNumPlaces(static_cast<double>(search_.places().size()));
  const absl::MutexLock lock(&mutex_);
  summary_.num_places = static_cast<int>(search_.places().size());
  LOG(INFO) << num_places << " submaps of the loaded map can be recognised";
}

void Searcher::RefreshMapPoses() {
  if (!map_moves_) return;
  const auto poses = pose_graph_->GetAllSubmapPoses();
  for (auto& [id, T_map_submap] : map_poses_) {
    const auto pose = poses.find(ToHost(id));
    if (pose != poses.end()) T_map_submap = FromHost((*pose).data.pose);
  }
}

void Searcher::QueryLocation(const int trajectory_id) {
  std::vector<PlacedScan> scans;
  bool is_restarted = false;
  double distance_driven = 0.;
  {
    const absl::MutexLock lock(&mutex_);
    Trajectory& trajectory = trajectories_.at(trajectory_id);
    trajectory.is_query_scheduled = false;
    if (is_shut_down_ || !trajectory.is_searched || trajectory.scans.empty()) {
      return;
    }
    scans = std::move(trajectory.scans);
    trajectory.scans.clear();
    is_restarted = trajectory.is_restarted;
    trajectory.is_restarted = false;
    distance_driven = trajectory.distance_driven - trajectory.search_begin;
  }
  const double cpu_begin = ThreadCpuSeconds();
  const auto begin = std::chrono::steady_clock::now();
  if (is_restarted) search_.StartLocalizing(trajectory_id);
  const auto newest = scans.back().data;
  search_.AddScans(trajectory_id, std::move(scans));
  RefreshMapPoses();
  BackgroundSearch::Localization outcome =
      search_.Localize(trajectory_id, map_poses_);

  LocalizationResult result;
  result.trajectory_id = trajectory_id;
  result.time = newest->time;
  result.distance_driven = distance_driven;
  bool is_certain = false;
  for (const auto& constraints : outcome.constraints) {
    is_certain = is_certain || constraints.size() >= kMinNumConstraints;
  }
  if (outcome.location) {
    result.T_map_local =
        outcome.location->T_map_query * outcome.T_local_query.Inverse();
    result.T_map_node = *result.T_map_local * LocalNodePose(*newest);
    result.score = outcome.location->score;
    result.runner_up_score = outcome.location->runner_up_score;
    result.reference = outcome.reference;
  }
  const LocalizationOptions& options = options_.localization;
  if (map_poses_.empty()) {
    result.reason = LocalizationReason::kNoMap;
  } else if (!outcome.has_seen_walls) {
    result.reason = LocalizationReason::kNotEnoughSeen;
  } else if (!outcome.location) {
    result.reason = LocalizationReason::kNoMatch;
  } else if (result.score - result.runner_up_score < options.min_lead) {
    result.reason = LocalizationReason::kAmbiguous;
  } else if (!is_certain) {
    result.reason = LocalizationReason::kUncertain;
  } else {
    result.reason = LocalizationReason::kLocated;
    result.located = true;
  }
  CountQuery(SecondsSince(begin), static_cast<double>(outcome.num_candidates));
  CountLocalization(result.reason);

  {
    const absl::MutexLock lock(&mutex_);
    ++summary_.num_queries;
    summary_.num_candidates += static_cast<int>(outcome.num_candidates);
    Trajectory& trajectory = trajectories_.at(trajectory_id);
    // Ended, or asked anew meanwhile.
    if (!trajectory.is_searched || trajectory.is_restarted) return;
    result.num_queries = trajectory.localization->num_queries + 1;
    result.cpu_seconds =
        trajectory.localization->cpu_seconds + ThreadCpuSeconds() - cpu_begin;
    trajectory.localization = result;
    trajectory.next_query =
        trajectory.distance_driven + std::max(options.query_interval_meters,
                                              kQueryBackoff * distance_driven);
    if (!result.located) return;
    trajectory.is_searched = false;
    trajectory.scans.clear();
    // Once it has been in the map, constraints of before the kidnapping would
    // pull against those of after it.
    const bool may_inject = MayInject() && !trajectory.was_located;
    for (size_t k = 0; k < outcome.closures.size(); ++k) {
      Closure closure{{outcome.closures[k], ClosureFate::kPending, 0}, {}};
      closure.record.num_constraints =
          static_cast<int>(outcome.constraints[k].size());
      if (may_inject) {
        closure.constraints = ConstraintsToHost(outcome.constraints[k],
                                                outcome.gravity_alignments);
      }
      SetFate(may_inject ? ClosureFate::kReady : ClosureFate::kDetectedOnly,
              &closure);
      LogClosure(closure);
      closures_.push_back(std::move(closure));
    }
  }
  search_.StopLocalizing(trajectory_id);
  LOG(INFO) << "trajectory " << trajectory_id << " is located in the map at "
            << *result.T_map_node << " after " << result.distance_driven
            << " m and " << result.num_queries << " queries, score "
            << result.score << ", the next best pose "
            << result.runner_up_score;
  if (on_localization_) on_localization_(result);
}

}  // namespace cartographer_sdf
