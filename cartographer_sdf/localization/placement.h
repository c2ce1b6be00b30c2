// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Where does one map lie in another? Each accepted match of a submap of either
// is a vote for a pose of the whole map. Votes that agree, locally and as far
// as either map may have drifted between them, make a placement. It is believed
// only where enough different places support it, and clearly more than any
// other placement that it excludes (localizer.h).

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_PLACEMENT_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_PLACEMENT_H_

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "cartographer_sdf/closing/consistency.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/pair_pose.h"
#include "cartographer_sdf/localization/driven_distances.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/place/trajectory_places.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

struct PlacementOptions {
  // Places of the query nearer together than this tell partly the same, in
  // proportion [m].
  double independent_distance_meters = 10.;
  // One match counts at most so much, however certain it seems; log-odds.
  double max_place_score = 10.;
  // A place counts by its best match with a submap of the map, and with this
  // fraction of the scores of the others: submaps of the map that overlap tell
  // partly the same, but a query that consists of one place has no more.
  double further_match_weight = 0.;
  // Least score of all places that speak for the placement; log-odds. Above
  // what look-alikes in other buildings reach.
  double min_score = 6.5;
  // Least lead over the best placement that it excludes; log-odds.
  double min_lead = 4.;
  // Of the places of the query that the placement puts into what the map has
  // seen: the largest fraction that may contradict it.
  double max_contradicting_fraction = 0.3;
  // Poses of a place that differ by less are the same [m], [rad].
  double same_distance_meters = 1.;
  double same_rotation = 0.2;
  // Least area that the query must have seen, submap by submap [m^2]; below it
  // the reason is that too little was seen.
  double min_observed_area = 20.;
};
[[nodiscard]] std::string Validate(const PlacementOptions& options);

// Where the submaps of a map are, as far as localization needs it.
struct MapLayout {
  std::map<SubmapId, Rigid2> T_map_submap;
  // Centroids of what the places have observed, in their submap frames.
  std::map<SubmapId, Eigen::Vector2d> centroids;
  DrivenDistances distances;
};
[[nodiscard]] MapLayout MakeMapLayout(
    const PoseGraph& pose_graph,
    const std::map<SubmapId, OdometryPose>& odometry,
    const std::map<SubmapId, Place>& places);

// Trajectories of the two are different ones even where their ids are equal.
// Neither is owned.
struct MapPair {
  const MapLayout* map;
  const MapLayout* query;
};

struct Placement {
  // The pose of the query's map frame in the map frame that fits the votes
  // best, where either map is bent.
  Rigid2 T_map_query;
  // Evidence of all its places; log-odds of being right.
  double score = 0.;
  std::vector<size_t> votes;  // indices, in the order of ids
  // Whether it and the best one can't both hold: they put the same place of the
  // query to different places, or odometry between their votes excludes it.
  bool is_rival = false;
};

// All placements that the votes (reference in the map, query in the query) add
// up to, best first. Each vote is in one of them. Independent of the order of
// the votes. Quadratic in their number.
[[nodiscard]] std::vector<Placement> FindPlacements(
    const PlacementOptions& options, const ConsistencyOptions& consistency,
    const MapPair& maps, const std::vector<PairPose>& votes);

// Where the vote puts the frame of a submap of the query into the map.
[[nodiscard]] Rigid2 PlaceByVote(const MapPair& maps, const PairPose& vote,
                                 const SubmapId& query);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_PLACEMENT_H_
