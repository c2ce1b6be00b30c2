// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The searcher beside a live pose graph: records trajectories, submaps and
// closures, schedules the worker's tasks, and adds constraints when that is
// safe (injection_gate.h).
//
// Threads: the host's sensor threads (OnLocalSlamResult), its pool threads
// (EnterRound, with the host's mutex held), our worker (tasks), and any thread
// for the other methods. Our mutex may be taken while the host's is held, so we
// never call a method of the host's pose graph that takes its mutex while we
// hold ours. AddSerializedConstraints takes a different mutex, that of the
// queue, which the host never holds while it calls us.

#ifndef CARTOGRAPHER_SDF_LIVE_SEARCHER_H_
#define CARTOGRAPHER_SDF_LIVE_SEARCHER_H_

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "cartographer/mapping/pose_graph.h"
#include "cartographer/mapping/pose_graph_trimmer.h"
#include "cartographer/mapping/trajectory_builder_interface.h"
#include "cartographer_sdf/live/background_search.h"
#include "cartographer_sdf/live/graph_submaps.h"
#include "cartographer_sdf/live/host_conversion.h"
#include "cartographer_sdf/live/injection_gate.h"
#include "cartographer_sdf/live/live_options.h"
#include "cartographer_sdf/live/map_builder.h"
#include "cartographer_sdf/live/scan_search.h"
#include "cartographer_sdf/live/worker.h"

namespace cartographer_sdf {

class Searcher : public std::enable_shared_from_this<Searcher> {
 public:
  using InsertionResult =
      cartographer::mapping::TrajectoryBuilderInterface::InsertionResult;

  // The pose graph (null if remote) must outlive everything but the hooks,
  // which it owns.
  Searcher(const LiveOptions& options,
           cartographer::mapping::PoseGraph* pose_graph,
           LocalizationCallback on_localization);

  // Scope around an event that starts a round or adds a trimmer.
  class Announcement {
   public:
    explicit Announcement(Searcher* searcher) : searcher_(searcher) {
      searcher_->Announce();
    }
    ~Announcement() { searcher_->Settle(); }
    Announcement(const Announcement&) = delete;
    Announcement& operator=(const Announcement&) = delete;

   private:
    Searcher* const searcher_;
  };

  void AddTrajectory(int trajectory_id, bool has_initial_pose, bool is_trimmed)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Called on the sensor thread. `insertion` may be null.
  void OnLocalSlamResult(int trajectory_id,
                         const cartographer::sensor::RangeData& range_data,
                         const InsertionResult* insertion)
      ABSL_LOCKS_EXCLUDED(mutex_);
  void FinishTrajectory(int trajectory_id, const std::function<void()>& forward)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Call before the trajectory is deleted.
  void ForgetTrajectory(int trajectory_id) ABSL_LOCKS_EXCLUDED(mutex_);
  // Call after a state was loaded. `trajectory_ids` are keyed by the ids in the
  // file; `path` is empty if there is no file.
  void OnStateLoaded(const std::map<int, int>& trajectory_ids, bool is_frozen,
                     const std::string& path) ABSL_LOCKS_EXCLUDED(mutex_);
  // Waits for the worker first, so that all its results are included.
  void RunFinalOptimization() ABSL_LOCKS_EXCLUDED(mutex_);
  // Stops the worker; nothing is added to the pose graph any more.
  void Shutdown() ABSL_LOCKS_EXCLUDED(mutex_);

  // Called by hooks, with the host's mutex held.
  void EnterRound(cartographer::mapping::Trimmable* graph, int generation)
      ABSL_LOCKS_EXCLUDED(mutex_);
  [[nodiscard]] bool IsHookObsolete(int generation) const
      ABSL_LOCKS_EXCLUDED(mutex_);

  // See LiveMapBuilder.
  [[nodiscard]] std::optional<LocalizationResult> GetLocalization(
      int trajectory_id) const ABSL_LOCKS_EXCLUDED(mutex_);
  void Localize(int trajectory_id) ABSL_LOCKS_EXCLUDED(mutex_);
  [[nodiscard]] std::optional<StartPose> GetStartPose(int trajectory_id) const
      ABSL_LOCKS_EXCLUDED(mutex_);
  void WaitUntilIdle() { worker_.WaitUntilIdle(); }
  [[nodiscard]] LiveSummary GetSummary() const ABSL_LOCKS_EXCLUDED(mutex_);
  [[nodiscard]] std::vector<ClosureRecord> GetClosures() const
      ABSL_LOCKS_EXCLUDED(mutex_);
  [[nodiscard]] std::vector<RefusedMatch> GetRefusedMatches() const
      ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  using HostSubmap = std::shared_ptr<const cartographer::mapping::Submap>;

  struct SubmapRecord {
    HostSubmap submap;  // until it is described
    OdometryPose odometry;
    // While it grows, all nodes; then those that may get constraints.
    std::vector<SubmapNode> nodes;
    double sum_of_distances = 0.;
    bool is_scheduled = false;
  };
  struct Trajectory {
    bool is_live = false;     // its nodes pass through us
    bool is_trimmed = false;  // its submaps are removed when it ends
    bool is_finished = false;
    int num_submaps = 0;  // so far, trimmed ones among them
    // Once a round calls a hook of this generation, all of them have entered
    // the pose graph, and no more will.
    std::optional<int> complete_generation;
    const cartographer::mapping::Submap* newest_submap = nullptr;
    std::vector<int> growing;  // indices of its submaps
    // Of the newest node.
    std::optional<Rigid2> T_local_tracking;
    cartographer::common::Time time;
    double distance_driven = 0.;
    // State of the localisation.
    bool is_searched = false;
    bool is_restarted = false;   // the worker must start again
    bool was_localized = false;  // before this search
    bool is_query_scheduled = false;
    double search_begin = 0.;         // distance driven at its start
    double next_query = 0.;           // distance driven
    std::vector<NodeWithScan> scans;  // not yet passed to the worker
    std::optional<LocalizationResult> localization;
    // State of the session that compares each scan with the map.
    std::deque<OdometryScan> waiting_scans;  // the newest
    bool is_session_scheduled = false;
    bool is_session_restarted = true;  // the worker must begin it anew
    // Its pose is the one that was found: where scans contradict it, the
    // trajectory is lost.
    bool is_followed = false;

    // Not clear(), which keeps the memory, for every trajectory there was.
    void DropScans() {
      std::vector<NodeWithScan>().swap(scans);
      std::deque<OdometryScan>().swap(waiting_scans);
    }
  };
  // A recorded closure; holds its constraints while they wait. Kept small:
  // without the inliers and rivals of its match.
  struct LiveClosure {
    Closure closure;
    int num_inliers = 0;
    int num_constraints = 0;
  };
  // Input of the worker's decision on closures, copied under the lock.
  struct ClosureSnapshot {
    std::vector<size_t> indices;  // into closures_
    std::vector<Closure> closures;
    std::map<SubmapId, OdometryPose> odometry;
    std::map<SubmapId, std::vector<SubmapNode>> nodes;
  };
  // What a round has to know of a trajectory.
  struct TrajectoryInRound {
    bool is_live = false;
    // Present if all have entered the pose graph, and no more will.
    std::optional<int> num_submaps;
  };
  using TrajectoriesInRound = std::map<int, TrajectoryInRound>;
  using HostNodes =
      cartographer::mapping::MapById<cartographer::mapping::NodeId,
                                     cartographer::mapping::TrajectoryNode>;
  // Number of nodes of live trajectories in a round.
  struct NodeCounts {
    int64_t num_done = 0;
    int64_t num_waiting = 0;
  };

  void Announce() ABSL_LOCKS_EXCLUDED(mutex_);
  void Settle() ABSL_LOCKS_EXCLUDED(mutex_);

  // Parts of OnLocalSlamResult.
  void FollowSubmaps(int trajectory_id, const InsertionResult& insertion,
                     Trajectory* trajectory)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Whether its scans are used to find it, or to notice that it is lost.
  [[nodiscard]] bool NeedsScans(const Trajectory& trajectory) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void CollectScan(int trajectory_id,
                   const cartographer::sensor::RangeData& range_data,
                   const InsertionResult& insertion, Trajectory* trajectory)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void QueueForSession(int trajectory_id, OdometryScan scan,
                       Trajectory* trajectory)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void ScheduleDescription(const SubmapId& id)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void BeginSearch(int trajectory_id, Trajectory* trajectory)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Of trajectories that were just loaded: one more than the last index.
  [[nodiscard]] std::map<int, int> CountSubmaps(
      const std::map<int, int>& trajectory_ids) const
      ABSL_LOCKS_EXCLUDED(mutex_);
  [[nodiscard]] static LiveClosure MakeLiveClosure(Closure closure);
  [[nodiscard]] static ClosureRecord MakeRecord(const LiveClosure& closure);
  void ForgetSubmap(const SubmapId& id) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void SetStatus(ClosureStatus status, LiveClosure* closure)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void LogClosure(const LiveClosure& closure) const
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  [[nodiscard]] bool MayInject() const {
    return options_.inject_constraints && pose_graph_ != nullptr;
  }

  // Parts of EnterRound.
  NodeCounts CountNodes(const TrajectoriesInRound& trajectories,
                        const cartographer::mapping::Trimmable& graph);
  std::vector<SubmapId> FindGone(const TrajectoriesInRound& trajectories,
                                 const cartographer::mapping::Trimmable& graph);
  // Injects the constraints of ready closures whose submaps and nodes exist.
  void InjectReady(const std::function<bool(const SubmapId&)>& has_submap,
                   const HostNodes& nodes)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  // Tasks of the worker and their parts.
  void CountPlaces() ABSL_LOCKS_EXCLUDED(mutex_);
  void CountQuery(double seconds, size_t num_candidates)
      ABSL_LOCKS_EXCLUDED(mutex_);
  void DescribeAndRecognize(const SubmapId& id) ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns whether there is a new closure.
  bool AddClosures(const SubmapId& id,
                   const PlaceRecognizer::Recognition& recognition)
      ABSL_LOCKS_EXCLUDED(mutex_);
  void UpdateClosures(const SubmapId& newest) ABSL_LOCKS_EXCLUDED(mutex_);
  // Keeps only the records of closures on which nothing is to be decided any
  // more, as one of their submaps is gone, or grew and never became a place.
  void RetireClosures() ABSL_LOCKS_EXCLUDED(mutex_);
  ClosureSnapshot TakeClosureSnapshot() const ABSL_LOCKS_EXCLUDED(mutex_);
  void ApplyDecisions(const SubmapId& newest, const ClosureSnapshot& before,
                      const std::vector<Closure>& decided)
      ABSL_LOCKS_EXCLUDED(mutex_);
  void DescribeLoaded(const std::map<int, int>& trajectory_ids, bool is_frozen,
                      const std::string& path) ABSL_LOCKS_EXCLUDED(mutex_);
  // Describes submaps that are missing in `places`, which is keyed by ids in
  // the file; returns whether there were any. None if the worker must stop.
  std::optional<bool> DescribeMissing(const std::map<int, int>& trajectory_ids,
                                      std::map<SubmapId, Place>* places)
      ABSL_LOCKS_EXCLUDED(mutex_);
  void RememberLoaded(const std::map<int, int>& trajectory_ids,
                      std::map<SubmapId, Place>&& places)
      ABSL_LOCKS_EXCLUDED(mutex_);
  void QueryLocalization(int trajectory_id) ABSL_LOCKS_EXCLUDED(mutex_);
  // The scans that a query starts with; empty if none is due.
  struct ScansOfQuery {
    std::vector<NodeWithScan> scans;
    bool is_restarted = false;
    double distance_driven = 0.;  // since the search began [m]
  };
  // Of a trajectory that is not searched for, none.
  std::optional<ScansOfQuery> TakeScans(int trajectory_id)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Adds them to the growing submap; returns the newest node, null if it has
  // none.
  NodeData AddScans(int trajectory_id, ScansOfQuery scans)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Stores the result; returns whether it completes the search.
  bool RecordQuery(const BackgroundSearch::Query& query, double cpu_seconds,
                   LocalizationResult* result) ABSL_LOCKS_EXCLUDED(mutex_);
  // Records the query; ends the search and reports where it succeeds.
  void ConcludeQuery(const BackgroundSearch::Query& query, double cpu_seconds,
                     LocalizationResult* result) ABSL_LOCKS_EXCLUDED(mutex_);
  void RefreshMapPoses() ABSL_LOCKS_EXCLUDED(mutex_);

  // Tasks of the worker on sessions, and their parts (searcher_sessions.cc).
  struct ScansOfSession {
    std::deque<OdometryScan> scans;
    bool is_restarted = false;
  };
  void DrawMap() ABSL_LOCKS_EXCLUDED(mutex_);
  void ContinueSession(int trajectory_id) ABSL_LOCKS_EXCLUDED(mutex_);
  ScansOfSession TakeSessionScans(int trajectory_id)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // What a located session means for its trajectory. (local <- robot of the
  // answer)
  void UseSession(int trajectory_id, const SessionAnswer& answer,
                  const Rigid2& T_local_robot) ABSL_LOCKS_EXCLUDED(mutex_);
  // If the trajectory is not searched for.
  void FollowSession(const Rigid2& T_map_local, Trajectory* trajectory)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void ConfirmSession(int trajectory_id, const SessionAnswer& answer,
                      const Rigid2& T_local_robot) ABSL_LOCKS_EXCLUDED(mutex_);
  // The same pose after the map has moved since it was drawn.
  [[nodiscard]] Rigid2 MoveWithMap(const Rigid2& T_map_robot) const;
  void LoseTrajectory(int trajectory_id) ABSL_LOCKS_EXCLUDED(mutex_);

  const LiveOptions options_;
  cartographer::mapping::PoseGraph* const pose_graph_;
  const LocalizationCallback on_localization_;

  mutable absl::Mutex mutex_;
  bool is_shut_down_ ABSL_GUARDED_BY(mutex_) = false;
  bool has_map_ ABSL_GUARDED_BY(mutex_) = false;
  InjectionGate gate_ ABSL_GUARDED_BY(mutex_);
  std::map<int, Trajectory> trajectories_ ABSL_GUARDED_BY(mutex_);
  std::map<SubmapId, SubmapRecord> submaps_ ABSL_GUARDED_BY(mutex_);
  // Only the worker's tasks remove any, so that indices hold within a task.
  std::vector<LiveClosure> closures_ ABSL_GUARDED_BY(mutex_);
  // The newest of those retired, for reports.
  std::deque<ClosureRecord> retired_closures_ ABSL_GUARDED_BY(mutex_);
  std::deque<RefusedMatch> refused_ ABSL_GUARDED_BY(mutex_);
  // Of loaded trajectories, so that the worker does not add them later.
  std::set<SubmapId> gone_ ABSL_GUARDED_BY(mutex_);
  LiveSummary summary_ ABSL_GUARDED_BY(mutex_);
  std::vector<float> callback_seconds_ ABSL_GUARDED_BY(mutex_);

  // Used only in rounds, which the host's mutex serialises.
  std::map<int, int> newest_node_done_;
  GraphSubmaps submaps_in_graph_;

  // Used only by the worker's tasks.
  BackgroundSearch search_;
  // Of loaded submaps; submaps without walls are absent.
  std::map<SubmapId, OdometryPose> map_odometry_;
  std::optional<MapLayout> map_layout_;
  bool map_moves_ = false;  // not all of it is frozen
  ScanSearch scan_search_;
  std::map<SubmapId, Rigid2> T_map_submap_drawn_;

  Worker worker_;  // last, so that it ends first
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_SEARCHER_H_
