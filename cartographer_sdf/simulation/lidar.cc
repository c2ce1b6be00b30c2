// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/lidar.h"

#include <algorithm>

#include "cartographer_sdf/simulation/grid_traversal.h"

namespace cartographer_sdf {

std::string Validate(const LidarOptions& options) {
  if (options.num_beams < 1 || options.num_beams > 10000) {
    return "num_beams must lie between 1 and 10000";
  }
  if (!(options.field_of_view > 0. && options.field_of_view <= 2. * M_PI)) {
    return "field_of_view must lie between 0 and 2 pi";
  }
  if (!(options.max_range > 0. && options.max_range <= 200.)) {
    return "max_range must lie between 0 m and 200 m";
  }
  if (!(options.range_noise >= 0. && options.range_noise <= 1.)) {
    return "range_noise must lie between 0 m and 1 m";
  }
  if (!(options.drop_outs >= 0. && options.drop_outs <= 1.)) {
    return "drop_outs must lie between 0 and 1";
  }
  return "";
}

std::optional<double> CastRay(const FloorPlan& plan,
                              const Eigen::Vector2d& p_world,
                              const Eigen::Vector2d& direction,
                              const double max_range) {
  const double resolution = plan.geometry.resolution;
  const Eigen::Array2i size = plan.geometry.size;
  std::optional<double> range;
  TraverseCells(p_world / resolution,
                (p_world + max_range * direction) / resolution,
                [&](const int i, const int j, const double t) {
                  if (i < 0 || j < 0 || i >= size.x() || j >= size.y()) {
                    return false;
                  }
                  if (!plan.occupied(i, j)) return true;
                  range = t * max_range;
                  return false;
                });
  return range;
}

Scan TakeScan(const FloorPlan& plan, const Rigid2& T_world_robot,
              const LidarOptions& options, RandomNumbers* const random) {
  Scan scan;
  for (int k = 0; k != options.num_beams; ++k) {
    // Beams in the middles of equal sectors: none twice in a full circle.
    const double angle =
        options.field_of_view * ((k + 0.5) / options.num_beams - 0.5);
    const Eigen::Vector2d beam(std::cos(angle), std::sin(angle));
    const bool lost = random->Chance(options.drop_outs);
    const double noise = options.range_noise * random->Normal();
    if (lost) continue;
    const std::optional<double> range =
        CastRay(plan, T_world_robot.translation(),
                T_world_robot.RotationMatrix() * beam, options.max_range);
    if (range) {
      scan.returns.push_back(
          (std::max(0., *range + noise) * beam).cast<float>());
    } else {
      scan.empty_beams.push_back(beam.cast<float>());
    }
  }
  return scan;
}

}  // namespace cartographer_sdf
