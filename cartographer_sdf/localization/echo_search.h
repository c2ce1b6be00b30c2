// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Searches a map for the poses at which the most echoes of a sweep lie near
// walls, whatever stands between: correlative scan matching [Olson2009] over
// all squares in which a robot can stand, and all directions. It finds a robot
// among chairs and legs of tables, where what the nearest obstacle is changes
// with each step and panoramas of the map, taken some steps apart, do not tell.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_ECHO_SEARCH_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_ECHO_SEARCH_H_

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/localization/ray_map.h"
#include "cartographer_sdf/localization/sweep.h"
#include "cartographer_sdf/localization/viewpoints.h"

namespace cartographer_sdf {

// Squares of a grid, of the side by which viewpoints are apart, larger in a map
// with many.
struct EchoMap {
  double side = 0.;  // [m]
  // How near a wall is to the middle of the square: 0 (far) to kMaxScore. The
  // first index is that of x.
  static constexpr uint8_t kMaxScore = 3;
  Eigen::Array<uint8_t, Eigen::Dynamic, Eigen::Dynamic> scores;
  // Whether a viewpoint lies in the square.
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> standing;
};
[[nodiscard]] EchoMap MakeEchoMap(const RayMap& rays,
                                  const Viewpoints& viewpoints);

// Returns at most `max_num_poses` distinct poses of the robot in the grid
// frame, those first with the most echoes near walls. Deterministic. Empty if
// the sweep has no echo beyond 1.2 m.
[[nodiscard]] std::vector<Rigid2> SearchEchoes(const EchoMap& map,
                                               const Sweep& sweep,
                                               size_t max_num_poses);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_ECHO_SEARCH_H_
