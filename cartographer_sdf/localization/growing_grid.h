// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What a robot has seen on the last stretch that it drove, as a submap of its
// own, for as long as Cartographer has no finished one.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_GROWING_GRID_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_GROWING_GRID_H_

#include <deque>
#include <optional>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/grid/scan_grid.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

// A scan as local SLAM placed it.
struct DrivenScan {
  NodeId node;
  Rigid2 T_local_node;
  Rigid2 T_local_sensor;
  Scan scan;
  double distance_driven = 0.;  // up to it [m]
};

// Thread-compatible.
class GrowingGrid {
 public:
  // Once the scans cover more than `window` of driving [m], those of the older
  // half are let go.
  GrowingGrid(const ScanGridOptions& options, double window);

  // In the order in which they were driven. A scan that ScanGrid does not take
  // is kept, but not drawn.
  void Insert(DrivenScan scan);
  [[nodiscard]] const std::deque<DrivenScan>& scans() const { return scans_; }
  // The frame of the submap: that of the oldest node. There must be one.
  [[nodiscard]] const Rigid2& T_local_submap() const;
  // In that frame, with cells along the axes of the local frame. None where
  // nothing was seen.
  [[nodiscard]] std::optional<OccupancyGrid> Copy() const;

 private:
  const ScanGridOptions options_;
  const double window_;
  std::deque<DrivenScan> scans_;
  ScanGrid grid_;  // in the local frame
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_GROWING_GRID_H_
