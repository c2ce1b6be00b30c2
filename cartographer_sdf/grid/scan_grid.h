// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Draws scans into a probability grid in the submap frame, by the host's rules:
// a scan updates the odds of a cell once, as a hit if the cell contains one of
// its points, else as a miss if one of its beams crosses the cell. Cell borders
// lie on multiples of the resolution; probabilities are clamped to [0.1, 0.9].
//
// Any input is safe: non-finite or too distant input is skipped.

#ifndef CARTOGRAPHER_SDF_GRID_SCAN_GRID_H_
#define CARTOGRAPHER_SDF_GRID_SCAN_GRID_H_

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/grid/scan.h"

namespace cartographer_sdf {

// Defaults are the host's where it has the option.
struct ScanGridOptions {
  // Side of a cell [m].
  double resolution = 0.05;
  double hit_probability = 0.55;
  double miss_probability = 0.49;
  // Greatest length of a beam without an echo that counts as free [m].
  double empty_beam_length = 5.;
  // Points farther than this from the sensor are skipped [m].
  double max_range = 200.;
};

[[nodiscard]] std::string Validate(const ScanGridOptions& options);

// Thread-compatible.
class ScanGrid {
 public:
  // Half a gigabyte: a square with sides of 400 m, at the default resolution.
  static constexpr int kMaxNumCells = 1 << 26;

  explicit ScanGrid(const ScanGridOptions& options);

  // Takes time proportional to the number of cells that the beams cross and,
  // when the grid has to grow, to its number of cells. Returns false, without
  // effect, if the pose is not finite or the grid would need more than
  // kMaxNumCells.
  bool Insert(const Rigid2& T_submap_sensor, const Scan& scan);

  // Returns the smallest grid that contains all known cells, or a single
  // unknown cell if there are none.
  [[nodiscard]] OccupancyGrid Crop() const;

 private:
  struct Cell {
    float log_odds = 0.f;
    // Number of the last scan that updated it, from 1; 0 while unknown.
    int last_scan = 0;
  };
  [[nodiscard]] bool GrowToHold(const Eigen::AlignedBox2i& cells);
  [[nodiscard]] size_t Index(int i, int j) const;
  void Update(int i, int j, float log_odds);

  ScanGridOptions options_;
  // Cell (i, j) is [i, i + 1) x [j, j + 1), times the resolution, in the submap
  // frame. `bounds_` spans the first to the last cell in memory.
  Eigen::AlignedBox2i bounds_;
  std::vector<Cell> cells_;
  int num_scans_ = 0;
};

// Draws all scans that Insert() accepts into one grid.
[[nodiscard]] OccupancyGrid DrawScans(const ScanGridOptions& options,
                                      const std::vector<PlacedScan>& scans);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_GRID_SCAN_GRID_H_
