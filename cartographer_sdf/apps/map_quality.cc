// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/apps/map_quality.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "cartographer_sdf/geometry/evenly_spaced.h"
#include "cartographer_sdf/place/trajectory_places.h"
#include "cartographer_sdf/verification/agreement.h"

namespace cartographer_sdf {
namespace {

constexpr size_t kMaxNumPairs = 2000;

// What a place has observed lies within a circle.
struct Circle {
  Eigen::Vector2d centre;  // in the map frame [m]
  double radius;
};

Circle CircleOf(const SurfaceModel& surface, const Rigid2& T_map_submap) {
  const Eigen::Vector2d centroid = ObservedCentroid(surface);
  double radius = 0.;
  for (const Eigen::Vector2d& point : surface.observed_points) {
    radius = std::max(radius, (point - centroid).norm());
  }
  return {T_map_submap * centroid, radius};
}

}  // namespace

std::vector<PlacePair> FindOverlappingPairs(
    const int min_index_gap, const std::map<SubmapId, Place>& places,
    const PoseGraph& pose_graph, const Executor& executor) {
  struct Placed {
    const Place* place;
    Rigid2 T_map_submap;
    Circle circle;
  };
  std::vector<Placed> placed;
  for (const auto& [id, place] : places) {
    const auto pose = pose_graph.submap_poses.find(id);
    if (pose == pose_graph.submap_poses.end()) continue;
    placed.push_back(
        {&place, pose->second, CircleOf(place.surface, pose->second)});
  }
  std::vector<std::vector<PlacePair>> found(placed.size());
  executor(placed.size(), [&](const size_t a) {
    const Placed& reference = placed[a];
    for (size_t b = a + 1; b < placed.size(); ++b) {
      const Placed& query = placed[b];
      if (ShareScans(reference.place->id, query.place->id, min_index_gap) ||
          (reference.circle.centre - query.circle.centre).norm() >
              reference.circle.radius + query.circle.radius) {
        continue;
      }
      const Rigid2 T_reference_query =
          reference.T_map_submap.Inverse() * query.T_map_submap;
      if (OverlapsEnough(reference.place->surface, query.place->surface,
                         T_reference_query)) {
        found[a].push_back({reference.place, query.place, T_reference_query});
      }
    }
  });
  std::vector<PlacePair> pairs;
  for (const std::vector<PlacePair>& of_one : found) {
    pairs.insert(pairs.end(), of_one.begin(), of_one.end());
  }
  return pairs;
}

MapQuality CompareWalls(const AgreementOptions& options,
                        const std::vector<PlacePair>& pairs,
                        const Executor& executor) {
  const std::vector<size_t> chosen =
      EvenlySpacedIndices(pairs.size(), std::min(pairs.size(), kMaxNumPairs));
  std::vector<PairAgreement> agreements(chosen.size());
  executor(chosen.size(), [&](const size_t k) {
    const PlacePair& pair = pairs[chosen[k]];
    agreements[k] =
        MeasurePairAgreement(options, pair.reference->surface,
                             pair.query->surface, pair.T_reference_query);
  });
  DirectedAgreement sum;
  for (const PairAgreement& agreement : agreements) {
    for (const DirectedAgreement* const directed :
         {&agreement.query_in_reference, &agreement.reference_in_query}) {
      sum.num_points += directed->num_points;
      sum.hits += directed->hits;
      sum.contradictions += directed->contradictions;
      sum.squared_distance += directed->squared_distance;
    }
  }
  return {chosen.size(), sum.HitRatio(), sum.ContradictionRatio(),
          sum.hits > 0. ? std::sqrt(sum.squared_distance / sum.hits) : 0.};
}

MapQuality MeasureMapQuality(const AgreementOptions& options,
                             const int min_index_gap,
                             const std::map<SubmapId, Place>& places,
                             const PoseGraph& pose_graph,
                             const Executor& executor) {
  return CompareWalls(
      options,
      FindOverlappingPairs(min_index_gap, places, pose_graph, executor),
      executor);
}

}  // namespace cartographer_sdf
