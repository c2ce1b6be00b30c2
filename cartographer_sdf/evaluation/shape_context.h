// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The comparison method of [Millane2019]: curvature clusters described by shape
// contexts ([Belongie2002]), histograms of where the points around a keypoint
// lie, in bins of the logarithm of the distance and of the direction.
//
// The directions are relative to that of the middle of the points around the
// keypoint (the opening of a corner), so that descriptors do not depend on how
// the submap is turned. Histograms are normalised, and their square roots are
// taken: the Euclidean distance that matching uses is then Hellinger's, which
// is near to the chi-square distance that [Belongie2002] compares histograms
// by.

#ifndef CARTOGRAPHER_SDF_EVALUATION_SHAPE_CONTEXT_H_
#define CARTOGRAPHER_SDF_EVALUATION_SHAPE_CONTEXT_H_

#include <map>
#include <string>

#include "absl/status/statusor.h"
#include "cartographer_sdf/evaluation/curvature_clusters.h"
#include "cartographer_sdf/evaluation/submap_cloud.h"
#include "cartographer_sdf/feature/descriptor.h"
#include "cartographer_sdf/place_store/described_map.h"

namespace cartographer_sdf {

struct ShapeContextOptions {
  double radius_meters = 2.;  // [Millane2019], Table I
  // Table I. Each bin reaches twice as far as the one inside it.
  int num_radial_bins = 3;
  int num_angular_bins = 6;  // Table I
  // Points within this distance fix the direction [m].
  double orientation_radius_meters = 1.;
};
[[nodiscard]] std::string Validate(const ShapeContextOptions& options);

struct CloudPlaceOptions {
  SubmapCloudOptions cloud;
  CurvatureClusterOptions keypoint;
  ShapeContextOptions descriptor;
};
[[nodiscard]] std::string Validate(const CloudPlaceOptions& options);

// Features of a cloud in its frame, all of one kind and at no distance to
// walls, in the order of the clusters. A keypoint whose surroundings have no
// direction, or no points, yields no feature.
[[nodiscard]] FeatureSet DescribeByShapeContexts(
    const CloudPlaceOptions& options, const SubmapCloud& cloud);

// Of a whole map; places have no surface, so that only method kPaper can match
// them.
[[nodiscard]] absl::StatusOr<DescribedMap> DescribeMapByShapeContexts(
    const CloudPlaceOptions& options, const std::string& path,
    const Executor& executor, const ProgressCallback& on_progress = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_SHAPE_CONTEXT_H_
