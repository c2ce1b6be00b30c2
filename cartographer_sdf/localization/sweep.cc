// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr double kMinRange = 0.05;  // [m]

// The beam that is kept of one direction, and how far it lies from its middle,
// in widths of a direction.
struct SweepDirection {
  std::optional<RobotBeam> beam;
  double offset = std::numeric_limits<double>::infinity();
};

class SweepDirections {
 public:
  SweepDirections(const Eigen::Vector2d& centre, const int num_directions,
                  const double max_range)
      : centre_(centre), max_range_(max_range), directions_(num_directions) {}

  void Add(const Rigid2& T_robot_sensor, const Eigen::Vector2f& p_sensor,
           const bool has_echo) {
    const Eigen::Vector2d end = T_robot_sensor * p_sensor.cast<double>();
    const double range = p_sensor.cast<double>().norm();
    if (!(range >= kMinRange && range <= max_range_) || !end.allFinite()) {
      return;
    }
    const Eigen::Vector2d offset = end - centre_;
    const double turns = std::atan2(offset.y(), offset.x()) / (2. * M_PI);
    const double size = static_cast<double>(directions_.size());
    const double at = (turns - std::floor(turns)) * size;
    SweepDirection& direction =
        directions_[std::min(static_cast<size_t>(at), directions_.size() - 1)];
    if (!has_echo && direction.beam && direction.beam->has_echo) return;
    const double distance = std::abs(at - std::floor(at) - 0.5);
    if (distance >= direction.offset) return;
    direction = {RobotBeam{T_robot_sensor.translation(), end, has_echo},
                 distance};
  }

  [[nodiscard]] std::vector<RobotBeam> Beams() const {
    std::vector<RobotBeam> beams;
    for (const SweepDirection& direction : directions_) {
      if (direction.beam) beams.push_back(*direction.beam);
    }
    return beams;
  }

 private:
  const Eigen::Vector2d centre_;
  const double max_range_;
  std::vector<SweepDirection> directions_;
};

double WidestGap(const Sweep& sweep) {
  std::vector<double> angles;
  for (const RobotBeam& beam : sweep.beams) {
    const Eigen::Vector2d offset = beam.end - sweep.centre;
    angles.push_back(std::atan2(offset.y(), offset.x()));
  }
  if (angles.empty()) return 2. * M_PI;
  std::sort(angles.begin(), angles.end());
  double widest = angles.front() + 2. * M_PI - angles.back();
  for (size_t k = 1; k < angles.size(); ++k) {
    widest = std::max(widest, angles[k] - angles[k - 1]);
  }
  return widest;
}

}  // namespace

Sweep MakeSweep(const std::vector<RobotScan>& scans, const int num_directions,
                const double max_range) {
  CHECK_GE(num_directions, 1);
  Sweep sweep;
  if (scans.empty()) return sweep;
  for (const RobotScan& scan : scans) {
    sweep.centre +=
        scan.T_robot_sensor.translation() / static_cast<double>(scans.size());
  }
  SweepDirections directions(sweep.centre, num_directions, max_range);
  for (const RobotScan& scan : scans) {
    for (const Eigen::Vector2f& point : scan.scan.returns) {
      directions.Add(scan.T_robot_sensor, point, /*has_echo=*/true);
    }
  }
  for (const RobotScan& scan : scans) {
    for (const Eigen::Vector2f& point : scan.scan.misses) {
      directions.Add(scan.T_robot_sensor, point, /*has_echo=*/false);
    }
  }
  sweep.beams = directions.Beams();
  sweep.widest_gap = WidestGap(sweep);
  return sweep;
}

int NumEchoes(const Sweep& sweep) {
  return static_cast<int>(
      std::count_if(sweep.beams.begin(), sweep.beams.end(),
                    [](const RobotBeam& beam) { return beam.has_echo; }));
}

}  // namespace cartographer_sdf
