// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Poses on which few, weighted correspondences of a query submap with one
// reference submap agree. As matching does with all correspondences of a pair
// (matching/hypotheses.h), but with those that an index came up with, and
// shared among the bins around, as they are few: the weight ranks submaps.

#ifndef CARTOGRAPHER_SDF_RETRIEVAL_POSE_VOTES_H_
#define CARTOGRAPHER_SDF_RETRIEVAL_POSE_VOTES_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"

namespace cartographer_sdf {

struct PoseVoteOptions {
  // Of the correspondences with one submap, as many of the largest weight are
  // paired. Time grows with the square.
  int max_num_correspondences = 250;
  // Two correspondences agree when the distances between their keypoints differ
  // by less [m] ...
  double max_length_difference_meters = 0.25;
  // ... and the rotations that their orientations imply by less [rad].
  double max_orientation_difference = 0.35;
  // Keypoints nearer than this to each other fix no rotation [m].
  double min_baseline_meters = 1.;
  // Pitch of the raster of poses, for the place of the middle of the query's
  // keypoints [m], and ...
  double bin_distance_meters = 0.75;
  // ... for the rotation, at most [rad].
  double bin_rotation = 0.2;
};
[[nodiscard]] std::string Validate(const PoseVoteOptions& options);

struct WeightedCorrespondence {
  Eigen::Vector2f p_reference;
  Eigen::Vector2f p_middle;  // query's axes, from the middle of its keypoints
  float rotation;            // that the orientations imply, (-pi, pi]
  float weight;              // positive
};

struct VotedPose {
  // The pose of a frame with the query's axes and its origin in the middle.
  Rigid2 T_reference_middle;
  // Of a pair of correspondences that agrees the product of its weights; the
  // sum of these, as far as they fall into the pose's bin.
  double weight;
};

// Most weight first, and no two in adjacent bins. None from less than a pair.
[[nodiscard]] std::vector<VotedPose> VotePoses(
    const PoseVoteOptions& options, int max_num_poses,
    std::vector<WeightedCorrespondence> correspondences);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RETRIEVAL_POSE_VOTES_H_
