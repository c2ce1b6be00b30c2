// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The memory of places: have I been here, and where is it? The one class of the
// core with a state worth the name.

#ifndef CARTOGRAPHER_SDF_RECOGNITION_PLACE_RECOGNIZER_H_
#define CARTOGRAPHER_SDF_RECOGNITION_PLACE_RECOGNIZER_H_

#include <map>
#include <vector>

#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/place.h"
#include "cartographer_sdf/retrieval/place_index.h"

namespace cartographer_sdf {

// Thread-compatible: const methods may run at once, the others alone. Results
// do not depend on the order of remembering, or on what was forgotten.
class PlaceRecognizer {
 public:
  PlaceRecognizer(const RetrievalOptions& retrieval, const MatchOptions& match);

  // The id is new. For method kSdf the place knows its self-similarities
  // (FindSelfSimilarities), if look-alikes are to be noticed.
  void Remember(Place place);
  // Whether it was known.
  bool Forget(const SubmapId& id);
  [[nodiscard]] const std::map<SubmapId, Place>& places() const {
    return places_;
  }

  // The remembered places that may show the query, best first; those that the
  // predicate tells are left out. For callers who match on several threads.
  [[nodiscard]] std::vector<RetrievalCandidate> Retrieve(
      const Place& query, const PlaceIndex::Predicate& is_excluded = {}) const;

  // Matches of the query with what Retrieve proposes, remembered places as
  // references: accepted ones first, then by score, then by id. Candidates
  // without a pose worth reporting yield none. The query need not be
  // remembered; where it is, it matches itself unless excluded.
  [[nodiscard]] std::vector<Match> Recognize(
      const Place& query, const PlaceIndex::Predicate& is_excluded = {}) const;

 private:
  const MatchOptions match_options_;
  PlaceIndex index_;
  std::map<SubmapId, Place> places_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECOGNITION_PLACE_RECOGNIZER_H_
