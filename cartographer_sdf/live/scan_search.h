// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Sessions (localization/scan_session.h) of the trajectories of a live
// Cartographer: each scan by itself is compared with the whole loaded map, so
// that a robot is found before it has driven far enough to be recognised by
// what it has seen together, and is noticed to be lost.

#ifndef CARTOGRAPHER_SDF_LIVE_SCAN_SEARCH_H_
#define CARTOGRAPHER_SDF_LIVE_SCAN_SEARCH_H_

#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "cartographer/mapping/pose_graph.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/scan.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/localization/scan_localizer.h"
#include "cartographer_sdf/localization/scan_session.h"

namespace cartographer_sdf {

// The submaps of these trajectories as one grid, and what comparing scans with
// it needs. Null where they have no walls or no place for a robot. Copies each
// grid twice, so that memory holds one of them at a time.
[[nodiscard]] std::unique_ptr<const PanoramaMap> DrawLoadedMap(
    const ViewpointOptions& options,
    const cartographer::mapping::PoseGraph& pose_graph,
    const std::vector<int>& trajectory_ids);

// Thread-compatible.
class ScanSearch {
 public:
  // Options must be valid.
  ScanSearch(const ScanLocalizationOptions& options,
             const ScanSessionOptions& session_options);

  // All sessions begin anew.
  void SetMap(std::unique_ptr<const PanoramaMap> map);
  [[nodiscard]] bool HasMap() const { return map_ != nullptr; }

  // Begins the session of the trajectory, or begins it anew.
  void Start(int trajectory_id);
  void Stop(int trajectory_id) { searches_.erase(trajectory_id); }
  struct Step {
    SessionAnswer answer;
    // The session had located the robot, and now does no more, or elsewhere.
    bool is_lost = false;
  };
  // Adds a scan to the session of the trajectory, which begins if there is
  // none. There must be a map.
  Step Add(int trajectory_id, const OdometryScan& scan);

 private:
  struct Search {
    ScanSession session;
    // Of the odometry frame, by the latest answer; none unless located.
    std::optional<Rigid2> T_map_odometry;
  };

  const ScanLocalizationOptions options_;
  const ScanSessionOptions session_options_;
  std::unique_ptr<const PanoramaMap> map_;
  std::map<int, Search> searches_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_SCAN_SEARCH_H_
