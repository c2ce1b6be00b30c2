// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/loop_closing/described_map.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <mutex>
#include <set>
#include <utility>

#include "cartographer_sdf/place_store/place_file.h"

namespace cartographer_sdf {
namespace {

// So many grids are described at once: enough for the threads of a large
// machine, little memory.
constexpr size_t kBatchSize = 16;

class BatchDescriber {
 public:
  BatchDescriber(const PlaceOptions& place_options,
                 const MatchOptions& match_options, const Executor& executor,
                 std::map<SubmapId, Place>* const places)
      : place_options_(place_options),
        match_options_(match_options),
        executor_(executor),
        places_(places) {}

  void Add(const SubmapId& id, const OccupancyGrid& grid) {
    batch_.emplace_back(id, grid);
    if (batch_.size() >= kBatchSize) Flush();
  }

  void Flush() {
    std::vector<std::optional<Place>> described(batch_.size());
    executor_(batch_.size(), [&](const size_t k) {
      described[k] =
          DescribePlace(place_options_, batch_[k].first, batch_[k].second);
      if (described[k] && match_options_.method == Method::kSdf) {
        FindSelfSimilarities(match_options_, &*described[k]);
      }
    });
    for (std::optional<Place>& place : described) {
      if (place) places_->emplace(place->id, *std::move(place));
    }
    batch_.clear();
  }

 private:
  const PlaceOptions& place_options_;
  const MatchOptions& match_options_;
  const Executor& executor_;
  std::map<SubmapId, Place>* const places_;
  std::vector<std::pair<SubmapId, OccupancyGrid>> batch_;
};

using IdPair = std::pair<SubmapId, SubmapId>;  // reference, query

// The candidates of every query among the references.
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
  std::mutex progress_mutex;
  size_t num_done = 0;
  executor(pairs.size(), [&](const size_t k) {
    found[k] = MatchPlaces(options, *pairs[k].first, *pairs[k].second);
    if (!on_progress) return;
    const std::lock_guard<std::mutex> lock(progress_mutex);
    on_progress(static_cast<double>(++num_done) /
                static_cast<double>(pairs.size()));
  });
  std::vector<Match> matches;
  for (std::optional<Match>& match : found) {
    if (match) matches.push_back(*std::move(match));
  }
  return matches;
}

}  // namespace

absl::StatusOr<DescribedMap> DescribeMap(const PlaceOptions& place_options,
                                         const MatchOptions& match_options,
                                         const std::string& path,
                                         const Executor& executor,
                                         const ProgressCallback& on_progress) {
  DescribedMap map;
  BatchDescriber describer(place_options, match_options, executor, &map.places);
  absl::StatusOr<MapState> state = ReadMap(
      path,
      [&describer](const SubmapId& id, const SubmapSummary&,
                   const OccupancyGrid& grid) { describer.Add(id, grid); },
      on_progress);
  if (!state.ok()) return state.status();
  describer.Flush();
  map.state = *std::move(state);
  return map;
}

absl::StatusOr<RememberedMap> RememberMap(const PlaceOptions& place_options,
                                          const MatchOptions& match_options,
                                          const std::string& options_text,
                                          const std::string& path,
                                          const std::string& places_path,
                                          const Executor& executor,
                                          const ProgressCallback& on_progress) {
  const absl::StatusOr<PlaceFileKey> key = MakePlaceFileKey(path, options_text);
  if (!key.ok()) return key.status();
  RememberedMap remembered;
  absl::StatusOr<std::map<SubmapId, Place>> places =
      ReadPlaces(places_path, *key);
  if (places.ok()) {
    absl::StatusOr<MapState> state = ReadMap(path, {}, on_progress);
    if (!state.ok()) return state.status();
    remembered.map = {*std::move(state), *std::move(places)};
    remembered.is_from_file = true;
    return remembered;
  }
  if (!absl::IsNotFound(places.status())) {
    remembered.complaint = std::string(places.status().message());
  }
  absl::StatusOr<DescribedMap> map =
      DescribeMap(place_options, match_options, path, executor, on_progress);
  if (!map.ok()) return map.status();
  remembered.map = *std::move(map);
  const absl::Status status =
      WritePlaces(places_path, *key, remembered.map.places);
  if (!status.ok()) remembered.complaint = std::string(status.message());
  return remembered;
}

std::vector<Match> MatchWithin(const MatchOptions& options,
                               const std::optional<RetrievalOptions>& retrieval,
                               const std::map<SubmapId, Place>& places,
                               const int min_index_gap,
                               const Executor& executor,
                               const ProgressCallback& on_progress) {
  const auto share_scans = [min_index_gap](const SubmapId& a,
                                           const SubmapId& b) {
    return a.trajectory == b.trajectory &&
           std::abs(a.index - b.index) < min_index_gap;
  };
  std::set<IdPair> pairs;
  if (retrieval) {
    for (const IdPair& pair :
         RetrievePairs(*retrieval, places, places, share_scans, executor)) {
      pairs.insert(std::minmax(pair.first, pair.second));
    }
  } else {
    for (auto reference = places.begin(); reference != places.end();
         ++reference) {
      for (auto query = std::next(reference); query != places.end(); ++query) {
        if (share_scans(reference->first, query->first)) continue;
        pairs.emplace(reference->first, query->first);
      }
    }
  }
  return MatchPairs(options, places, places, pairs, executor, on_progress);
}

std::vector<Match> MatchBetween(
    const MatchOptions& options,
    const std::optional<RetrievalOptions>& retrieval,
    const std::map<SubmapId, Place>& references,
    const std::map<SubmapId, Place>& queries, const Executor& executor,
    const ProgressCallback& on_progress) {
  std::set<IdPair> pairs;
  if (retrieval) {
    for (const IdPair& pair :
         RetrievePairs(*retrieval, references, queries, {}, executor)) {
      pairs.insert(pair);
    }
    for (const IdPair& pair :
         RetrievePairs(*retrieval, queries, references, {}, executor)) {
      pairs.emplace(pair.second, pair.first);
    }
  } else {
    for (const auto& reference : references) {
      for (const auto& query : queries) {
        pairs.emplace(reference.first, query.first);
      }
    }
  }
  return MatchPairs(options, references, queries, pairs, executor, on_progress);
}

}  // namespace cartographer_sdf
