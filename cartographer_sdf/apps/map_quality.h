// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// How well a map agrees with itself: whether the submaps that lie over each
// other in it, seen at different times, have their walls at the same places.
// Needs no truth.

#ifndef CARTOGRAPHER_SDF_APPS_MAP_QUALITY_H_
#define CARTOGRAPHER_SDF_APPS_MAP_QUALITY_H_

#include <map>
#include <vector>

#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/verification/agreement.h"

namespace cartographer_sdf {

// Two places and their pose in a pose graph. Neither is owned.
struct PlacePair {
  const Place* reference;
  const Place* query;
  Rigid2 T_reference_query;
};

// Returns the pairs that overlap enough to be compared at the poses of the
// graph (see OverlapsEnough), in the order of ids, without those that share
// scans (see ShareScans). Places that are not in the graph are ignored.
[[nodiscard]] std::vector<PlacePair> FindOverlappingPairs(
    int min_index_gap, const std::map<SubmapId, Place>& places,
    const PoseGraph& pose_graph, const Executor& executor);

struct MapQuality {
  // Overlapping pairs that were compared; zero if no place was seen twice, and
  // the rest says nothing then.
  size_t num_pairs = 0;
  // Of their wall that lies within what the other submap has observed, the
  // fraction on walls of the other, and the fraction in its free space.
  double hit_ratio = 0.;
  double contradiction_ratio = 0.;
  // Root mean square distance of walls that meet [m].
  double wall_distance = 0.;
};

// Compares at most 2000 of the pairs, evenly spaced; some 0.2 ms each.
[[nodiscard]] MapQuality CompareWalls(const AgreementOptions& options,
                                      const std::vector<PlacePair>& pairs,
                                      const Executor& executor);

// Compares the walls of the overlapping pairs.
[[nodiscard]] MapQuality MeasureMapQuality(
    const AgreementOptions& options, int min_index_gap,
    const std::map<SubmapId, Place>& places, const PoseGraph& pose_graph,
    const Executor& executor);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_APPS_MAP_QUALITY_H_
