// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Keypoints of the distance field: points where its graph bends most, in free
// space as well as on walls ([Millane2019], Sec. IV-B). They are the local
// maxima of the magnitude of the determinant of the smoothed field's Hessian,
// in units of cells; the signs of its eigenvalues give the kind. Heuristic;
// linear in the number of cells (times: place_benchmark).

#ifndef CARTOGRAPHER_SDF_FEATURE_KEYPOINT_H_
#define CARTOGRAPHER_SDF_FEATURE_KEYPOINT_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cartographer_sdf/field/distance_field.h"

namespace cartographer_sdf {

struct KeypointOptions {
  // Standard deviation of the Gaussian applied before differentiation [cells].
  // The paper does not specify it. Larger: fewer, smoother keypoints.
  double smoothing_sigma_cells = 3.;
  // Least magnitude of the determinant [1 / cells^2]; Table I.
  double detection_threshold = 0.0025;
  // A keypoint is extremal within a square of this half width [cells].
  int non_maximum_suppression_cells = 4;
  // Keypoints within this distance of a border between free and unobserved
  // cells are dropped [cells]; walls are no such border. The paper does not
  // specify it.
  double unobserved_border_cells = 1.5;
  // Keypoints farther than this from every wall are dropped [m]; [Millane2019]
  // measures the value of free space this way. No lidar sees as far as the
  // default.
  double max_clearance_meters = 1000.;
};
[[nodiscard]] std::string Validate(const KeypointOptions& options);

// Between obstacles, on surfaces, in narrow places ([Millane2019], Sec. IV-C).
enum class KeypointKind { kMaximum, kMinimum, kSaddle };
constexpr int kNumKeypointKinds = 3;

// The kinds that a stage uses, to measure what each is worth.
struct KeypointKinds {
  bool maxima = true;
  bool minima = true;
  bool saddles = true;
};
[[nodiscard]] std::string Validate(const KeypointKinds& kinds);
[[nodiscard]] bool Contains(const KeypointKinds& kinds, KeypointKind kind);

struct Keypoint {
  Eigen::Vector2d position;  // submap frame [m], sub-cell
  double clearance;          // signed distance to the nearest wall [m]
  KeypointKind kind;
  double strength;  // magnitude of the determinant [1 / cells^2]
};

// Returns the field in units of cells, convolved with a Gaussian; beyond the
// rim, the rim's values are repeated.
[[nodiscard]] Eigen::ArrayXXf SmoothField(const DistanceField& field,
                                          double sigma_cells);

// The same only at cells that are at most `reach` rows and columns away from an
// observed one, undefined elsewhere: for a fraction of the time, as most cells
// of a large submap are far from any.
[[nodiscard]] Eigen::ArrayXXf SmoothFieldNearObserved(
    const DistanceField& field, double sigma_cells, int reach);

// Returns keypoints in memory order (j, then i). `smoothed` is SmoothField's
// result, or SmoothFieldNearObserved's with a reach of at least
// non_maximum_suppression_cells + 1.
[[nodiscard]] std::vector<Keypoint> DetectKeypoints(
    const KeypointOptions& options, const DistanceField& field,
    const Eigen::ArrayXXf& smoothed);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_FEATURE_KEYPOINT_H_
