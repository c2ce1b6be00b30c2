// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// A submap of the stretch that the robot drove last, for as long as
// Cartographer has no finished one.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_GROWING_GRID_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_GROWING_GRID_H_

#include <deque>
#include <optional>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/grid/scan_grid.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

// A scan with its pose by local SLAM.
struct DrivenScan {
  NodeId node;
  Rigid2 T_local_node;
  Rigid2 T_local_sensor;
  Scan scan;
  double distance_driven = 0.;  // up to the scan [m]
};

// Thread-compatible.
class GrowingGrid {
 public:
  // Once the scans span more than `window` [m] of driving, drops those of the
  // older half.
  GrowingGrid(const ScanGridOptions& options, double window);

  // Scans must come in driving order. A scan that ScanGrid rejects is kept, but
  // not drawn.
  void Insert(DrivenScan scan);
  [[nodiscard]] const std::deque<DrivenScan>& scans() const { return scans_; }
  // Returns the frame of the submap: that of the oldest node. There must be
  // one.
  [[nodiscard]] const Rigid2& T_local_submap() const;
  // Returns the grid in that frame, with cells along the axes of the local
  // frame; nullopt if nothing was observed.
  [[nodiscard]] std::optional<OccupancyGrid> Copy() const;

 private:
  const ScanGridOptions options_;
  const double window_;
  std::deque<DrivenScan> scans_;
  ScanGrid grid_;  // in the local frame
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_GROWING_GRID_H_
