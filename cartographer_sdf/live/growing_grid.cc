// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/live/growing_grid.h"

#include <utility>

#include "cartographer/mapping/2d/map_limits.h"
#include "cartographer/mapping/2d/xy_index.h"
#include "cartographer_sdf/live/host_conversion.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

namespace mapping = cartographer::mapping;

// Cells of a new grid along each axis; it grows by itself.
constexpr int kInitialCells = 100;
// Farther points [m] are no returns of a lidar, and would make the grid grow
// without bounds.
constexpr float kMaxRange = 200.f;

// The host's defaults.
mapping::proto::ProbabilityGridRangeDataInserterOptions2D InserterOptions() {
  mapping::proto::ProbabilityGridRangeDataInserterOptions2D options;
  options.set_hit_probability(0.55);
  options.set_miss_probability(0.49);
  options.set_insert_free_space(true);
  return options;
}

cartographer::sensor::PointCloud WithinRange(
    const cartographer::sensor::PointCloud& cloud,
    const Eigen::Vector3f& origin) {
  return cloud.copy_if(
      [&origin](const cartographer::sensor::RangefinderPoint& point) {
        return (point.position - origin).norm() <= kMaxRange;
      });
}

}  // namespace

GrowingGrid::GrowingGrid(const double resolution, const double window)
    : resolution_(resolution), window_(window), inserter_(InserterOptions()) {}

void GrowingGrid::Insert(PlacedScan scan) {
  CHECK(scan.data != nullptr);
  const cartographer::sensor::RangeData& all = scan.range_data_in_local;
  scan.range_data_in_local = {all.origin, WithinRange(all.returns, all.origin),
                              WithinRange(all.misses, all.origin)};
  scans_.push_back(std::move(scan));
  const double newest = scans_.back().distance_driven;
  if (newest - scans_.front().distance_driven > window_) {
    while (newest - scans_.front().distance_driven > window_ / 2.) {
      scans_.pop_front();
    }
    grid_.reset();
    for (const PlacedScan& kept : scans_) Draw(kept.range_data_in_local);
    return;
  }
  Draw(scans_.back().range_data_in_local);
}

void GrowingGrid::Clear() {
  scans_.clear();
  grid_.reset();
}

Rigid2 GrowingGrid::T_local_grid() const {
  CHECK(!scans_.empty());
  return LocalNodePose(*scans_.front().data);
}

std::optional<OccupancyGrid> GrowingGrid::Copy() const {
  if (grid_ == nullptr) return std::nullopt;
  return CopyGrid(*grid_, T_local_grid());
}

void GrowingGrid::Draw(const cartographer::sensor::RangeData& range_data) {
  if (range_data.returns.empty() && range_data.misses.empty()) return;
  if (grid_ == nullptr) {
    const Eigen::Vector2d max =
        range_data.origin.head<2>().cast<double>() +
        0.5 * kInitialCells * resolution_ * Eigen::Vector2d::Ones();
    grid_ = std::make_unique<mapping::ProbabilityGrid>(
        mapping::MapLimits(resolution_, max,
                           mapping::CellLimits(kInitialCells, kInitialCells)),
        &conversion_tables_);
  }
  inserter_.Insert(range_data, grid_.get());
}

}  // namespace cartographer_sdf
