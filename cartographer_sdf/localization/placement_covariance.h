// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// How precisely the votes for a placement hold it: what the walls that match
// leave free, and by how much the votes disagree.

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_PLACEMENT_COVARIANCE_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_PLACEMENT_COVARIANCE_H_

#include <Eigen/Core>
#include <map>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/pair_pose.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/localization/placement.h"
#include "cartographer_sdf/place/place.h"

namespace cartographer_sdf {

// Of x, y [m^2] in the map frame and of the heading [rad^2] of a robot at
// `T_query_robot` in the query's map frame, by all votes that are given, of
// which there must be one; large along what the walls do not hold. What the map
// itself is bent between far places is not in it.
[[nodiscard]] Eigen::Matrix3d PlacementCovariance(
    const std::map<SubmapId, Place>& map_places,
    const std::map<SubmapId, Place>& query_places, const MapPair& maps,
    const std::vector<PairPose>& votes, const Rigid2& T_map_query,
    const Rigid2& T_query_robot);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_PLACEMENT_COVARIANCE_H_
