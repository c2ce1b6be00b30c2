// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Evidence from the neighbours of two matched submaps. Perceptual aliasing
// (equal rooms, repeating corridors) passes every test of two submaps alone,
// but the surroundings seldom look alike too. Local SLAM knows the poses of a
// submap's neighbours, so a match predicts a pose for every pair of a neighbour
// of the reference and a neighbour of the query. Once registered from that
// pose, their walls and free space agree or contradict each other.
//
// Many of these pairs were also matched by themselves, from features alone.
// Where such a match lies at the predicted pose, two searches that know nothing
// of each other agree: the strongest evidence there is, and one that moved
// furniture leaves alone. It is the stronger the more ground the two show that
// the match does not: what resembles another place does so from any submap.
//
// A prediction is also a hypothesis: it finds poses that a pair's own features
// did not propose. Poses of the optimised map are not used, and a match is
// never compared with odometry itself, as local SLAM may have slipped in
// between; neighbours beyond a broken link (trajectory_links.h) are left out.

#ifndef CARTOGRAPHER_SDF_RECOGNITION_NEIGHBOURHOOD_H_
#define CARTOGRAPHER_SDF_RECOGNITION_NEIGHBOURHOOD_H_

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cartographer_sdf/grid/pair_pose.h"
#include "cartographer_sdf/place/trajectory_places.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/neighbour_walls.h"
#include "cartographer_sdf/recognition/trajectory_links.h"

namespace cartographer_sdf {

// The score of a match in its neighbourhood, log-odds of being right, is a
// linear combination with these weights, limited by
// NeighbourhoodOptions::max_gain. Learned by logistic regression; see
// scripts/learn_score.py.
struct NeighbourhoodWeights {
  double pair_score = 0.91;
  double log_contradiction = -1.46;
  double log_confirmation = 3.52;
  double bias = 0.;
};
[[nodiscard]] std::string Validate(const NeighbourhoodWeights& weights);

struct NeighbourhoodOptions {
  // Neighbours are the submaps of the same trajectory up to `num_steps` steps
  // of `index_step` indices away, in either direction. Consecutive submaps of
  // Cartographer share half of their scans, those two indices apart share none.
  int num_steps = 2;
  int index_step = 2;
  // Neighbouring pairs with a smaller common observed area are skipped [m^2].
  double min_overlap_area = 15.;
  // Largest number of wall points used of each neighbour.
  int num_points = 600;
  // The match of a neighbouring pair confirms the prediction if it is this near
  // to it, at the middle of its query [m], [rad]. Then it is also where the
  // walls of the pair are compared; elsewhere, the prediction is registered.
  double max_prediction_error_meters = 1.;
  double max_prediction_rotation_error = 0.15;
  // Prior: a match is scored as if its neighbourhood had shown this much more
  // wall [m] ...
  double prior_wall_length_meters = 50.;
  // ... of which this fraction contradicts.
  double prior_contradiction_ratio = 0.05;
  // The neighbourhood of a match with a lower pair score is not measured.
  double min_pair_score = -5.;
  // Neighbouring pairs are compared only as long as the score of the match,
  // with the evidence so far, is at least this; log-odds. Own matches of the
  // neighbouring pairs are looked at first.
  double min_promising_score = -2.;
  // A match with at least this score in its neighbourhood proposes poses to the
  // neighbouring pairs; log-odds.
  double min_proposing_score = 0.;
  // What is proposed and found likely proposes in its turn, so often. 1: only
  // matches propose; 0: none do.
  int max_num_rounds = 4;
  // An accepted match also proposes poses to the unmatched pairs of all submaps
  // up to so many indices from its own. 0: to none.
  int max_proposal_index_distance = 4;
  // Within one map, a pair that was not matched by itself is tried only while
  // one of its submaps has fewer likely matches than this, so that the work
  // grows with the submaps and not with the square of how often a place was
  // seen. 0: always.
  int max_num_matches_per_submap = 20;
  NeighbourhoodWeights weights;
  // The neighbourhood raises the score of a pair by at most this, log-odds: it
  // cannot make up for walls that disagree.
  double max_gain = 6.;
};
[[nodiscard]] std::string Validate(const NeighbourhoodOptions& options);

// Returns the submaps of the trajectory of `id` up to `num_steps` steps of
// `index_step` indices away, in either direction, and itself; without those
// that a broken link separates from it. `links` may be null.
[[nodiscard]] std::vector<SubmapId> SubmapsAround(const TrajectoryPlaces& map,
                                                  const TrajectoryLinks* links,
                                                  const SubmapId& id,
                                                  int num_steps,
                                                  int index_step);

// Returns the logarithm of the ratio of contradicting wall over that of the
// prior; zero if nothing was observed, negative if neighbours agree.
[[nodiscard]] double LogContradiction(const NeighbourhoodOptions& options,
                                      const NeighbourhoodEvidence& evidence);

// Returns the logarithm of the odds at which the neighbouring pairs' own
// matches confirm the prediction; zero if none has a match.
[[nodiscard]] double LogConfirmation(const NeighbourhoodEvidence& evidence);

// The terms of NeighbourhoodWeights without the bias, in their order, and their
// names.
constexpr int kNumNeighbourhoodTerms = 3;
[[nodiscard]] std::array<const char*, kNumNeighbourhoodTerms>
NeighbourhoodTermNames();
[[nodiscard]] std::array<double, kNumNeighbourhoodTerms> NeighbourhoodTerms(
    const NeighbourhoodOptions& options, double pair_score,
    const NeighbourhoodEvidence& evidence);
[[nodiscard]] double NeighbourhoodScore(const NeighbourhoodOptions& options,
                                        double pair_score,
                                        const NeighbourhoodEvidence& evidence);

struct Neighbourhood {
  NeighbourhoodEvidence evidence;
  // Registered poses of the neighbouring pairs whose own matches do not confirm
  // the prediction.
  std::vector<PairPose> proposals;
};

// Pairs that were matched by themselves, with the scores of each pair alone, by
// (reference, query).
using OwnMatches = std::map<IdPair, PairPose>;

// Where neighbours are looked for: between two maps, or within one. Nothing is
// owned.
struct NeighbourhoodMaps {
  TrajectoryPlaces references;
  TrajectoryPlaces queries;
  // Within one map, pairs that share scans are skipped (see ShareScans), and
  // the lower id of a matched pair is its reference. Empty between two maps.
  std::optional<int> min_index_gap;
  // Null if unknown.
  const TrajectoryLinks* reference_links = nullptr;
  const TrajectoryLinks* query_links = nullptr;
  const OwnMatches* own_matches = nullptr;
};

// Measures the neighbourhoods of matches. A match that is promising takes as
// long as verifying about ten poses. Thread-safe; no result depends on what was
// measured before. `options` and `maps` must outlive it.
class NeighbourhoodMeter {
 public:
  NeighbourhoodMeter(const NeighbourhoodOptions& options,
                     const VerificationOptions& verification,
                     const NeighbourhoodMaps& maps);

  // `match.score` is that of the pair by itself. Where the evidence so far puts
  // the match below min_promising_score, the remaining pairs are not compared.
  [[nodiscard]] Neighbourhood Measure(const PairPose& match);

 private:
  const NeighbourhoodOptions& options_;
  const NeighbourhoodMaps& maps_;
  NeighbourWalls walls_;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECOGNITION_NEIGHBOURHOOD_H_
