// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Where does one map lie in another? Each accepted match of a submap of either
// is a vote for a pose of the whole map. Votes that agree, locally and as far
// as either map may have drifted between them, make a placement. It is believed
// only where enough different places speak for it, and well more than for any
// other placement that it excludes. Else the answer is none, with the reason.

#ifndef CARTOGRAPHER_SDF_SESSIONS_PLACEMENT_H_
#define CARTOGRAPHER_SDF_SESSIONS_PLACEMENT_H_

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/closure/consistency.h"
#include "cartographer_sdf/closure/loop_closure.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/loop_closing/described_map.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/place.h"
#include "cartographer_sdf/sessions/driven_distances.h"

namespace cartographer_sdf {

struct PlacementOptions {
  // Places of the query nearer together than this tell partly the same, in
  // proportion [m].
  double independent_distance_meters = 10.;
  // One place counts at most so much, however certain it seems; log-odds.
  double max_place_score = 10.;
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

// The two maps, as far as placements need them. Trajectories of the two are
// different ones even where their ids are equal. References must outlive it.
struct MapPair {
  MapPair(const MapState& map, const MapState& query)
      : map(map), query(query), map_distances(map), query_distances(query) {}

  const MapState& map;
  const MapState& query;
  const DrivenDistances map_distances;
  const DrivenDistances query_distances;
};

struct Placement {
  // The pose of the query's map frame in the map frame that fits the votes
  // best, where either map is bent.
  Rigid2 T_map_query;
  // Evidence of all its places; log-odds of being right.
  double score = 0.;
  std::vector<size_t> votes;  // indices of closures, in the order of ids
  // Whether it and the best one can't both hold: they put the same place of the
  // query to different places, or odometry between their votes excludes it.
  bool is_rival = false;
};

// All placements that the closures (reference in the map, query in the query)
// vote for, best first. Each vote is in one of them. Independent of the order
// of the closures. Quadratic in their number.
[[nodiscard]] std::vector<Placement> FindPlacements(
    const PlacementOptions& options, const ConsistencyOptions& consistency,
    const MapPair& maps, const std::vector<LoopClosure>& closures);

// Looks where the placement should hold: each pair of submaps that it puts onto
// each other, from the vote nearest to both, is verified at that pose alone.
// Those that agree become votes themselves, and it spreads as far as the maps
// meet. Pairs near votes come first; at most `max_num_pairs` are verified.
struct Confirmation {
  // Accepted there; pairs that have voted already are left out.
  std::vector<Match> agreeing;
  // Walls of one stand in the free space of the other.
  std::vector<Match> contradicting;
};
[[nodiscard]] Confirmation ConfirmPlacement(
    const PlacementOptions& options, const ConsistencyOptions& consistency,
    const MatchOptions& match_options, const MapPair& maps,
    const std::map<SubmapId, Place>& map_places,
    const std::map<SubmapId, Place>& query_places,
    const std::vector<LoopClosure>& closures, const Placement& placement,
    size_t max_num_pairs, const Executor& executor);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SESSIONS_PLACEMENT_H_
