// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Keypoints of the distance field: places where its graph bends most, in free
// space as well as on walls ([Millane2019], Sec. IV-B). The determinant of the
// Hessian of the smoothed field, in units of cells, is searched for local
// extrema of its magnitude; the signs of the Hessian's eigenvalues give the
// class. Heuristic; linear in the number of cells (times: place_benchmark).

#ifndef CARTOGRAPHER_SDF_FEATURE_KEYPOINT_H_
#define CARTOGRAPHER_SDF_FEATURE_KEYPOINT_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cartographer_sdf/field/distance_field.h"

namespace cartographer_sdf {

struct KeypointOptions {
  // Standard deviation of the Gaussian before differentiation [cells]. The
  // paper leaves it open. Larger: fewer, smoother keypoints.
  double smoothing_sigma_cells = 3.;
  // Least magnitude of the determinant [1 / cells^2]; Table I.
  double detection_threshold = 0.0025;
  // A keypoint is extremal within a square of this half width [cells].
  int non_maximum_suppression_cells = 4;
  // Keypoints this near to a border between free and unobserved cells are
  // dropped [cells]; walls are no such border. The paper leaves it open.
  double unobserved_border_cells = 1.5;
  // Keypoints farther from any wall are dropped [m], which is how
  // [Millane2019] measures what free space is worth. No lidar sees this far.
  double max_clearance_meters = 1000.;
};
[[nodiscard]] std::string Validate(const KeypointOptions& options);

// Between obstacles, on surfaces, in narrow places ([Millane2019], Sec. IV-C).
enum class KeypointKind { kMaximum, kMinimum, kSaddle };
constexpr int kNumKeypointKinds = 3;

struct Keypoint {
  Eigen::Vector2d position;  // submap frame [m], sub-cell
  double clearance;          // signed distance to the nearest wall [m]
  KeypointKind kind;
  double strength;  // magnitude of the determinant [1 / cells^2]
};

// The field in cells, convolved with a Gaussian; beyond the rim the rim's value
// is continued.
[[nodiscard]] Eigen::ArrayXXf SmoothField(const DistanceField& field,
                                          double sigma_cells);

// In the order of memory (j, then i). `smoothed` is SmoothField's result.
[[nodiscard]] std::vector<Keypoint> DetectKeypoints(
    const KeypointOptions& options, const DistanceField& field,
    const Eigen::ArrayXXf& smoothed);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_FEATURE_KEYPOINT_H_
