// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Compares a sweep with the panoramas of all viewpoints of a map, turned in all
// directions. Exhaustive, yet bounded: beams are compared in an order that
// spreads over all directions, and a viewpoint is left as soon as those that
// were compared already cost more than the poses that are kept, whatever the
// others would say.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_PANORAMA_SEARCH_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_PANORAMA_SEARCH_H_

#include <cstddef>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/localization/sweep.h"
#include "cartographer_sdf/localization/viewpoints.h"

namespace cartographer_sdf {

// Returns at most `max_num_poses` distinct poses of the robot in the grid
// frame, those first at which the ranges of beams differ least, where a beam
// counts at most 1.5 m. `sweep` has kNumDirections directions. Deterministic.
// Empty if the sweep has no beam.
[[nodiscard]] std::vector<Rigid2> SearchPanoramas(const Viewpoints& viewpoints,
                                                  double resolution,
                                                  const Sweep& sweep,
                                                  size_t max_num_poses);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_PANORAMA_SEARCH_H_
