// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Compares the beams of a robot at a pose with the map, both ways: echoes must
// lie at walls, what a beam crossed must be free, and a beam must not cross a
// wall. Beams without an echo say nothing: lidars lose beams at glass and dark
// walls, two fifths of all in some recordings.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_BEAM_EVIDENCE_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_BEAM_EVIDENCE_H_

#include <string>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/localization/ray_map.h"
#include "cartographer_sdf/localization/sweep.h"

namespace cartographer_sdf {

// What becomes of the beams with an echo, each in one of these ways; fractions
// of all of them.
struct BeamEvidence {
  // Beams that are compared.
  int num_beams = 0;
  // Echoes at a wall of the map.
  double at_wall = 0.;
  // Beams that cross a wall of the map: it is gone, or the pose is wrong.
  double through_wall = 0.;
  // Echoes in free space: something that is not in the map.
  double in_free_space = 0.;
  // Beams that end where the map is unknown.
  double in_unknown = 0.;
  // Mean over the beams of how well they fit: 1 for an echo on a wall, .6 at
  // 7 cm, 0 for all others.
  double fit = 0.;
  // Root mean square distance of the echoes at walls [m].
  double wall_distance = 0.;
};

[[nodiscard]] BeamEvidence MeasureBeams(const RayMap& map, const Sweep& sweep,
                                        const Rigid2& T_grid_robot);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_BEAM_EVIDENCE_H_
