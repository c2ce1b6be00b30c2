// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/growing_grid.h"

#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {

GrowingGrid::GrowingGrid(const ScanGridOptions& options, const double window)
    : options_(options), window_(window), grid_(options) {}

void GrowingGrid::Insert(DrivenScan scan) {
  scans_.push_back(std::move(scan));
  const double newest = scans_.back().distance_driven;
  if (newest - scans_.front().distance_driven <= window_) {
    grid_.Insert(scans_.back().T_local_sensor, scans_.back().scan);
    return;
  }
  while (newest - scans_.front().distance_driven > window_ / 2.) {
    scans_.pop_front();
  }
  grid_ = ScanGrid(options_);
  for (const DrivenScan& kept : scans_) {
    grid_.Insert(kept.T_local_sensor, kept.scan);
  }
}

const Rigid2& GrowingGrid::T_local_submap() const {
  CHECK(!scans_.empty());
  return scans_.front().T_local_node;
}

std::optional<OccupancyGrid> GrowingGrid::Copy() const {
  OccupancyGrid grid = grid_.Crop();
  if (!grid.known.any()) return std::nullopt;
  // Crop() returns it in the local frame.
  Rigid2& T_submap_grid = grid.geometry.T_submap_grid;
  T_submap_grid = T_local_submap().Inverse() * T_submap_grid;
  return grid;
}

}  // namespace cartographer_sdf
