// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Distances between the submaps of a map along the pose graph: the distance
// driven, with shortcuts at loop closures. Submaps that are near in this sense
// have an accurate relative pose, however far apart in time; those far apart
// may have drifted.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_DRIVEN_DISTANCES_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_DRIVEN_DISTANCES_H_

#include <map>
#include <optional>
#include <vector>

#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/place/trajectory_places.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

class DrivenDistances {
 public:
  // Computes the shortest paths between all submaps of the pose graph: n^2
  // numbers, some milliseconds for a hundred submaps. `odometry` has the
  // distances driven.
  DrivenDistances(const PoseGraph& pose_graph,
                  const std::map<SubmapId, OdometryPose>& odometry);

  // Returns the distance [m], nullopt if no path connects the two. Both must be
  // in the pose graph.
  [[nodiscard]] std::optional<double> Between(const SubmapId& a,
                                              const SubmapId& b) const;

 private:
  std::map<SubmapId, size_t> indices_;
  // Row by row; infinite where there is no path.
  std::vector<double> distances_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_DRIVEN_DISTANCES_H_
