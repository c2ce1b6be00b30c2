// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/submap_grid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cartographer_sdf/simulation/grid_traversal.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Of the host: mapping/probability_values.h.
constexpr double kMaxProbability = 0.9;

struct Beam {
  Eigen::Vector2d end;  // In the submap frame.
  bool is_hit = false;
};

std::vector<Beam> MakeBeams(const PosedScan& posed,
                            const double empty_beam_length) {
  std::vector<Beam> beams;
  const Eigen::Vector2d& translation = posed.T_submap_robot.translation();
  const Eigen::Matrix2d rotation = posed.T_submap_robot.RotationMatrix();
  for (const Eigen::Vector2f& p_robot : posed.scan->returns) {
    beams.push_back({translation + rotation * p_robot.cast<double>(), true});
  }
  for (const Eigen::Vector2f& direction : posed.scan->empty_beams) {
    beams.push_back({translation + rotation * (empty_beam_length *
                                               direction.cast<double>()),
                     false});
  }
  return beams;
}

CellGeometry BoundingGeometry(const std::vector<PosedScan>& scans,
                              const SubmapGridOptions& options) {
  Eigen::AlignedBox2d box;
  for (const PosedScan& posed : scans) {
    box.extend(posed.T_submap_robot.translation());
    for (const Beam& beam : MakeBeams(posed, options.empty_beam_length)) {
      box.extend(beam.end);
    }
  }
  // One cell more than needed on each side, for rounding.
  const Eigen::Array2i minimum =
      (box.min().array() / options.resolution).floor().cast<int>() - 1;
  const Eigen::Array2i maximum =
      (box.max().array() / options.resolution).floor().cast<int>() + 1;
  return CellGeometry{
      maximum - minimum + 1, options.resolution,
      Rigid2(options.resolution * minimum.matrix().cast<double>(), 0.)};
}

double LogOdds(const double probability) {
  return std::log(probability / (1. - probability));
}

class LogOddsGrid {
 public:
  explicit LogOddsGrid(const CellGeometry& geometry)
      : geometry_(geometry), cells_(geometry.size.prod()) {}

  void Insert(const PosedScan& posed, const SubmapGridOptions& options) {
    ++num_scans_;
    const float hit = static_cast<float>(LogOdds(options.hit_probability));
    const float miss = static_cast<float>(LogOdds(options.miss_probability));
    const std::vector<Beam> beams = MakeBeams(posed, options.empty_beam_length);
    // Hits come first, so that no beam that passes by can undo them.
    for (const Beam& beam : beams) {
      if (!beam.is_hit) continue;
      const Eigen::Array2i cell = geometry_.CellAt(beam.end);
      Update(cell.x(), cell.y(), hit);
    }
    const Eigen::Vector2d begin = ToCells(posed.T_submap_robot.translation());
    for (const Beam& beam : beams) {
      TraverseCells(begin, ToCells(beam.end), [&](int i, int j, double) {
        Update(i, j, miss);
        return true;
      });
    }
  }

  [[nodiscard]] OccupancyGrid Crop() const {
    Eigen::AlignedBox2i box;
    for (int j = 0; j != geometry_.size.y(); ++j) {
      for (int i = 0; i != geometry_.size.x(); ++i) {
        if (At(i, j).last_scan != 0) box.extend(Eigen::Vector2i(i, j));
      }
    }
    // The host's grids have a cell at least.
    if (box.isEmpty()) box.extend(Eigen::Vector2i(0, 0));
    CellGeometry cropped = geometry_;
    cropped.size = box.sizes().array() + 1;
    cropped.T_submap_grid =
        geometry_.T_submap_grid *
        Rigid2(geometry_.resolution * box.min().cast<double>(), 0.);
    OccupancyGrid grid = UnknownGrid(cropped);
    for (int j = 0; j != cropped.size.y(); ++j) {
      for (int i = 0; i != cropped.size.x(); ++i) {
        const Cell& cell = At(box.min().x() + i, box.min().y() + j);
        if (cell.last_scan == 0) continue;
        grid.known(i, j) = true;
        grid.probability(i, j) = 1.f / (1.f + std::exp(-cell.log_odds));
      }
    }
    return grid;
  }

 private:
  struct Cell {
    float log_odds = 0.f;
    // The last scan that changed it, counted from 1; 0 is unknown.
    int last_scan = 0;
  };

  // Units of TraverseCells.
  Eigen::Vector2d ToCells(const Eigen::Vector2d& p_submap) const {
    return (p_submap - geometry_.T_submap_grid.translation()) /
           geometry_.resolution;
  }
  const Cell& At(const int i, const int j) const {
    return cells_[i + geometry_.size.x() * j];
  }
  void Update(const int i, const int j, const float log_odds) {
    static const float kMaxLogOdds =
        static_cast<float>(LogOdds(kMaxProbability));
    Cell& cell = cells_[i + geometry_.size.x() * j];
    if (cell.last_scan == num_scans_) return;
    cell.last_scan = num_scans_;
    cell.log_odds =
        std::clamp(cell.log_odds + log_odds, -kMaxLogOdds, kMaxLogOdds);
  }

  CellGeometry geometry_;
  std::vector<Cell> cells_;
  int num_scans_ = 0;
};

}  // namespace

std::string Validate(const SubmapGridOptions& options) {
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
  return "";
}

OccupancyGrid BuildSubmapGrid(const std::vector<PosedScan>& scans,
                              const SubmapGridOptions& options) {
  CHECK_EQ(Validate(options), "");
  CHECK(!scans.empty());
  LogOddsGrid grid(BoundingGeometry(scans, options));
  for (const PosedScan& posed : scans) grid.Insert(posed, options);
  return grid.Crop();
}

}  // namespace cartographer_sdf
