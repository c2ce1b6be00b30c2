// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/recognize.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "cartographer_sdf/recognition/crossed_groups.h"
#include "cartographer_sdf/recognition/neighbourhood_verification.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// Pairs to match, with poses that the index proposes (reference <- query).
using ProposedPairs = std::map<IdPair, std::vector<Rigid2>>;

// Calls propose(reference, query, poses) for what the index proposes.
template <typename Propose>
void RetrievePairs(
    const RetrievalOptions& options,
    const std::map<SubmapId, Place>& references,
    const std::map<SubmapId, Place>& queries,
    const std::function<bool(const SubmapId& reference, const SubmapId& query)>&
        is_excluded,
    const Executor& executor, const Propose& propose) {
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
  for (size_t k = 0; k < places.size(); ++k) {
    for (const RetrievalCandidate& candidate : candidates[k]) {
      propose(candidate.id, places[k]->id, candidate.T_reference_query);
    }
  }
}

void Append(const std::vector<Rigid2>& poses, const bool inverted,
            std::vector<Rigid2>* const proposed) {
  for (const Rigid2& pose : poses) {
    proposed->push_back(inverted ? pose.Inverse() : pose);
  }
}

ProposedPairs PairsWithin(const RecognitionOptions& options,
                          const std::map<SubmapId, Place>& places,
                          const Executor& executor) {
  const auto share_scans = [&options](const SubmapId& a, const SubmapId& b) {
    return ShareScans(a, b, options.min_index_gap);
  };
  ProposedPairs pairs;
  if (options.use_retrieval) {
    RetrievePairs(options.retrieval, places, places, share_scans, executor,
                  [&pairs](const SubmapId& reference, const SubmapId& query,
                           const std::vector<Rigid2>& poses) {
                    // The lower id is the reference.
                    Append(poses, query < reference,
                           &pairs[std::minmax(reference, query)]);
                  });
    return pairs;
  }
  for (auto reference = places.begin(); reference != places.end();
       ++reference) {
    for (auto query = std::next(reference); query != places.end(); ++query) {
      if (share_scans(reference->first, query->first)) continue;
      pairs[{reference->first, query->first}];
    }
  }
  return pairs;
}

ProposedPairs PairsBetween(const RecognitionOptions& options,
                           const std::map<SubmapId, Place>& references,
                           const std::map<SubmapId, Place>& queries,
                           const Executor& executor) {
  ProposedPairs pairs;
  if (options.use_retrieval) {
    RetrievePairs(options.retrieval, references, queries, {}, executor,
                  [&pairs](const SubmapId& reference, const SubmapId& query,
                           const std::vector<Rigid2>& poses) {
                    Append(poses, false, &pairs[{reference, query}]);
                  });
    RetrievePairs(options.retrieval, queries, references, {}, executor,
                  [&pairs](const SubmapId& query, const SubmapId& reference,
                           const std::vector<Rigid2>& poses) {
                    Append(poses, true, &pairs[{reference, query}]);
                  });
    return pairs;
  }
  for (const auto& reference : references) {
    for (const auto& query : queries) {
      pairs[{reference.first, query.first}];
    }
  }
  return pairs;
}

std::vector<Match> MatchPairs(const MatchOptions& options,
                              const std::map<SubmapId, Place>& references,
                              const std::map<SubmapId, Place>& queries,
                              const ProposedPairs& proposed,
                              const Executor& executor,
                              const ProgressCallback& on_progress) {
  struct Pair {
    const Place* reference;
    const Place* query;
    const std::vector<Rigid2>* poses;
  };
  std::vector<Pair> pairs;
  for (const auto& [ids, poses] : proposed) {
    pairs.push_back(
        {&references.at(ids.first), &queries.at(ids.second), &poses});
  }
  std::vector<std::optional<Match>> found(pairs.size());
  TaskProgress progress(on_progress, pairs.size());
  executor(pairs.size(), [&](const size_t k) {
    found[k] = MatchPlaces(options, *pairs[k].reference, *pairs[k].query,
                           *pairs[k].poses);
    progress.TaskIsDone();
  });
  std::vector<Match> matches;
  for (std::optional<Match>& match : found) {
    if (match) matches.push_back(*std::move(match));
  }
  return matches;
}

// Returns the matches between two maps without their neighbourhoods.
std::vector<Match> MatchBetween(const RecognitionOptions& options,
                                const std::map<SubmapId, Place>& references,
                                const std::map<SubmapId, Place>& queries,
                                const Executor& executor,
                                const ProgressCallback& on_progress) {
  return MatchPairs(options.match, references, queries,
                    PairsBetween(options, references, queries, executor),
                    executor, on_progress);
}

bool VerifiesNeighbourhoods(const RecognitionOptions& options) {
  return options.verify_neighbourhoods && options.match.method == Method::kSdf;
}

TrajectoryLinks FindLinks(const RecognitionOptions& options,
                          const TrajectoryPlaces& map,
                          const Executor& executor) {
  return TrajectoryLinks(options.links, options.match.verification, map,
                         executor);
}

// `maps` has links.
std::vector<Match> VerifyTogether(const RecognitionOptions& options,
                                  const NeighbourhoodMaps& maps,
                                  std::vector<Match> matches,
                                  const Executor& executor,
                                  const ProgressCallback& on_progress) {
  matches = VerifyNeighbourhoods(options.neighbourhood, options.match, maps,
                                 std::move(matches), executor, on_progress);
  RefuseRivalMatches(options.rivals, options.match.verification.judgement, maps,
                     &matches);
  JudgeBySupport(options.support, maps, &matches);
  return matches;
}

std::vector<Match> VerifyIfAsked(const RecognitionOptions& options,
                                 NeighbourhoodMaps maps,
                                 std::vector<Match> matches,
                                 const Executor& executor,
                                 StageClock* const clock) {
  if (!VerifiesNeighbourhoods(options)) return matches;
  const ProgressCallback on_progress = clock->Begin("verify neighbourhoods");
  const TrajectoryLinks reference_links =
      FindLinks(options, maps.references, executor);
  std::optional<TrajectoryLinks> query_links;
  // Within one map both are the same.
  if (!maps.min_index_gap) {
    query_links.emplace(FindLinks(options, maps.queries, executor));
  }
  maps.reference_links = &reference_links;
  maps.query_links = query_links ? &*query_links : &reference_links;
  matches =
      VerifyTogether(options, maps, std::move(matches), executor, on_progress);
  RefuseCrossedGroups(options.match.verification, options.neighbourhood,
                      options.support, maps, executor, &matches);
  return matches;
}

}  // namespace

std::string Validate(const RecognitionOptions& options) {
  for (const std::string& error :
       {Validate(options.match), Validate(options.retrieval),
        Validate(options.links), Validate(options.neighbourhood),
        Validate(options.rivals), Validate(options.support)}) {
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
  return VerifyIfAsked(options, {map, map, options.min_index_gap},
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
  return VerifyIfAsked(options, {references, queries, std::nullopt},
                       std::move(matches), executor, clock);
}

IncrementalRecognition::IncrementalRecognition(
    const RecognitionOptions& options, const TrajectoryPlaces& references,
    const TrajectoryPlaces& queries, const Executor& executor)
    : options_(options),
      maps_{references, queries, std::nullopt},
      executor_(executor) {}

std::vector<Match> IncrementalRecognition::Add(
    const std::map<SubmapId, Place>& queries,
    const ProgressCallback& on_progress) {
  for (Match& match : MatchBetween(options_, *maps_.references.places, queries,
                                   executor_, on_progress)) {
    matches_.push_back(std::move(match));
  }
  std::stable_sort(matches_.begin(), matches_.end(),
                   [](const Match& a, const Match& b) {
                     return IsBeforeByIds(a.pair, b.pair);
                   });
  if (!VerifiesNeighbourhoods(options_) || matches_.empty()) return matches_;
  if (!reference_links_) {
    reference_links_.emplace(FindLinks(options_, maps_.references, executor_));
    query_links_.emplace(FindLinks(options_, maps_.queries, executor_));
    maps_.reference_links = &*reference_links_;
    maps_.query_links = &*query_links_;
  }
  return VerifyTogether(options_, maps_, matches_, executor_, {});
}

}  // namespace cartographer_sdf
