// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What a robot has seen lately, as the grid that the host would make of it. The
// host's own growing submaps are out of reach for other threads.

#ifndef CARTOGRAPHER_SDF_LIVE_GROWING_GRID_H_
#define CARTOGRAPHER_SDF_LIVE_GROWING_GRID_H_

#include <deque>
#include <memory>
#include <optional>

#include "cartographer/mapping/2d/probability_grid.h"
#include "cartographer/mapping/2d/probability_grid_range_data_inserter_2d.h"
#include "cartographer/mapping/id.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/mapping/value_conversion_tables.h"
#include "cartographer/sensor/range_data.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"

namespace cartographer_sdf {

// A scan as local SLAM placed it.
struct PlacedScan {
  cartographer::mapping::NodeId node;
  std::shared_ptr<const cartographer::mapping::TrajectoryNode::Data> data;
  cartographer::sensor::RangeData range_data_in_local;
  double distance_driven = 0.;  // up to it [m]
};

// Thread-compatible.
class GrowingGrid {
 public:
  // Once the scans cover more than `window` of driving [m], those of the older
  // half are let go.
  GrowingGrid(double resolution, double window);

  void Insert(PlacedScan scan);
  void Clear();
  [[nodiscard]] const std::deque<PlacedScan>& scans() const { return scans_; }
  // The frame of the grid: that of the oldest scan's node. There is one.
  [[nodiscard]] Rigid2 T_local_grid() const;
  // In that frame. None where nothing was seen.
  [[nodiscard]] std::optional<OccupancyGrid> Copy() const;

 private:
  void Draw(const cartographer::sensor::RangeData& range_data);

  const double resolution_;
  const double window_;
  std::deque<PlacedScan> scans_;
  cartographer::mapping::ValueConversionTables conversion_tables_;
  const cartographer::mapping::ProbabilityGridRangeDataInserter2D inserter_;
  std::unique_ptr<cartographer::mapping::ProbabilityGrid> grid_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LIVE_GROWING_GRID_H_
