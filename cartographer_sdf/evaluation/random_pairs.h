// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The paper's protocol ([Millane2019], Sec. V-A): random pairs of submaps, with
// one submap of each pair rotated by a random angle before it is described.
// Whether the method reports a match is compared with the overlap of the
// observed areas.

#ifndef CARTOGRAPHER_SDF_EVALUATION_RANDOM_PAIRS_H_
#define CARTOGRAPHER_SDF_EVALUATION_RANDOM_PAIRS_H_

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "cartographer_sdf/evaluation/match_score.h"
#include "cartographer_sdf/evaluation/precision_recall.h"
#include "cartographer_sdf/evaluation/shape_context.h"
#include "cartographer_sdf/place_store/described_map.h"
#include "cartographer_sdf/report/match_table.h"

namespace cartographer_sdf {

struct TurnedPair {
  SubmapId reference;
  SubmapId query;
  // Rotation of the query about its origin before it is described, in (-pi,
  // pi].
  double rotation = 0.;
};

// Draws up to `max_num_pairs` distinct pairs, in the order of the ids. Depends
// only on the arguments.
[[nodiscard]] std::vector<TurnedPair> DrawRandomPairs(const PairTruths& pairs,
                                                      int max_num_pairs,
                                                      int seed);

// Describes a submap rotated by an angle about its origin; none if there is
// nothing to describe. Called on several threads.
using PlaceMaker =
    std::function<std::optional<Place>(const SubmapId& id, double rotation)>;

// The maps must outlive the makers.
[[nodiscard]] PlaceMaker MakeGridPlaces(
    const PlaceOptions& place_options, const MatchOptions& match_options,
    const std::map<SubmapId, OccupancyGrid>& grids);
[[nodiscard]] PlaceMaker MakeCloudPlaces(
    const CloudPlaceOptions& options,
    const std::map<SubmapId, SubmapCloud>& clouds);

// The features whose absolute clearance is at most `max_clearance`.
[[nodiscard]] FeatureSet FeaturesNearWalls(const FeatureSet& features,
                                           double max_clearance);

// Matches the pairs and returns their answers for the submaps as they are in
// the map (with the rotation undone). Returns one list for all features, then
// one for each of `max_clearances` with only the features within that distance
// of walls; the latter are for methods that need only features. Pairs without
// an answer are absent. The result does not depend on the executor.
[[nodiscard]] std::vector<std::vector<MatchRow>> MatchTurnedPairs(
    const MatchOptions& options, const PlaceMaker& make_place,
    const std::vector<TurnedPair>& pairs,
    const std::vector<double>& max_clearances, const Executor& executor,
    const ProgressCallback& on_progress = {});

// A pair is positive if the common area is at least `min_overlap` of the
// smaller area. `labels` are the result of LabelAnswers for answers to `pairs`.
[[nodiscard]] PrecisionRecallCurve JudgePairs(
    const PairTruths& truths, const std::vector<TurnedPair>& pairs,
    const std::vector<AnswerLabel>& labels, double min_overlap,
    AnswerJudgement judgement);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_RANDOM_PAIRS_H_
