// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Rotation-invariant descriptors of the surroundings of keypoints
// ([Millane2019], Sec. IV-C): a histogram of the field's gradient orientations
// in a circular window, relative to the dominant orientation, followed by the
// window's mean distance to walls.

#ifndef CARTOGRAPHER_SDF_FEATURE_DESCRIPTOR_H_
#define CARTOGRAPHER_SDF_FEATURE_DESCRIPTOR_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cartographer_sdf/feature/keypoint.h"
#include "cartographer_sdf/field/distance_field.h"

namespace cartographer_sdf {

struct DescriptorOptions {
  double radius_meters = 0.8;  // Table I
  int num_bins = 17;           // Table I
  // Bins of the histogram that finds the dominant orientation ([Lowe2004]).
  int num_orientation_bins = 36;
  // The last entry is this times the weighted mean distance *in millimetres*,
  // beside a histogram of unit length; Table I gives 0.002 without a unit.
  // Larger: separates places of different width more sharply.
  double distance_weight = 0.002;
  // Standard deviation of the Gaussian that favours central gradients, as a
  // fraction of the radius. The paper does not specify it; [Lowe2004] uses half
  // of the window's width.
  double gaussian_sigma_ratio = 0.5;
  // Each further peak of the orientation histogram above this fraction of the
  // highest yields another feature, as in [Lowe2004]; 1: only the highest, as
  // in the paper.
  double secondary_orientation_ratio = 1.;
};
[[nodiscard]] std::string Validate(const DescriptorOptions& options);

// How far from a keypoint's cell the smoothed field is read [cells].
[[nodiscard]] int SmoothedReach(const DescriptorOptions& options,
                                double resolution);

// A keypoint with one orientation.
struct Feature {
  Keypoint keypoint;
  double orientation;  // dominant gradient direction, submap frame [rad]
};

// Features of one submap; column k of `descriptors` belongs to features[k].
struct FeatureSet {
  std::vector<Feature> features;
  Eigen::MatrixXf descriptors;  // (num_bins + 1) x number of features
};

// Returns features in the order of the keypoints; a window without any gradient
// yields none. `smoothed` is SmoothField's result, or SmoothFieldNearObserved's
// with a reach of at least SmoothedReach.
[[nodiscard]] FeatureSet DescribeKeypoints(
    const DescriptorOptions& options, const DistanceField& field,
    const Eigen::ArrayXXf& smoothed, const std::vector<Keypoint>& keypoints);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_FEATURE_DESCRIPTOR_H_
