// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The paper's protocol ([Millane2019], Sec. V-A): random pairs of submaps, one
// of each turned by a random angle before it is described; whether the pair is
// called a match is compared with how much of what both observed is common.

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
  // The query is turned by this about its origin before it is described, in
  // (-pi, pi].
  double rotation = 0.;
};

// As many of `pairs` as are wanted or there are, each at most once, in the
// order of the ids. Depends on nothing but the arguments.
[[nodiscard]] std::vector<TurnedPair> DrawRandomPairs(const PairTruths& pairs,
                                                      int max_num_pairs,
                                                      int seed);

// A submap turned by an angle about its origin, described; none where there is
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

// The features whose clearance is at most that, inside of walls or outside.
[[nodiscard]] FeatureSet FeaturesNearWalls(const FeatureSet& features,
                                           double max_clearance);

// The answers to the pairs, each of the submaps as they are in the map (the
// rotation taken back). One list for all features, then one for each of
// `max_clearances`, by the features within that distance of walls alone; those
// are for methods that need no more than features. Pairs without an answer are
// absent. The result does not depend on the executor.
[[nodiscard]] std::vector<std::vector<MatchRow>> MatchTurnedPairs(
    const MatchOptions& options, const PlaceMaker& make_place,
    const std::vector<TurnedPair>& pairs,
    const std::vector<double>& max_clearances, const Executor& executor,
    const ProgressCallback& on_progress = {});

// A pair is a match where the common area is at least `min_overlap` of the
// smaller one's. `labels` are LabelAnswers' of answers to `pairs`.
[[nodiscard]] PrecisionRecallCurve JudgePairs(
    const PairTruths& truths, const std::vector<TurnedPair>& pairs,
    const std::vector<AnswerLabel>& labels, double min_overlap,
    AnswerJudgement judgement);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_RANDOM_PAIRS_H_
