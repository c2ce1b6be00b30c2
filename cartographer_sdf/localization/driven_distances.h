// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// How far apart two submaps of a map are along what relates them: the distance
// driven, with shortcuts where a loop was closed. Submaps that are near in this
// sense have a well-known relative pose, however long ago they were driven;
// those far apart may have drifted.

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
  // Of the submaps of the pose graph; `odometry` has how far the robot had
  // driven. Shortest ways between all of them: n^2 numbers, some milliseconds
  // for a hundred submaps.
  DrivenDistances(const PoseGraph& pose_graph,
                  const std::map<SubmapId, OdometryPose>& odometry);

  // [m]; none where nothing relates the two. Both must be in the map.
  [[nodiscard]] std::optional<double> Between(const SubmapId& a,
                                              const SubmapId& b) const;

 private:
  std::map<SubmapId, size_t> indices_;
  // Row by row; infinite where there is no way.
  std::vector<double> distances_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_DRIVEN_DISTANCES_H_
