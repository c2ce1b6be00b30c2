// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Decides when two poses of the same pair of frames count as one, and selects
// distinct poses.

#ifndef CARTOGRAPHER_SDF_GEOMETRY_DISTINCT_POSES_H_
#define CARTOGRAPHER_SDF_GEOMETRY_DISTINCT_POSES_H_

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"

namespace cartographer_sdf {

struct PoseTolerance {
  double distance;  // [m]
  double rotation;  // [rad]
};

// Returns whether the images of `p_b` under both poses, and their rotations,
// differ by less than the tolerance.
[[nodiscard]] inline bool AreNear(const Rigid2& T_a_b,
                                  const Rigid2& other_T_a_b,
                                  const Eigen::Vector2d& p_b,
                                  const PoseTolerance& tolerance) {
  return (T_a_b * p_b - other_T_a_b * p_b).norm() < tolerance.distance &&
         std::abs(NormalizeAngle(T_a_b.rotation() - other_T_a_b.rotation())) <
             tolerance.rotation;
}

constexpr size_t kNoLimit = std::numeric_limits<size_t>::max();

// Greedily keeps items whose pose is near that of no item kept before, up to
// `max_num_items`. `items` come in order of preference; pose_of(item) is (a <-
// b).
template <typename Item, typename PoseOf>
[[nodiscard]] std::vector<Item> KeepDistinct(const std::vector<Item>& items,
                                             const PoseOf& pose_of,
                                             const Eigen::Vector2d& p_b,
                                             const PoseTolerance& tolerance,
                                             const size_t max_num_items) {
  std::vector<Item> kept;
  for (const Item& item : items) {
    if (kept.size() >= max_num_items) break;
    const bool is_distinct =
        std::none_of(kept.begin(), kept.end(), [&](const Item& better) {
          return AreNear(pose_of(item), pose_of(better), p_b, tolerance);
        });
    if (is_distinct) kept.push_back(item);
  }
  return kept;
}

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_GEOMETRY_DISTINCT_POSES_H_
