// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What a node does for its operator, whatever its middleware: keeps results of
// the searcher's thread for the node's, searches again on request, and lets a
// robot that was carried away begin a new trajectory.

#ifndef CARTOGRAPHER_SDF_LIVE_OPERATOR_DESK_H_
#define CARTOGRAPHER_SDF_LIVE_OPERATOR_DESK_H_

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "cartographer/mapping/map_builder_interface.h"
#include "cartographer_sdf/live/map_builder.h"
#include "cartographer_sdf/live/operator_view.h"

namespace cartographer_sdf {

// How the node itself ends and starts trajectories, so that its topics follow.
struct TrajectoryActions {
  // Returns whether the trajectory was active.
  std::function<bool(int trajectory_id)> finish;
  // Without an initial pose.
  std::function<void()> start;
};

// All methods but OnLocalization belong to one thread, the node's.
class OperatorDesk {
 public:
  // Must be called before the others, except for OnLocalization; the map
  // builder must outlive this.
  void SetMapBuilder(cartographer::mapping::MapBuilderInterface* map_builder);
  // Whether the searcher is enabled.
  [[nodiscard]] bool IsEnabled() const { return live_ != nullptr; }

  // The callback for CreateMapBuilder; any thread.
  void OnLocalization(const LocalizationResult& result)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the results since the last call, oldest first.
  [[nodiscard]] std::vector<LocalizationResult> TakeResults()
      ABSL_LOCKS_EXCLUDED(mutex_);

  // The newest active trajectory; none if there is none.
  [[nodiscard]] std::optional<int> NewestTrajectory() const;
  // None if the trajectory was never searched for; see LiveMapBuilder.
  [[nodiscard]] std::optional<LocalizationResult> GetLocalization(
      int trajectory_id) const;
  [[nodiscard]] std::optional<StartPose> GetStartPose(int trajectory_id) const;
  // Searches for an active trajectory again and returns it. With actions, for a
  // robot that was carried away: ends the trajectory, whose local SLAM would
  // match scans of one place with a submap of another, and starts one in its
  // place, which is returned; what is found ties it to the map. None if the
  // trajectory is not active.
  std::optional<int> SearchAgain(
      int trajectory_id, const std::optional<TrajectoryActions>& restart);
  // For all active trajectories; returns their number.
  int SearchForAll(const std::optional<TrajectoryActions>& restart);

  [[nodiscard]] std::vector<SegmentGroup> DrawMatches() const;
  // The CPU share is that since the last call.
  [[nodiscard]] NodeStatus DescribeStatus();

 private:
  // Trajectories that still grow, oldest first. The pose graph knows a
  // trajectory from its first node on; a loaded one has no builder.
  [[nodiscard]] std::vector<int> ActiveTrajectories() const;

  LiveMapBuilder* live_ = nullptr;
  // Trajectories that were ended here. The pose graph says so only once it has
  // worked through what came before, and to end one twice ends the process.
  std::set<int> ended_;
  // Trajectories that began after the robot was carried away.
  std::set<int> carried_away_;
  std::chrono::steady_clock::time_point last_status_ =
      std::chrono::steady_clock::now();
  double last_cpu_seconds_ = 0.;
  absl::Mutex mutex_;
  std::vector<LocalizationResult> results_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_OPERATOR_DESK_H_
