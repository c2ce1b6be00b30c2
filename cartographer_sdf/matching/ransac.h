// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The paper's alignment of two submaps ([Millane2019], Sec. IV-D): the rigid
// motion on which most correspondences agree ([Fischler1981]). If there are no
// more pairs of correspondences than iterations, every pair is tried; otherwise
// a generator seeded by the caller draws pairs, so that results are
// reproducible.

#ifndef CARTOGRAPHER_SDF_MATCHING_RANSAC_H_
#define CARTOGRAPHER_SDF_MATCHING_RANSAC_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/matching/correspondence.h"

namespace cartographer_sdf {

struct RansacOptions {
  int max_num_iterations = 2000;
  // A correspondence is an inlier if its points come within this distance [m].
  double inlier_distance_meters = 0.3;
  // Two correspondences nearer than this determine no rotation [m].
  double min_baseline_meters = 1.;
};
[[nodiscard]] std::string Validate(const RansacOptions& options);

struct Alignment {
  Rigid2 T_reference_query;  // least squares over the inliers
  std::vector<Correspondence> inliers;
};

// Returns nullopt if no two correspondences agree. Of equally good motions, the
// first found wins. Each reference and each query keypoint occurs at most once
// among the inliers.
[[nodiscard]] std::optional<Alignment> AlignByRansac(
    const RansacOptions& options, const FeatureSet& reference,
    const FeatureSet& query, const std::vector<Correspondence>& correspondences,
    uint64_t seed);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_MATCHING_RANSAC_H_
