// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The global constraint searcher beside a live, stock Cartographer. A program
// that owns a map builder adopts it with one line:
//
//   map_builder = cartographer_sdf::CreateMapBuilder(std::move(map_builder),
//                                                    options);
//
// A worker thread describes every finished submap and recognises it among all
// others; closures become constraints of the pose graph. Trajectories that
// start after a map was loaded are localised in it.

#ifndef CARTOGRAPHER_SDF_LIVE_MAP_BUILDER_H_
#define CARTOGRAPHER_SDF_LIVE_MAP_BUILDER_H_

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cartographer/common/time.h"
#include "cartographer/mapping/map_builder_interface.h"
#include "cartographer/metrics/family_factory.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_sdf/closing/closure.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/live/live_options.h"
#include "cartographer_sdf/localization/localizer.h"
#include "cartographer_sdf/verification/judgement.h"

namespace cartographer_sdf {

// Result of the latest query for a trajectory.
struct LocalizationResult {
  int trajectory_id = 0;
  // Whether the pose below is reliable: enough consecutive queries agreed.
  bool localized = false;
  // Verdict of the latest query; also kUncertain while too few queries agree.
  LocalizationVerdict verdict = LocalizationVerdict::kTooLittleSeen;
  std::string reason;  // human-readable
  // Whether the trajectory had been localised before this search began, and may
  // have been carried away.
  bool was_localized = false;
  // Time of the newest scan used.
  cartographer::common::Time time;
  // The best pose so far; none if nothing matches. Reliable only if
  // `localized`. Pose in the map of the tracking frame at `time`.
  std::optional<Rigid2> T_map_tracking;
  // Of x, y [m^2] in the map frame and of the heading [rad^2] of that pose, if
  // it is the right one: large along what the walls seen do not hold.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  // The pose of the trajectory's local frame, which stays valid while local
  // SLAM does not drift.
  std::optional<Rigid2> T_map_local;
  // Where the tracking frame would be by the best placement that this pose
  // excludes; none if there is none.
  std::optional<Rigid2> T_map_runner_up;
  // Score of the best placement, and of the best one that it excludes, 0 if
  // there is none; log-odds.
  double score = 0.;
  double runner_up_score = 0.;
  // The best matching submap of the map.
  std::optional<SubmapId> reference;
  int num_queries = 0;
  double distance_driven = 0.;  // since the search began [m]
  double cpu_seconds = 0.;      // of all queries of the search
};

// The pose with which a new trajectory goes on where a localised one is now, as
// `initial_trajectory_pose` of Cartographer's options and /start_trajectory of
// cartographer_ros expect it.
struct StartPose {
  int to_trajectory_id = 0;  // of the map
  // (first node of that trajectory <- tracking frame at `time`)
  cartographer::transform::Rigid3d relative_pose;
  // Time of the newest node of the localised trajectory.
  cartographer::common::Time time;
};

// Called on the worker thread, with no lock held, once when a search ends,
// localised or not, and when a trajectory is lost, which begins a search. Must
// not destroy the builder.
using LocalizationCallback = std::function<void(const LocalizationResult&)>;

struct ClosureRecord {
  PairPose pair;
  PairEvidence evidence;
  int num_inliers = 0;
  ClosureStatus status = ClosureStatus::kUnsupported;
  int num_constraints = 0;
};

// A candidate that verification did not accept, where it came closest.
struct RefusedMatch {
  PairPose pair;
  Verdict verdict = Verdict::kUnlikely;
};

struct LiveSummary {
  int num_places = 0;   // in the index now
  int num_submaps = 0;  // described since the start
  int num_queries = 0;
  int num_candidates = 0;
  int num_looks = 0;  // scans that were compared with the whole map
  // Scans that were not, because too many waited.
  int num_dropped_scans = 0;
  // Number of verified poses, by verdict ("accepted", "contradicted", ...).
  std::map<std::string, int> num_matches;
  int num_closures = 0;          // accepted
  int num_injected = 0;          // of them
  int num_constraints = 0;       // added to the pose graph for them
  size_t num_waiting_tasks = 0;  // of the worker, without the running one
  double worker_cpu_seconds = 0.;
  // Time that the searcher adds to AddSensorData per local SLAM result [s].
  int64_t num_callbacks = 0;
  double callback_mean_seconds = 0.;
  double callback_p99_seconds = 0.;
  double callback_max_seconds = 0.;
};

// All methods may be called from any thread.
class LiveMapBuilder : public cartographer::mapping::MapBuilderInterface {
 public:
  // Returns none if the trajectory was never searched for.
  [[nodiscard]] virtual std::optional<LocalizationResult> GetLocalization(
      int trajectory_id) const = 0;
  // Searches for an active trajectory (again): after it was kidnapped, or if it
  // started with a wrong initial pose. Earlier scans are ignored.
  virtual void Localize(int trajectory_id) = 0;
  // None if the trajectory is not localised, or what it was localised in is
  // gone. Unlike the pose of GetLocalization, that of now, by local SLAM.
  [[nodiscard]] virtual std::optional<StartPose> GetStartPose(
      int trajectory_id) const = 0;

  // Blocks until the worker has no tasks left. For programs that run
  // recordings.
  virtual void WaitUntilIdle() = 0;
  [[nodiscard]] virtual LiveSummary GetSummary() const = 0;
  // Returns all matches that verification accepted, in order of discovery.
  [[nodiscard]] virtual std::vector<ClosureRecord> GetClosures() const = 0;
  // Returns the latest 200 candidates that overlap enough to be judged and were
  // not accepted, in order of discovery.
  [[nodiscard]] virtual std::vector<RefusedMatch> GetRefusedMatches() const = 0;
};

// Returns the host itself if `options.enabled` is false; otherwise a
// LiveMapBuilder that owns it. Options must be valid. If the host's pose graph
// is remote (a stub), closures are detected and logged but not injected. 3D is
// not affected.
[[nodiscard]] std::unique_ptr<cartographer::mapping::MapBuilderInterface>
CreateMapBuilder(
    std::unique_ptr<cartographer::mapping::MapBuilderInterface> host,
    const LiveOptions& options, LocalizationCallback on_localization = {});

// Returns null if it is not one, as with `enabled` false.
[[nodiscard]] LiveMapBuilder* AsLiveMapBuilder(
    cartographer::mapping::MapBuilderInterface* map_builder);

// Registers counters of submaps, queries, candidates, matches by verdict,
// closures and latencies. Call once per process, before CreateMapBuilder, like
// Cartographer's own RegisterMetrics.
void RegisterMetrics(cartographer::metrics::FamilyFactory* family_factory);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_MAP_BUILDER_H_
