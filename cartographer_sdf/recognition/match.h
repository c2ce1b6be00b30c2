// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Where does one place lie in another? Pairwise, without any pose prior.

#ifndef CARTOGRAPHER_SDF_RECOGNITION_MATCH_H_
#define CARTOGRAPHER_SDF_RECOGNITION_MATCH_H_

#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/closure/loop_closure.h"
#include "cartographer_sdf/matching/correspondence.h"
#include "cartographer_sdf/matching/hypotheses.h"
#include "cartographer_sdf/matching/ransac.h"
#include "cartographer_sdf/recognition/place.h"
#include "cartographer_sdf/verification/verification.h"

namespace cartographer_sdf {

enum class Method {
  // Many hypotheses, judged by walls and free space; score in log-odds.
  kSdf,
  // [Millane2019] as printed: ratio test, RANSAC, and the number of inliers as
  // the score.
  kPaper,
};

struct MatchOptions {
  Method method = Method::kSdf;
  CorrespondenceOptions correspondence;
  HypothesisOptions hypotheses;
  VerificationOptions verification;
  // Correspondences nearer than this under the final pose are reported as
  // inliers [m].
  double inlier_distance_meters = 0.3;
  // Only method kPaper.
  RansacOptions ransac;
  int min_num_inliers = 12;
  int seed = 42;
};
[[nodiscard]] std::string Validate(const MatchOptions& options);

// The paper's options: Table I, and our choice where it is silent.
[[nodiscard]] PlaceOptions PaperPlaceOptions();
[[nodiscard]] MatchOptions PaperMatchOptions();

// What neighbouring pairs of submaps, as a match predicts them, agree on; see
// neighbourhood.h. Lengths of wall are weighted by certainty.
struct NeighbourhoodEvidence {
  int num_pairs = 0;
  double wall_length = 0.;           // within what the other has observed [m]
  double contradicting_length = 0.;  // of it, in the other's free space [m]
};

struct Match {
  Verdict verdict;
  LoopClosure closure;  // with score and evidence, accepted or not
  // Pairs of keypoints (reference, query) that agree, each in its own frame.
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> inliers;
  // Absent for method kPaper.
  std::optional<Verification> verification;
  // Absent where nobody asked; else score and verdict are those in the
  // neighbourhood, and `verification` is the pair's own.
  std::optional<NeighbourhoodEvidence> neighbourhood;
};

// Of two submaps in one pose, the worse of both directions; `num_inliers` pairs
// of keypoints led to it, 0 where none did.
[[nodiscard]] ClosureEvidence EvidenceOf(const Agreement& agreement,
                                         int num_inliers = 0);

// Finds the poses in which a place resembles itself, by matching it with
// itself, so that look-alikes are noticed when it is matched with others.
void FindSelfSimilarities(const MatchOptions& options, Place* place);

// None where there is no pose worth reporting.
[[nodiscard]] std::optional<Match> MatchPlaces(const MatchOptions& options,
                                               const Place& reference,
                                               const Place& query);

// The match that a verification of method kSdf amounts to; its score and
// verdict are the verification's.
[[nodiscard]] Match MakeMatch(const MatchOptions& options,
                              const Place& reference, const Place& query,
                              Verification verification);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECOGNITION_MATCH_H_
