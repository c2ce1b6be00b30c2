// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/place_recognizer.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {

PlaceRecognizer::PlaceRecognizer(const RetrievalOptions& retrieval,
                                 const MatchOptions& match)
    : match_options_(match), index_(retrieval) {
  CHECK_EQ(Validate(match), "");
}

void PlaceRecognizer::Remember(Place place) {
  CHECK_EQ(places_.count(place.id), 0u) << place.id << " is known already";
  index_.Add(place.id, place.features);
  const SubmapId id = place.id;
  places_.emplace(id, std::move(place));
}

bool PlaceRecognizer::Forget(const SubmapId& id) {
  index_.Remove(id);
  return places_.erase(id) > 0;
}

PlaceRecognizer::Recognition PlaceRecognizer::Recognize(
    const Place& query, const PlaceIndex::Predicate& is_excluded) const {
  return MatchCandidates(query, index_.Query(query.features, is_excluded));
}

PlaceRecognizer::Recognition PlaceRecognizer::RecognizeAmongBest(
    const Place& query, const int num_candidates,
    const PlaceIndex::Predicate& is_excluded) const {
  return MatchCandidates(
      query, index_.QueryBest(query.features, num_candidates, is_excluded));
}

PlaceRecognizer::Recognition PlaceRecognizer::MatchCandidates(
    const Place& query,
    const std::vector<RetrievalCandidate>& candidates) const {
  Recognition recognition;
  recognition.num_candidates = candidates.size();
  for (const RetrievalCandidate& candidate : candidates) {
    std::optional<Match> match =
        MatchPlaces(match_options_, places_.at(candidate.id), query,
                    candidate.T_reference_query);
    if (match) recognition.matches.push_back(*std::move(match));
  }
  std::sort(recognition.matches.begin(), recognition.matches.end(),
            [](const Match& a, const Match& b) {
              return IsBeforeByIds(a.pair, b.pair);
            });
  return recognition;
}

}  // namespace cartographer_sdf
