// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Finds placements of one map in another. Each match of a submap of one with a
// submap of the other is a vote for a pose of the whole map. Votes that agree,
// allowing for the drift of either map between them, form a placement. It is
// accepted only if enough distinct places support it, and clearly more than any
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
  // A place of the query counts as far as no better one shows the same ground:
  // a disc of the area that it shows, at least of this diameter [m].
  double independent_distance_meters = 10.;
  // Largest score that counts for one match, however certain it seems;
  // log-odds.
  double max_place_score = 10.;
  // A place counts with the score of its best match, plus this fraction of the
  // scores of its other matches: overlapping submaps of the map are partly
  // redundant, but a query of a single place has no other evidence.
  double further_match_weight = 0.;
  // Least total score of the places that support a placement; log-odds. One
  // above what perceptual aliasing in other buildings reaches (6.5 of some
  // 250,000 pairs of submaps). A rival that reaches it, and half of the best
  // score, makes the best one ambiguous.
  double min_score = 7.5;
  // Least lead over the best placement that it excludes; log-odds.
  double min_lead = 4.;
  // Two submaps that the placement makes overlap contradict it if more of their
  // walls (mean of both directions) stand in the other's free space.
  double max_contradiction_ratio = 0.2;
  // Largest fraction of the query's places in the observed area of the map that
  // may contradict the placement.
  double max_contradicting_fraction = 0.3;
  // Poses of a place that differ by less than this count as the same [m],
  // [rad].
  double same_distance_meters = 1.;
  double same_rotation = 0.2;
  // Least observed area of the query, summed over its submaps [m^2]; below it,
  // the verdict is kTooLittleSeen.
  double min_observed_area = 20.;
};
[[nodiscard]] std::string Validate(const PlacementOptions& options);

// The layout of a map's submaps, as localisation needs it.
struct MapLayout {
  std::map<SubmapId, Rigid2> T_map_submap;
  // Centroids of the observed areas of the places, in their submap frames.
  std::map<SubmapId, Eigen::Vector2d> centroids;
  // Diameters of discs of these areas [m].
  std::map<SubmapId, double> diameters;
  DrivenDistances distances;
};
[[nodiscard]] MapLayout MakeMapLayout(
    const PoseGraph& pose_graph,
    const std::map<SubmapId, OdometryPose>& odometry,
    const std::map<SubmapId, Place>& places);

// Trajectories of the two are distinct even if their ids are equal. Neither is
// owned.
struct MapPair {
  const MapLayout* map;
  const MapLayout* query;
};

struct Placement {
  // The pose of the query's map frame in the map frame; the best fit to the
  // votes where either map is bent.
  Rigid2 T_map_query;
  // Total evidence of its places; log-odds of being right.
  double score = 0.;
  std::vector<size_t> votes;  // indices, in the order of ids
  // Whether it and the best one cannot both hold: they put the same place of
  // the query in different places, or odometry between their votes excludes it.
  bool is_rival = false;
};

// Returns all placements that the votes form (reference in the map, query in
// the query), best first. Each vote belongs to exactly one. Independent of the
// order of the votes. Quadratic in their number.
[[nodiscard]] std::vector<Placement> FindPlacements(
    const PlacementOptions& options, const ConsistencyOptions& consistency,
    const MapPair& maps, const std::vector<PairPose>& votes);

// Returns the pose of submap `query` in the map frame according to the vote.
[[nodiscard]] Rigid2 PlaceByVote(const MapPair& maps, const PairPose& vote,
                                 const SubmapId& query);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_PLACEMENT_H_
