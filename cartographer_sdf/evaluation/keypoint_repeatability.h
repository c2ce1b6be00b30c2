// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Whether keypoints of a submap are found again in another one that saw the
// same place: what matching can hope for at most.

#ifndef CARTOGRAPHER_SDF_EVALUATION_KEYPOINT_REPEATABILITY_H_
#define CARTOGRAPHER_SDF_EVALUATION_KEYPOINT_REPEATABILITY_H_

#include <array>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/place/place.h"

namespace cartographer_sdf {

struct KeypointRepeatability {
  struct OfKind {
    // Features whose keypoint lies where the other submap has observed.
    int num_judged = 0;
    // Those with a feature of their kind within 0.2 m there; and, to tell skill
    // from density, within 0.2 m of a place 1 m away, if observed.
    int num_found = 0;
    int num_judged_by_chance = 0;
    int num_found_by_chance = 0;
    // Those of num_found whose orientation, too, is right within 20 degrees.
    int num_oriented = 0;
  };
  // By KeypointKind.
  std::array<OfKind, kNumKeypointKinds> kinds;

  [[nodiscard]] OfKind Total() const;
};

// Counts the features of both places, each looked for in the other.
void AddKeypointRepeatability(const Place& reference, const Place& query,
                              const Rigid2& T_reference_query,
                              KeypointRepeatability* repeatability);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_KEYPOINT_REPEATABILITY_H_
