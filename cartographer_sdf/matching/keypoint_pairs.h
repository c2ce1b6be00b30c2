// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Pairs of keypoints as an index sees them. A pair is described by what does
// not depend on the pose of its submap: kinds and clearances of both keypoints,
// the distance between them, and their orientations relative to the line that
// joins them. That is far more distinctive than one keypoint, and a single pair
// that is seen again determines a pose. Descriptions are quantised to keys;
// what lies near the border of a bin has several.

#ifndef CARTOGRAPHER_SDF_MATCHING_KEYPOINT_PAIRS_H_
#define CARTOGRAPHER_SDF_MATCHING_KEYPOINT_PAIRS_H_

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "cartographer_sdf/feature/descriptor.h"

namespace cartographer_sdf {

struct KeypointPairOptions {
  // Keypoints are paired when their distance lies between these [m].
  double min_length_meters = 1.5;
  double max_length_meters = 8.;
  // Sizes of the bins: of clearances [m], lengths [m] and orientations [rad].
  double clearance_bin_meters = 0.2;
  double length_bin_meters = 0.3;
  double orientation_bin = 0.45;
  // A query also looks into the next bin where it lies within this fraction of
  // a bin from it. Larger: more recall, slower.
  double border_fraction = 0.3;
  // Keypoints of other kinds are not paired.
  KeypointKinds kinds;
};
[[nodiscard]] std::string Validate(const KeypointPairOptions& options);

struct KeypointPair {
  Eigen::Vector2f middle;  // submap frame [m]
  float direction;         // of the line from first to second [rad]
  std::vector<uint32_t> keys;
};

// Returns the pairs of each keypoint with the `num_partners` nearest of its
// partners, with one key each, each pair once; at most `max_num_pairs`, those
// of the strongest keypoints.
[[nodiscard]] std::vector<KeypointPair> PairsToStore(
    const KeypointPairOptions& options, int num_partners, size_t max_num_pairs,
    const FeatureSet& features);

// As PairsToStore, with all keys under which the same pair, seen a little
// differently, may have been stored.
[[nodiscard]] std::vector<KeypointPair> PairsToSeek(
    const KeypointPairOptions& options, int num_partners, size_t max_num_pairs,
    const FeatureSet& features);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_MATCHING_KEYPOINT_PAIRS_H_
