// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/recognition/place_recognizer.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

bool IsBetter(const Match& a, const Match& b) {
  const bool a_accepted = a.verdict == Verdict::kAccepted;
  const bool b_accepted = b.verdict == Verdict::kAccepted;
  if (a_accepted != b_accepted) return a_accepted;
  if (a.closure.score != b.closure.score) {
    return a.closure.score > b.closure.score;
  }
  return a.closure.reference < b.closure.reference;
}

}  // namespace

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

std::vector<RetrievalCandidate> PlaceRecognizer::Retrieve(
    const Place& query, const PlaceIndex::Predicate& is_excluded) const {
  return index_.Query(query.features, is_excluded);
}

std::vector<Match> PlaceRecognizer::Recognize(
    const Place& query, const PlaceIndex::Predicate& is_excluded) const {
  std::vector<Match> matches;
  for (const RetrievalCandidate& candidate : Retrieve(query, is_excluded)) {
    std::optional<Match> match =
        MatchPlaces(match_options_, places_.at(candidate.id), query);
    if (match) matches.push_back(*std::move(match));
  }
  std::sort(matches.begin(), matches.end(), IsBetter);
  return matches;
}

}  // namespace cartographer_sdf
