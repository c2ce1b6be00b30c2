// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/random_pairs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <utility>

#include "cartographer_sdf/grid/turned_grid.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Uniform in [0, bound), to within 2^-32; the standard's distributions differ
// between libraries.
size_t Draw(std::mt19937_64* const engine, const size_t bound) {
  CHECK_LT(bound, size_t{1} << 32);
  return static_cast<size_t>((((*engine)() >> 32) * bound) >> 32);
}

double DrawRotation(std::mt19937_64* const engine) {
  const double unit = std::ldexp(static_cast<double>((*engine)() >> 11), -53);
  return M_PI - 2. * M_PI * unit;
}

using OptionalPlaces = std::map<SubmapId, std::optional<Place>>;

OptionalPlaces DescribeReferences(const PlaceMaker& make_place,
                                  const std::vector<TurnedPair>& pairs,
                                  const Executor& executor) {
  OptionalPlaces places;
  for (const TurnedPair& pair : pairs) places[pair.reference] = std::nullopt;
  std::vector<OptionalPlaces::value_type*> entries;
  for (auto& entry : places) entries.push_back(&entry);
  executor(entries.size(), [&](const size_t k) {
    entries[k]->second = make_place(entries[k]->first, 0.);
  });
  return places;
}

std::optional<MatchRow> MatchPair(const MatchOptions& options,
                                  const TurnedPair& pair,
                                  const Place& reference, const Place& query) {
  const std::optional<Match> result = MatchPlaces(options, reference, query);
  if (!result) return std::nullopt;
  MatchRow row = ToRow(*result, result->verdict == Verdict::kAccepted,
                       VerdictName(result->verdict));
  row.T_reference_query = row.T_reference_query * Rigid2(0., 0., pair.rotation);
  return row;
}

// Matches with all features, and with those within each clearance.
std::vector<std::optional<MatchRow>> MatchVariants(
    const MatchOptions& options, const TurnedPair& pair,
    const std::vector<double>& max_clearances, const Place& reference,
    const Place& query) {
  std::vector<std::optional<MatchRow>> rows = {
      MatchPair(options, pair, reference, query)};
  for (const double max_clearance : max_clearances) {
    Place near_reference, near_query;
    near_reference.id = reference.id;
    near_reference.features =
        FeaturesNearWalls(reference.features, max_clearance);
    near_query.id = query.id;
    near_query.features = FeaturesNearWalls(query.features, max_clearance);
    rows.push_back(MatchPair(options, pair, near_reference, near_query));
  }
  return rows;
}

}  // namespace

std::vector<TurnedPair> DrawRandomPairs(const PairTruths& pairs,
                                        const int max_num_pairs,
                                        const int seed) {
  CHECK_GE(max_num_pairs, 0);
  std::mt19937_64 engine(static_cast<uint64_t>(seed));
  std::vector<TurnedPair> drawn;
  for (const auto& pair : pairs) {
    drawn.push_back({pair.first.first, pair.first.second, 0.});
  }
  const size_t size =
      std::min(drawn.size(), static_cast<size_t>(max_num_pairs));
  for (size_t k = 0; k < size; ++k) {
    std::swap(drawn[k], drawn[k + Draw(&engine, drawn.size() - k)]);
    drawn[k].rotation = DrawRotation(&engine);
  }
  drawn.resize(size);
  std::sort(
      drawn.begin(), drawn.end(), [](const TurnedPair& a, const TurnedPair& b) {
        return std::tie(a.reference, a.query) < std::tie(b.reference, b.query);
      });
  return drawn;
}

PlaceMaker MakeGridPlaces(const PlaceOptions& place_options,
                          const MatchOptions& match_options,
                          const std::map<SubmapId, OccupancyGrid>& grids) {
  return
      [place_options, match_options, &grids](
          const SubmapId& id, const double rotation) -> std::optional<Place> {
        const auto grid = grids.find(id);
        if (grid == grids.end()) return std::nullopt;
        std::optional<Place> place = DescribePlace(
            place_options, id,
            rotation == 0. ? grid->second : TurnedGrid(grid->second, rotation));
        if (place && match_options.method == Method::kSdf) {
          FindSelfSimilarities(match_options, &*place);
        }
        return place;
      };
}

PlaceMaker MakeCloudPlaces(const CloudPlaceOptions& options,
                           const std::map<SubmapId, SubmapCloud>& clouds) {
  return [options, &clouds](const SubmapId& id,
                            const double rotation) -> std::optional<Place> {
    const auto cloud = clouds.find(id);
    if (cloud == clouds.end()) return std::nullopt;
    const Rigid2 T_turned_submap(0., 0., rotation);
    SubmapCloud turned;
    for (const Eigen::Vector2d& p_submap : cloud->second) {
      turned.emplace_back(T_turned_submap * p_submap);
    }
    Place place;
    place.id = id;
    place.features = DescribeByShapeContexts(options, turned);
    return place;
  };
}

FeatureSet FeaturesNearWalls(const FeatureSet& features,
                             const double max_clearance) {
  FeatureSet near;
  near.descriptors.resize(features.descriptors.rows(),
                          features.descriptors.cols());
  Eigen::Index size = 0;
  for (size_t k = 0; k < features.features.size(); ++k) {
    const Feature& feature = features.features[k];
    if (std::abs(feature.keypoint.clearance) > max_clearance) continue;
    near.features.push_back(feature);
    near.descriptors.col(size++) =
        features.descriptors.col(static_cast<Eigen::Index>(k));
  }
  near.descriptors.conservativeResize(Eigen::NoChange, size);
  return near;
}

std::vector<std::vector<MatchRow>> MatchTurnedPairs(
    const MatchOptions& options, const PlaceMaker& make_place,
    const std::vector<TurnedPair>& pairs,
    const std::vector<double>& max_clearances, const Executor& executor,
    const ProgressCallback& on_progress) {
  const OptionalPlaces references =
      DescribeReferences(make_place, pairs, executor);
  // Indexed by pair; pairs without both places have no rows.
  std::vector<std::vector<std::optional<MatchRow>>> found(pairs.size());
  TaskProgress progress(on_progress, pairs.size());
  executor(pairs.size(), [&](const size_t k) {
    const std::optional<Place>& reference = references.at(pairs[k].reference);
    const std::optional<Place> query =
        make_place(pairs[k].query, pairs[k].rotation);
    if (reference && query) {
      found[k] =
          MatchVariants(options, pairs[k], max_clearances, *reference, *query);
    }
    progress.TaskIsDone();
  });
  std::vector<std::vector<MatchRow>> rows(1 + max_clearances.size());
  for (std::vector<std::optional<MatchRow>>& variants : found) {
    for (size_t v = 0; v < variants.size(); ++v) {
      if (variants[v]) rows[v].push_back(*std::move(variants[v]));
    }
  }
  return rows;
}

PrecisionRecallCurve JudgePairs(const PairTruths& truths,
                                const std::vector<TurnedPair>& pairs,
                                const std::vector<AnswerLabel>& labels,
                                const double min_overlap,
                                const AnswerJudgement judgement) {
  int num_positives = 0;
  for (const TurnedPair& pair : pairs) {
    num_positives +=
        truths.at({pair.reference, pair.query}).overlap >= min_overlap;
  }
  std::vector<AnswerLabel> judged = labels;
  for (AnswerLabel& label : judged) {
    label.to_positive = label.overlap >= min_overlap;
  }
  return JudgeAnswers(judged, num_positives, judgement);
}

}  // namespace cartographer_sdf
