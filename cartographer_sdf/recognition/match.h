// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Finds the pose of one place in another, pairwise, without any pose prior.

#ifndef CARTOGRAPHER_SDF_RECOGNITION_MATCH_H_
#define CARTOGRAPHER_SDF_RECOGNITION_MATCH_H_

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/grid/pair_pose.h"
#include "cartographer_sdf/matching/correspondence.h"
#include "cartographer_sdf/matching/pose_voter.h"
#include "cartographer_sdf/matching/ransac.h"
#include "cartographer_sdf/place/place.h"
#include "cartographer_sdf/verification/verification.h"

namespace cartographer_sdf {

enum class Method {
  // Many hypotheses, judged by walls and free space; score in log-odds.
  kSdf,
  // [Millane2019] as printed: ratio test, RANSAC, and the number of inliers as
  // the score. Nothing is verified: evidence, margin and rivals stay empty.
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
  // Used by method kPaper only.
  RansacOptions ransac;
  int min_num_inliers = 12;
  int seed = 42;
};
[[nodiscard]] std::string Validate(const MatchOptions& options);

// The paper's options: Table I, and our choice where it is silent.
[[nodiscard]] PlaceOptions PaperPlaceOptions();
[[nodiscard]] MatchOptions PaperMatchOptions();

// Evidence from the neighbouring pairs of submaps, at the poses that a match
// predicts; see neighbourhood.h. Wall lengths are weighted by certainty.
struct NeighbourhoodEvidence {
  int num_pairs = 0;
  double wall_length = 0.;           // within the other's observed area [m]
  double contradicting_length = 0.;  // part in the other's free space [m]
  // Pairs that were matched by themselves where predicted: the geometric mean
  // of their number and of how many would have shown as much new ground ...
  double num_confirming = 0.;
  // ... and elsewhere: the sum of their probabilities of being right there.
  double num_refuting = 0.;
};

// A pose of a pair of submaps, accepted or not.
struct Match {
  PairPose pair;
  Verdict verdict = Verdict::kUnlikely;
  PairEvidence evidence;
  // Score of the pair alone; pair.score differs if the neighbourhood was
  // verified too.
  double pair_score = 0.;
  double margin = 0.;          // as VerifiedPose::margin
  std::vector<Rigid2> rivals;  // as VerifiedPose::rivals
  // Keypoints (reference, query) that agree with the pose, each in its own
  // submap frame.
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> inliers;
  // Absent if the neighbourhood was not verified.
  std::optional<NeighbourhoodEvidence> neighbourhood;
  // Another match that excludes this one is about as likely (rival_matches.h).
  bool has_rival = false;
  // Matches that support it, and that oppose it (match_support.h). Absent if
  // they were not looked for.
  std::optional<int> num_supporting;
  std::optional<int> num_opposing;
};

// Finds the poses in which a place resembles itself, by matching it with
// itself, so that rivals are detected when it is matched with others.
void FindSelfSimilarities(const MatchOptions& options, Place* place);

// Returns the poses for which the features of both places vote.
[[nodiscard]] std::vector<Rigid2> ProposePoses(const MatchOptions& options,
                                               const Place& reference,
                                               const Place& query);

// Returns nullopt if there is no pose worth reporting. Poses that others
// propose (an index, say) are tried beside those of the correspondences; method
// kPaper ignores them.
[[nodiscard]] std::optional<Match> MatchPlaces(
    const MatchOptions& options, const Place& reference, const Place& query,
    const std::vector<Rigid2>& proposed_T_reference_query = {});

// Makes a match of a verified pose of method kSdf.
[[nodiscard]] Match MakeMatch(const MatchOptions& options,
                              const Place& reference, const Place& query,
                              VerifiedPose verified);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECOGNITION_MATCH_H_
