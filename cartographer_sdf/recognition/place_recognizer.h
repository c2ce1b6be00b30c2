// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Remembers the places of a growing map and finds a query among them.

#ifndef CARTOGRAPHER_SDF_RECOGNITION_PLACE_RECOGNIZER_H_
#define CARTOGRAPHER_SDF_RECOGNITION_PLACE_RECOGNIZER_H_

#include <map>
#include <vector>

#include "cartographer_sdf/matching/place_index.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/recognition/match.h"

namespace cartographer_sdf {

// Thread-compatible: const methods may run concurrently, the others need
// exclusive access. Results do not depend on the order in which places were
// remembered, or on forgotten ones.
class PlaceRecognizer {
 public:
  PlaceRecognizer(const RetrievalOptions& retrieval, const MatchOptions& match);

  // The id must be new. For method kSdf, call FindSelfSimilarities on the place
  // before, so that rivals are detected.
  void Remember(Place place);
  // Returns whether the place was known.
  bool Forget(const SubmapId& id);
  [[nodiscard]] const std::map<SubmapId, Place>& places() const {
    return places_;
  }

  struct Recognition {
    // One for each candidate that has a pose worth reporting, whatever its
    // verdict; remembered places are the references. In the order of the ids.
    std::vector<Match> matches;
    size_t num_candidates = 0;
  };
  // Matches the query with the candidates of the index; skips ids for which
  // `is_excluded` returns true. The query need not be remembered; if it is, it
  // matches itself unless excluded.
  [[nodiscard]] Recognition Recognize(
      const Place& query, const PlaceIndex::Predicate& is_excluded = {}) const;
  // Does the same with the best `num_candidates` candidates, whatever their
  // retrieval scores.
  [[nodiscard]] Recognition RecognizeAmongBest(
      const Place& query, int num_candidates,
      const PlaceIndex::Predicate& is_excluded = {}) const;

 private:
  [[nodiscard]] Recognition MatchCandidates(
      const Place& query,
      const std::vector<RetrievalCandidate>& candidates) const;

  const MatchOptions match_options_;
  PlaceIndex index_;
  std::map<SubmapId, Place> places_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECOGNITION_PLACE_RECOGNIZER_H_
