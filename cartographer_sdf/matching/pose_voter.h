// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Finds poses of a query submap in a reference submap on which putative
// correspondences agree. Every pair of correspondences that agrees in length
// and orientation determines a pose and votes for it; the heaviest bins of a
// raster of poses become hypotheses, each the mean of its votes. Deterministic,
// and unlike RANSAC it returns several hypotheses: two places that look alike
// yield both poses, and verification, which uses walls and free space, decides.
//
// Two callers: matching a pair of submaps, which votes with all correspondences
// of the pair (ProposePoses), and the index of all places, which votes with the
// few neighbours that fall into one submap, weighted by how distinctive they
// are (place_index.h).

#ifndef CARTOGRAPHER_SDF_MATCHING_POSE_VOTER_H_
#define CARTOGRAPHER_SDF_MATCHING_POSE_VOTER_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/matching/correspondence.h"

namespace cartographer_sdf {

// The raster of poses. Votes in one bin agree.
struct PoseBinOptions {
  // Pitch for the position of the centroid of the query's keypoints [m], ...
  double distance_meters = 0.5;
  // ... and for the rotation, approximately [rad].
  double rotation = 0.10;
};
[[nodiscard]] std::string Validate(const PoseBinOptions& options);

struct PoseVotingOptions {
  // Only this many correspondences, the best, are paired. Time grows with the
  // square.
  int max_num_correspondences = 400;
  // Two correspondences agree when the distances between their keypoints differ
  // by at most this [m] ...
  double max_length_difference_meters = 0.2;
  // ... and the rotations that their orientations imply by at most this [rad].
  double max_orientation_difference = 0.44;
  // Keypoints nearer than this to each other determine no rotation [m].
  double min_baseline_meters = 1.5;
  PoseBinOptions bins;
};
[[nodiscard]] std::string Validate(const PoseVotingOptions& options);

struct WeightedCorrespondence {
  Eigen::Vector2f p_reference;  // reference frame [m]
  Eigen::Vector2f p_centroid;   // query's axes, from the keypoints' centroid
  float rotation;               // implied by the orientations, (-pi, pi]
  float weight;                 // positive
};

// Returns the point from which voting measures the query's keypoints.
[[nodiscard]] Eigen::Vector2d KeypointCentroid(const FeatureSet& features);

struct VotedPose {
  Rigid2 T_reference_query;
  // Sum over its votes; a vote is the product of two correspondences' weights.
  double weight;
};

// A vote for the pose that takes the query's centroid to (x, y) in the
// reference frame [m].
struct PoseVote {
  float x, y;
  float rotation;  // [-pi, pi]
  float weight;    // positive
};

// Returns the means of the heaviest bins, at most `max_num_poses`, heaviest
// first, whatever the order of the votes. `centroid`: in the query frame [m].
[[nodiscard]] std::vector<VotedPose> HeaviestPoses(
    const PoseBinOptions& options, int max_num_poses,
    const Eigen::Vector2d& centroid, const std::vector<PoseVote>& votes);

// Returns at most `max_num_poses` poses, heaviest first. `correspondences` come
// best first; `centroid` is KeypointCentroid of the query. Fewer than two
// correspondences yield no pose.
[[nodiscard]] std::vector<VotedPose> VotePoses(
    const PoseVotingOptions& options, int max_num_poses,
    const Eigen::Vector2d& centroid,
    std::vector<WeightedCorrespondence> correspondences);

struct HypothesisOptions {
  // Largest number of poses returned. Larger: more recall, more time.
  int max_num_hypotheses = 80;
  PoseVotingOptions votes;
};
[[nodiscard]] std::string Validate(const HypothesisOptions& options);

// Returns the poses for which the correspondences of one pair of submaps vote,
// most votes first. Those with the least descriptor distance vote, with equal
// weights.
[[nodiscard]] std::vector<Rigid2> ProposePoses(
    const HypothesisOptions& options, const FeatureSet& reference,
    const FeatureSet& query, std::vector<Correspondence> correspondences);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_MATCHING_POSE_VOTER_H_
