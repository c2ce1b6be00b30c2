// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_PLACE_TRAJECTORY_PLACES_H_
#define CARTOGRAPHER_SDF_PLACE_TRAJECTORY_PLACES_H_

#include <cstdlib>
#include <map>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/place/place.h"

namespace cartographer_sdf {

// The pose of a submap by local SLAM, in its trajectory's local frame.
struct OdometryPose {
  Rigid2 T_local_submap;
  double distance_driven = 0.;  // up to the submap, along the trajectory [m]
};

// The places of one map and their poses by local SLAM; every place has one.
// Poses of the optimised map are not used. Neither map is owned.
struct TrajectoryPlaces {
  const std::map<SubmapId, Place>* places;
  const std::map<SubmapId, OdometryPose>* odometry;
};

// Returns the pose of `b` in `a`, both of one trajectory, by local SLAM.
[[nodiscard]] inline Rigid2 RelativePose(const TrajectoryPlaces& map,
                                         const SubmapId& a, const SubmapId& b) {
  return map.odometry->at(a).T_local_submap.Inverse() *
         map.odometry->at(b).T_local_submap;
}

// Returns whether two submaps share scans: those of one trajectory do if their
// indices differ by less than `min_index_gap`, and local SLAM has already
// related them.
[[nodiscard]] inline bool ShareScans(const SubmapId& a, const SubmapId& b,
                                     const int min_index_gap) {
  return a.trajectory == b.trajectory &&
         std::abs(a.index - b.index) < min_index_gap;
}

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PLACE_TRAJECTORY_PLACES_H_
