// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The memory of places of a map that grows: have I been here, and where is it?
// The one class of the core with a state worth the name.

#ifndef CARTOGRAPHER_SDF_RECOGNITION_PLACE_RECOGNIZER_H_
#define CARTOGRAPHER_SDF_RECOGNITION_PLACE_RECOGNIZER_H_

#include <map>
#include <vector>

#include "cartographer_sdf/matching/place_index.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/recognition/match.h"

namespace cartographer_sdf {

// Thread-compatible: const methods may run at once, the others alone. Results
// do not depend on the order of remembering, or on what was forgotten.
class PlaceRecognizer {
 public:
  PlaceRecognizer(const RetrievalOptions& retrieval, const MatchOptions& match);

  // The id is new. For method kSdf the place knows its self-similar poses
  // (FindSelfSimilarities), if rivals are to be noticed.
  void Remember(Place place);
  // Whether it was known.
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
  // `is_excluded` returns true. The query need not be remembered; where it is,
  // it matches itself unless excluded.
  [[nodiscard]] Recognition Recognize(
      const Place& query, const PlaceIndex::Predicate& is_excluded = {}) const;
  // The same with the best so many candidates, whatever their retrieval scores.
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
