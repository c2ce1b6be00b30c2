// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/simulation/lidar.h"

#include <algorithm>

#include "cartographer_sdf/geometry/number_range.h"
#include "cartographer_sdf/grid/grid_traversal.h"

namespace cartographer_sdf {
namespace {

// Distance along the beam to the first person; none if it hits nobody.
std::optional<double> RangeToPeople(const std::vector<Person>& people,
                                    const Eigen::Vector2d& p_world,
                                    const Eigen::Vector2d& direction) {
  std::optional<double> range;
  for (const Person& person : people) {
    const Eigen::Vector2d to_person = person.position - p_world;
    const double along = to_person.dot(direction);
    const double half_chord_squared =
        person.radius * person.radius - to_person.squaredNorm() + along * along;
    if (along < 0. || half_chord_squared < 0.) continue;
    const double hit = along - std::sqrt(half_chord_squared);
    if (hit >= 0. && (!range || hit < *range)) range = hit;
  }
  return range;
}

}  // namespace

std::string Validate(const LidarOptions& options) {
  return FirstOutside(
      {{"num_beams", options.num_beams, 1, 10000},
       {"field_of_view", options.field_of_view, 0.001, 2. * M_PI},
       {"max_range", options.max_range, 0.01, 200.},
       {"range_noise", options.range_noise, 0., 1.},
       {"drop_outs", options.drop_outs, 0., 1.},
       {"glass_echo", options.glass_echo, 0., 1.}});
}

std::optional<double> CastRay(const FloorPlan& plan,
                              const Eigen::Vector2d& p_world,
                              const Eigen::Vector2d& direction,
                              const double max_range,
                              const bool through_glass) {
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
                  if (plan.unseen.size() > 0 && plan.unseen(i, j)) return true;
                  if (through_glass && plan.glass(i, j)) return true;
                  range = t * max_range;
                  return false;
                });
  return range;
}

Scan TakeScan(const FloorPlan& plan, const std::vector<Person>& people,
              const Rigid2& T_world_robot, const LidarOptions& options,
              RandomNumbers* const random) {
  Scan scan;
  for (int k = 0; k != options.num_beams; ++k) {
    // Beams at the centres of equal sectors, so that none repeats in a full
    // circle.
    const double angle =
        options.field_of_view * ((k + 0.5) / options.num_beams - 0.5);
    const Eigen::Vector2d beam(std::cos(angle), std::sin(angle));
    const bool lost = random->Chance(options.drop_outs);
    const double noise = options.range_noise * random->Normal();
    const bool through_glass =
        plan.glass.size() > 0 && !random->Chance(options.glass_echo);
    if (lost) continue;
    const Eigen::Vector2d direction = T_world_robot.RotationMatrix() * beam;
    std::optional<double> range =
        RangeToPeople(people, T_world_robot.translation(), direction);
    // Nobody stands inside a wall, but people may be behind one or out of
    // range.
    const std::optional<double> to_wall =
        CastRay(plan, T_world_robot.translation(), direction, options.max_range,
                through_glass);
    if (range && *range > options.max_range) range.reset();
    if (to_wall && (!range || *to_wall < *range)) range = to_wall;
    if (range) {
      scan.returns.push_back(
          (std::max(0., *range + noise) * beam).cast<float>());
    } else {
      scan.misses.push_back((options.max_range * beam).cast<float>());
    }
  }
  return scan;
}

}  // namespace cartographer_sdf
