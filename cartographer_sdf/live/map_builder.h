// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The global constraint searcher beside a live, stock Cartographer. A program
// that owns a map builder adopts it by one line:
//
//   map_builder = cartographer_sdf::CreateMapBuilder(std::move(map_builder),
//                                                    options);
//
// Every finished submap is described and recognised among all others by a
// worker thread; closures become constraints of the pose graph. Trajectories
// that start after a map was loaded are localised in it.

#ifndef CARTOGRAPHER_SDF_LIVE_MAP_BUILDER_H_
#define CARTOGRAPHER_SDF_LIVE_MAP_BUILDER_H_

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

namespace cartographer_sdf {

// What the latest query for a trajectory found.
struct LocalizationResult {
  int trajectory_id = 0;
  // Whether the pose below is believed: enough queries in a row agreed.
  bool localized = false;
  // Of the latest query; kUncertain also while too few queries agree.
  LocalizationVerdict verdict = LocalizationVerdict::kTooLittleSeen;
  std::string reason;  // for people
  // Of the newest scan that took part.
  cartographer::common::Time time;
  // The best pose so far; none where nothing matches. Believe it only where
  // `localized`. Of the gravity-aligned node of the newest scan in the map ...
  std::optional<Rigid2> T_map_node;
  // ... and of the trajectory's local frame, which stays valid while local SLAM
  // does not drift.
  std::optional<Rigid2> T_map_local;
  // Of the best placement, and of the best one that it excludes, 0 where there
  // is none; log-odds.
  double score = 0.;
  double runner_up_score = 0.;
  // The submap of the map that matches best.
  std::optional<SubmapId> reference;
  int num_queries = 0;
  double distance_driven = 0.;  // since the search began [m]
  double cpu_seconds = 0.;      // of all its queries
};

// Called on the worker thread without any lock: once when a search ends,
// localised or not. Must not destroy the builder.
using LocalizationCallback = std::function<void(const LocalizationResult&)>;

struct ClosureRecord {
  PairPose pair;
  PairEvidence evidence;
  int num_inliers = 0;
  ClosureStatus status = ClosureStatus::kUnsupported;
  int num_constraints = 0;
};

struct LiveSummary {
  int num_places = 0;   // in the index now
  int num_submaps = 0;  // described since the start
  int num_queries = 0;
  int num_candidates = 0;
  // Poses that were verified, by verdict ("accepted", "contradicted", ...).
  std::map<std::string, int> num_matches;
  int num_closures = 0;     // accepted
  int num_injected = 0;     // of them
  int num_constraints = 0;  // in the pose graph for them
  double worker_cpu_seconds = 0.;
  // Added to AddSensorData by us, for each local SLAM result [s].
  int64_t num_callbacks = 0;
  double callback_mean_seconds = 0.;
  double callback_p99_seconds = 0.;
  double callback_max_seconds = 0.;
};

// All methods may be called from any thread.
class LiveMapBuilder : public cartographer::mapping::MapBuilderInterface {
 public:
  // None where the trajectory was never searched for.
  [[nodiscard]] virtual std::optional<LocalizationResult> GetLocalization(
      int trajectory_id) const = 0;
  // Searches for an active trajectory (again): after it was kidnapped, or where
  // it started with a wrong initial pose. What was seen before does not count.
  virtual void Localize(int trajectory_id) = 0;

  // Blocks until the worker has done all that there is to do now. For programs
  // that run recordings.
  virtual void WaitUntilIdle() = 0;
  [[nodiscard]] virtual LiveSummary GetSummary() const = 0;
  // All that verification accepted, in the order of discovery.
  [[nodiscard]] virtual std::vector<ClosureRecord> GetClosures() const = 0;
};

// The host itself where `options.enabled` is false; else a LiveMapBuilder that
// owns it. Options are valid. Where the host's pose graph is remote (a stub),
// closures are detected, logged and not injected; 3D is left alone.
[[nodiscard]] std::unique_ptr<cartographer::mapping::MapBuilderInterface>
CreateMapBuilder(
    std::unique_ptr<cartographer::mapping::MapBuilderInterface> host,
    const LiveOptions& options, LocalizationCallback on_localization = {});

// Null where it is none, as with `enabled` false.
[[nodiscard]] LiveMapBuilder* AsLiveMapBuilder(
    cartographer::mapping::MapBuilderInterface* map_builder);

// Counts submaps, queries, candidates, matches by verdict, closures and
// latencies from now on. Once per process, before CreateMapBuilder, as
// Cartographer's own RegisterMetrics.
void RegisterMetrics(cartographer::metrics::FamilyFactory* family_factory);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_MAP_BUILDER_H_
