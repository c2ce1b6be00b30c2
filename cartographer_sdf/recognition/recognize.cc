// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/recognize.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "cartographer_sdf/recognition/neighbourhood_verification.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

using IdPair = std::pair<SubmapId, SubmapId>;  // reference, query

// Returns the candidates of every query among the references.
std::vector<IdPair> RetrievePairs(
    const RetrievalOptions& options,
    const std::map<SubmapId, Place>& references,
    const std::map<SubmapId, Place>& queries,
    const std::function<bool(const SubmapId& reference, const SubmapId& query)>&
        is_excluded,
    const Executor& executor) {
  PlaceIndex index(options);
  for (const auto& [id, place] : references) index.Add(id, place.features);
  std::vector<const Place*> places;
  for (const auto& [id, place] : queries) places.push_back(&place);
  std::vector<std::vector<RetrievalCandidate>> candidates(places.size());
  executor(places.size(), [&](const size_t k) {
    PlaceIndex::Predicate predicate;
    if (is_excluded) {
      predicate = [&is_excluded, query = places[k]->id](const SubmapId& id) {
        return is_excluded(id, query);
      };
    }
    candidates[k] = index.Query(places[k]->features, predicate);
  });
  std::vector<IdPair> pairs;
  for (size_t k = 0; k < places.size(); ++k) {
    for (const RetrievalCandidate& candidate : candidates[k]) {
      pairs.emplace_back(candidate.id, places[k]->id);
    }
  }
  return pairs;
}

std::set<IdPair> PairsWithin(const RecognitionOptions& options,
                             const std::map<SubmapId, Place>& places,
                             const Executor& executor) {
  const auto share_scans = [&options](const SubmapId& a, const SubmapId& b) {
    return ShareScans(a, b, options.min_index_gap);
  };
  std::set<IdPair> pairs;
  if (options.use_retrieval) {
    for (const IdPair& pair : RetrievePairs(options.retrieval, places, places,
                                            share_scans, executor)) {
      pairs.insert(std::minmax(pair.first, pair.second));
    }
    return pairs;
  }
  for (auto reference = places.begin(); reference != places.end();
       ++reference) {
    for (auto query = std::next(reference); query != places.end(); ++query) {
      if (share_scans(reference->first, query->first)) continue;
      pairs.emplace(reference->first, query->first);
    }
  }
  return pairs;
}

// With retrieval, either submap may be a candidate of the other.
std::set<IdPair> PairsBetween(const RecognitionOptions& options,
                              const std::map<SubmapId, Place>& references,
                              const std::map<SubmapId, Place>& queries,
                              const Executor& executor) {
  std::set<IdPair> pairs;
  if (options.use_retrieval) {
    for (const IdPair& pair :
         RetrievePairs(options.retrieval, references, queries, {}, executor)) {
      pairs.insert(pair);
    }
    for (const IdPair& pair :
         RetrievePairs(options.retrieval, queries, references, {}, executor)) {
      pairs.emplace(pair.second, pair.first);
    }
    return pairs;
  }
  for (const auto& reference : references) {
    for (const auto& query : queries) {
      pairs.emplace(reference.first, query.first);
    }
  }
  return pairs;
}

std::vector<Match> MatchPairs(const MatchOptions& options,
                              const std::map<SubmapId, Place>& references,
                              const std::map<SubmapId, Place>& queries,
                              const std::set<IdPair>& id_pairs,
                              const Executor& executor,
                              const ProgressCallback& on_progress) {
  std::vector<std::pair<const Place*, const Place*>> pairs;
  for (const auto& [reference, query] : id_pairs) {
    pairs.emplace_back(&references.at(reference), &queries.at(query));
  }
  std::vector<std::optional<Match>> found(pairs.size());
  TaskProgress progress(on_progress, pairs.size());
  executor(pairs.size(), [&](const size_t k) {
    found[k] = MatchPlaces(options, *pairs[k].first, *pairs[k].second);
    progress.TaskIsDone();
  });
  std::vector<Match> matches;
  for (std::optional<Match>& match : found) {
    if (match) matches.push_back(*std::move(match));
  }
  return matches;
}

std::vector<Match> VerifyIfAsked(const RecognitionOptions& options,
                                 const TrajectoryPlaces& references,
                                 const TrajectoryPlaces& queries,
                                 const std::optional<int> min_index_gap,
                                 std::vector<Match> matches,
                                 const Executor& executor,
                                 StageClock* const clock) {
  if (!options.verify_neighbourhoods || options.match.method != Method::kSdf) {
    return matches;
  }
  return VerifyNeighbourhoods(options.neighbourhood, options.match, references,
                              queries, min_index_gap, std::move(matches),
                              executor, clock->Begin("verify neighbourhoods"));
}

}  // namespace

std::string Validate(const RecognitionOptions& options) {
  for (const std::string& error :
       {Validate(options.match), Validate(options.retrieval),
        Validate(options.neighbourhood)}) {
    if (!error.empty()) return error;
  }
  if (options.min_index_gap < 1) return "min_index_gap must be positive";
  return "";
}

std::vector<Match> RecognizeWithin(const RecognitionOptions& options,
                                   const TrajectoryPlaces& map,
                                   const Executor& executor,
                                   StageClock* const clock) {
  const ProgressCallback on_progress = clock->Begin("match and verify");
  std::vector<Match> matches = MatchPairs(
      options.match, *map.places, *map.places,
      PairsWithin(options, *map.places, executor), executor, on_progress);
  return VerifyIfAsked(options, map, map, options.min_index_gap,
                       std::move(matches), executor, clock);
}

std::vector<Match> RecognizeBetween(const RecognitionOptions& options,
                                    const TrajectoryPlaces& references,
                                    const TrajectoryPlaces& queries,
                                    const Executor& executor,
                                    StageClock* const clock) {
  const ProgressCallback on_progress = clock->Begin("match and verify");
  std::vector<Match> matches = MatchBetween(
      options, *references.places, *queries.places, executor, on_progress);
  return VerifyIfAsked(options, references, queries, std::nullopt,
                       std::move(matches), executor, clock);
}

std::vector<Match> MatchBetween(const RecognitionOptions& options,
                                const std::map<SubmapId, Place>& references,
                                const std::map<SubmapId, Place>& queries,
                                const Executor& executor,
                                const ProgressCallback& on_progress) {
  return MatchPairs(options.match, references, queries,
                    PairsBetween(options, references, queries, executor),
                    executor, on_progress);
}

}  // namespace cartographer_sdf
