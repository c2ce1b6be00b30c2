// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/grid/scan_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "cartographer_sdf/grid/grid_traversal.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Log-odds of probability 0.9, the host's limit (mapping/probability_values.h).
constexpr float kMaxLogOdds = 2.1972246f;

// Sensors must lie within this many cells of the origin, so that cell indices
// and their differences fit into an int.
constexpr double kMaxCoordinate = 1e9;

// Extra cells on each side when a grid grows, so that it grows every few metres
// as the robot drives, not with every scan.
constexpr int kMargin = 64;

float LogOdds(const double probability) {
  return static_cast<float>(std::log(probability / (1. - probability)));
}

// Points in units of cells: coordinates in the submap frame, divided by the
// resolution.
struct Beam {
  Eigen::Vector2d end;
  bool is_hit;
};

Eigen::Vector2i CellOf(const Eigen::Vector2d& p_cells) {
  return p_cells.array().floor().cast<int>();
}

std::vector<Beam> MakeBeams(const ScanGridOptions& options,
                            const Rigid2& T_submap_sensor, const Scan& scan) {
  const Eigen::Matrix2d rotation = T_submap_sensor.RotationMatrix();
  std::vector<Beam> beams;
  beams.reserve(scan.returns.size() + scan.misses.size());
  const auto add = [&](const Eigen::Vector2d& p_sensor, const bool is_hit) {
    beams.push_back({(T_submap_sensor.translation() + rotation * p_sensor) /
                         options.resolution,
                     is_hit});
  };
  for (const Eigen::Vector2f& point : scan.returns) {
    const Eigen::Vector2d p_sensor = point.cast<double>();
    if (p_sensor.norm() <= options.max_range) add(p_sensor, true);
  }
  for (const Eigen::Vector2f& miss : scan.misses) {
    const Eigen::Vector2d p_sensor = miss.cast<double>();
    const double length = p_sensor.norm();
    if (!std::isfinite(length)) continue;
    const double credited = std::min(length, options.empty_beam_length);
    add((length > credited ? credited / length : 1.) * p_sensor, false);
  }
  return beams;
}

}  // namespace

std::string Validate(const ScanGridOptions& options) {
  if (!(options.resolution >= 0.01 && options.resolution <= 1.)) {
    return "resolution must lie between 0.01 m and 1 m";
  }
  if (!(options.hit_probability > 0.5 && options.hit_probability < 1.)) {
    return "hit_probability must lie between 0.5 and 1";
  }
  if (!(options.miss_probability > 0. && options.miss_probability < 0.5)) {
    return "miss_probability must lie between 0 and 0.5";
  }
  if (!(options.empty_beam_length >= 0. && options.empty_beam_length <= 200.)) {
    return "empty_beam_length must lie between 0 m and 200 m";
  }
  if (!(options.max_range > 0. && options.max_range <= 1000.)) {
    return "max_range must lie between 0 m and 1000 m";
  }
  return "";
}

ScanGrid::ScanGrid(const ScanGridOptions& options) : options_(options) {
  CHECK_EQ(Validate(options), "");
}

bool ScanGrid::Insert(const Rigid2& T_submap_sensor, const Scan& scan) {
  const Eigen::Vector2d begin =
      T_submap_sensor.translation() / options_.resolution;
  if (!(begin.array().abs() <= kMaxCoordinate).all() ||
      !std::isfinite(T_submap_sensor.rotation())) {
    return false;
  }
  const std::vector<Beam> beams = MakeBeams(options_, T_submap_sensor, scan);
  if (beams.empty()) return true;
  Eigen::AlignedBox2i box(CellOf(begin));
  for (const Beam& beam : beams) box.extend(CellOf(beam.end));
  if (!GrowToHold(box)) return false;
  ++num_scans_;
  // Hits come first, so that no passing beam can undo them.
  const float hit = LogOdds(options_.hit_probability);
  for (const Beam& beam : beams) {
    const Eigen::Vector2i cell = CellOf(beam.end);
    if (beam.is_hit) Update(cell.x(), cell.y(), hit);
  }
  const float miss = LogOdds(options_.miss_probability);
  for (const Beam& beam : beams) {
    TraverseCells(begin, beam.end, [&](int i, int j, double) {
      Update(i, j, miss);
      return true;
    });
  }
  return true;
}

OccupancyGrid ScanGrid::Crop() const {
  Eigen::AlignedBox2i box;
  for (int j = bounds_.min().y(); j <= bounds_.max().y(); ++j) {
    for (int i = bounds_.min().x(); i <= bounds_.max().x(); ++i) {
      if (cells_[Index(i, j)].last_scan != 0) box.extend(Eigen::Vector2i(i, j));
    }
  }
  // The host's grids have at least one cell.
  if (box.isEmpty())
    return UnknownGrid({{1, 1}, options_.resolution, Rigid2()});
  OccupancyGrid grid =
      UnknownGrid({box.sizes().array() + 1, options_.resolution,
                   Rigid2(options_.resolution * box.min().cast<double>(), 0.)});
  for (int j = 0; j != grid.geometry.size.y(); ++j) {
    for (int i = 0; i != grid.geometry.size.x(); ++i) {
      const Cell& cell = cells_[Index(box.min().x() + i, box.min().y() + j)];
      if (cell.last_scan == 0) continue;
      grid.known(i, j) = true;
      grid.probability(i, j) = 1.f / (1.f + std::exp(-cell.log_odds));
    }
  }
  return grid;
}

bool ScanGrid::GrowToHold(const Eigen::AlignedBox2i& cells) {
  if (bounds_.contains(cells)) return true;
  const Eigen::Vector2i margin = Eigen::Vector2i::Constant(kMargin);
  ScanGrid grown(options_);
  grown.bounds_ = bounds_.merged(
      Eigen::AlignedBox2i(cells.min() - margin, cells.max() + margin));
  const Eigen::Vector2i size = grown.bounds_.sizes().array() + 1;
  const int64_t num_cells = int64_t{size.x()} * size.y();
  if (num_cells > kMaxNumCells) return false;
  grown.cells_.resize(static_cast<size_t>(num_cells));
  for (int j = bounds_.min().y(); j <= bounds_.max().y(); ++j) {
    const auto row = cells_.begin() + Index(bounds_.min().x(), j);
    std::copy(row, row + bounds_.sizes().x() + 1,
              grown.cells_.begin() + grown.Index(bounds_.min().x(), j));
  }
  bounds_ = grown.bounds_;
  cells_.swap(grown.cells_);
  return true;
}

size_t ScanGrid::Index(const int i, const int j) const {
  return static_cast<size_t>(i - bounds_.min().x()) +
         static_cast<size_t>(bounds_.sizes().x() + 1) *
             static_cast<size_t>(j - bounds_.min().y());
}

void ScanGrid::Update(const int i, const int j, const float log_odds) {
  Cell& cell = cells_[Index(i, j)];
  if (cell.last_scan == num_scans_) return;
  cell.last_scan = num_scans_;
  cell.log_odds =
      std::clamp(cell.log_odds + log_odds, -kMaxLogOdds, kMaxLogOdds);
}

OccupancyGrid DrawScans(const ScanGridOptions& options,
                        const std::vector<PlacedScan>& scans) {
  ScanGrid grid(options);
  for (const PlacedScan& placed : scans) {
    grid.Insert(placed.T_submap_sensor, placed.scan);
  }
  return grid.Crop();
}

}  // namespace cartographer_sdf
