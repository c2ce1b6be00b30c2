// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Few poses of a query submap in a reference submap that may be right, from
// putative correspondences, without chance: every pair of correspondences that
// agrees in length and in orientation votes for the pose that it fixes, and the
// fullest cells of a raster of poses come out, as the means of their votes.
// Unlike RANSAC with one answer, a place that looks alike twice yields both
// poses; verification, which sees walls and free space, decides.

#ifndef CARTOGRAPHER_SDF_MATCHING_HYPOTHESES_H_
#define CARTOGRAPHER_SDF_MATCHING_HYPOTHESES_H_

#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/matching/correspondence.h"

namespace cartographer_sdf {

struct HypothesisOptions {
  // Most hypotheses that come out. Larger: more recall, more time.
  int max_num_hypotheses = 80;
  // Of the correspondences, as many of the least descriptor distance are
  // paired. Time grows with the square.
  int max_num_correspondences = 400;
  // Two correspondences agree when the distances between their keypoints differ
  // by less [m] ...
  double max_length_difference_meters = 0.2;
  // ... and the rotations that their orientations imply by less [rad].
  double max_orientation_difference = 0.44;
  // Keypoints nearer than this to each other fix no rotation [m].
  double min_baseline_meters = 1.5;
  // Votes are gathered in a raster of this pitch, for the place of the middle
  // of the query's keypoints [m], and ...
  double cluster_distance_meters = 0.5;
  // ... of about this pitch for the rotation [rad].
  double cluster_rotation = 0.10;
};
[[nodiscard]] std::string Validate(const HypothesisOptions& options);

struct Hypothesis {
  Rigid2 T_reference_query;
  double num_votes;  // pairs of correspondences
};

// Most votes first.
[[nodiscard]] std::vector<Hypothesis> ProposeHypotheses(
    const HypothesisOptions& options, const FeatureSet& reference,
    const FeatureSet& query,
    const std::vector<Correspondence>& correspondences);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_MATCHING_HYPOTHESES_H_
