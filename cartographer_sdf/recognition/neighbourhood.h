// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// What the neighbours of two matched submaps say of the match. Twins (equal
// rooms, repeating corridors) pass every test that looks at two submaps only;
// what lies around them seldom is equal too. Local SLAM knows the poses of a
// submap's neighbours, so that a match predicts one for every pair of a
// neighbour of the reference and a neighbour of the query: registered from
// there, their walls and free space agree, or contradict each other.
//
// A prediction is also a hypothesis: it finds what a pair's own features did
// not propose. No pose of the optimised map takes part, and a match is never
// held against odometry itself, as local SLAM may have slipped in between.

#ifndef CARTOGRAPHER_SDF_RECOGNITION_NEIGHBOURHOOD_H_
#define CARTOGRAPHER_SDF_RECOGNITION_NEIGHBOURHOOD_H_

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/closure/consistency.h"
#include "cartographer_sdf/recognition/match.h"
#include "cartographer_sdf/recognition/place.h"

namespace cartographer_sdf {

// The score of a match in its neighbourhood, log-odds of being right, is linear
// in these, up to NeighbourhoodOptions::max_gain. Learned by logistic
// regression, see scripts/learn_score.py and docs/design.md.
struct NeighbourhoodWeights {
  double pair_score = 0.515;
  double log_contradiction = -5.57;
  double bias = -0.633;
};
[[nodiscard]] std::string Validate(const NeighbourhoodWeights& weights);

struct NeighbourhoodOptions {
  // Neighbours are the submaps of the same trajectory at so many steps of so
  // many indices, either way. Two consecutive submaps of Cartographer share
  // half of their scans, every other one shares none.
  int num_steps = 2;
  int index_step = 2;
  // Two neighbours that would see less in common are not asked [m^2].
  double min_overlap_area = 15.;
  // Wall points of each neighbour.
  int num_points = 600;
  // A match whose neighbours saw little in common is judged as if they had seen
  // this much wall more [m] ...
  double prior_wall_length_meters = 50.;
  // ... of which this part contradicts.
  double prior_contradiction_ratio = 0.05;
  // Matches of a lower score of their own are hopeless, and not looked at.
  double min_pair_score = -5.;
  // A match of this score in its neighbourhood proposes poses to the pairs of
  // neighbours, log-odds.
  double min_proposing_score = 0.;
  NeighbourhoodWeights weights;
  // Neighbours raise the score of a pair by no more than this, log-odds: where
  // its own walls speak against it, they are not enough.
  double max_gain = 3.;
};
[[nodiscard]] std::string Validate(const NeighbourhoodOptions& options);

// Logarithm of the ratio of contradicting wall, in units of the prior's; zero
// where nothing was seen, negative where neighbours agree.
[[nodiscard]] double LogContradiction(const NeighbourhoodOptions& options,
                                      const NeighbourhoodEvidence& evidence);

// The terms of NeighbourhoodWeights without the bias, in their order, and their
// names.
constexpr int kNumNeighbourhoodTerms = 2;
[[nodiscard]] std::array<const char*, kNumNeighbourhoodTerms>
NeighbourhoodTermNames();
[[nodiscard]] std::array<double, kNumNeighbourhoodTerms> NeighbourhoodTerms(
    const NeighbourhoodOptions& options, double pair_score,
    const NeighbourhoodEvidence& evidence);
[[nodiscard]] double NeighbourhoodScore(const NeighbourhoodOptions& options,
                                        double pair_score,
                                        const NeighbourhoodEvidence& evidence);

// Places of one map and where its local SLAM says that they are; every place
// has a pose. Neither is owned.
struct PlacesAlongTrajectories {
  const std::map<SubmapId, Place>* places;
  const std::map<SubmapId, OdometryPose>* odometry;
};

// A pose for a pair of submaps, by a match of neighbours.
struct PoseProposal {
  SubmapId reference;
  SubmapId query;
  Rigid2 T_reference_query;  // registered
};

struct Neighbourhood {
  NeighbourhoodEvidence evidence;
  std::vector<PoseProposal> proposals;
};

// `reference` and `query` are matched as T_reference_query. Pairs of neighbours
// of one trajectory that are less than `min_index_gap` apart share scans and
// are left out; where the maps are different ones, no two are. Takes as long as
// verifying some ten poses.
[[nodiscard]] Neighbourhood AskNeighbours(
    const NeighbourhoodOptions& options,
    const VerificationOptions& verification,
    const PlacesAlongTrajectories& references,
    const PlacesAlongTrajectories& queries, std::optional<int> min_index_gap,
    const SubmapId& reference, const SubmapId& query,
    const Rigid2& T_reference_query);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECOGNITION_NEIGHBOURHOOD_H_
