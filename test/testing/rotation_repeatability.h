// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// How well keypoints and descriptors are found again in a turned grid.

#ifndef TEST_TESTING_ROTATION_REPEATABILITY_H_
#define TEST_TESTING_ROTATION_REPEATABILITY_H_

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <vector>

#include "cartographer_sdf/feature/descriptor.h"
#include "cartographer_sdf/feature/keypoint.h"
#include "cartographer_sdf/field/distance_field.h"
#include "cartographer_sdf/field/distance_transform.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/grid/turned_grid.h"

namespace cartographer_sdf::testing {

struct DescribedGrid {
  DistanceField field;
  FeatureSet features;
};

inline std::optional<DescribedGrid> DescribeGrid(
    const OccupancyGrid& grid, const KeypointOptions& keypoint_options = {},
    const DescriptorOptions& descriptor_options = {}) {
  std::optional<DistanceField> field = MakeDistanceField({}, grid);
  if (!field) return std::nullopt;
  const Eigen::ArrayXXf smoothed =
      SmoothField(*field, keypoint_options.smoothing_sigma_cells);
  FeatureSet features =
      DescribeKeypoints(descriptor_options, *field, smoothed,
                        DetectKeypoints(keypoint_options, *field, smoothed));
  return DescribedGrid{*std::move(field), std::move(features)};
}

// Distance of each cell to the nearest unobserved one beside a free one
// [cells].
inline Eigen::ArrayXXd DistanceToUnobserved(const DistanceField& field) {
  BoolArray frontier =
      BoolArray::Constant(field.observed.rows(), field.observed.cols(), false);
  const auto free = [&field](const Eigen::Index i, const Eigen::Index j) {
    return field.observed(i, j) && field.distance(i, j) > 0.f;
  };
  for (Eigen::Index j = 1; j + 1 < frontier.cols(); ++j) {
    for (Eigen::Index i = 1; i + 1 < frontier.rows(); ++i) {
      frontier(i, j) =
          !field.observed(i, j) && (free(i - 1, j) || free(i + 1, j) ||
                                    free(i, j - 1) || free(i, j + 1));
    }
  }
  if (!frontier.any()) {
    return Eigen::ArrayXXd::Constant(frontier.rows(), frontier.cols(), 1e9);
  }
  return SquaredDistanceTransform(frontier).cast<double>().sqrt();
}

struct Repeatability {
  std::array<int, kNumKeypointKinds> num_keypoints = {};
  std::array<int, kNumKeypointKinds> num_found = {};
  // Between what corresponds, and between features of one kind that do not.
  std::vector<double> same, other;

  [[nodiscard]] double Fraction(const std::set<KeypointKind>& kinds) const {
    int keypoints = 0, found = 0;
    for (const KeypointKind kind : kinds) {
      keypoints += num_keypoints[static_cast<int>(kind)];
      found += num_found[static_cast<int>(kind)];
    }
    return static_cast<double>(found) / keypoints;
  }
  [[nodiscard]] double Fraction() const {
    return Fraction({KeypointKind::kMaximum, KeypointKind::kMinimum,
                     KeypointKind::kSaddle});
  }
  [[nodiscard]] int NumKeypoints() const {
    return num_keypoints[0] + num_keypoints[1] + num_keypoints[2];
  }
  [[nodiscard]] static double Median(std::vector<double> values) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto middle =
        values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  }
};

// Counts the features of `original` that are farther than `border_cells` from
// where observation ends, and those of them that `turned` has, of the same
// kind, within `tolerance_cells` of the place that `angle` takes them to.
inline void AddRepeatability(const DescribedGrid& original,
                             const DescribedGrid& turned, const double angle,
                             const double border_cells,
                             const double tolerance_cells,
                             Repeatability* const result) {
  const CellGeometry& geometry = original.field.geometry;
  const Eigen::ArrayXXd to_unobserved = DistanceToUnobserved(original.field);
  for (size_t k = 0; k < original.features.features.size(); ++k) {
    const Keypoint& keypoint = original.features.features[k].keypoint;
    const Eigen::Array2i cell = geometry.CellAt(keypoint.position);
    if (to_unobserved(cell.x(), cell.y()) < border_cells) continue;
    ++result->num_keypoints[static_cast<int>(keypoint.kind)];
    const Eigen::Vector2d expected = Rigid2(0., 0., angle) * keypoint.position;
    double best = std::numeric_limits<double>::infinity();
    for (size_t t = 0; t < turned.features.features.size(); ++t) {
      const Keypoint& other = turned.features.features[t].keypoint;
      if (other.kind != keypoint.kind) continue;
      const double distance = (turned.features.descriptors.col(t) -
                               original.features.descriptors.col(k))
                                  .norm();
      if ((other.position - expected).norm() <=
          tolerance_cells * geometry.resolution) {
        best = std::min(best, distance);
      } else {
        result->other.push_back(distance);
      }
    }
    if (std::isinf(best)) continue;
    ++result->num_found[static_cast<int>(keypoint.kind)];
    result->same.push_back(best);
  }
}

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_ROTATION_REPEATABILITY_H_
