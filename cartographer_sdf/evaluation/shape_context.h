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

#include <Eigen/Core>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/evaluation/submap_cloud.h"
#include "cartographer_sdf/feature/descriptor.h"
#include "cartographer_sdf/place_store/described_map.h"

namespace cartographer_sdf {

// Keypoints of a 2D point cloud where its surfaces bend, after [BosseZlot2009].
// The curvature at a point is the smaller eigenvalue of the scatter of the
// points around it, as a fraction of the sum of both: 0 on straight walls, 0.5
// where the points spread equally in all directions. Points of high curvature
// are clustered by mean shift, weighted by curvature; the modes are the
// keypoints. Heuristic.
struct CurvatureClusterOptions {
  // Points within this distance make up the scatter [m]. Larger: corners of
  // furniture blur, corners of rooms stand out.
  double scatter_radius_meters = 0.4;
  // Points with fewer neighbours, themselves included, have no curvature.
  int min_num_neighbours = 5;
  // Least curvature of a point, 0 to 0.5; [Millane2019], Table I.
  double detection_threshold = 0.05;
  // The mean shift's window [m]; keypoints are at least this far apart.
  double cluster_radius_meters = 0.4;
  // Clusters of fewer points are noise.
  int min_num_points = 3;
};
[[nodiscard]] std::string Validate(const CurvatureClusterOptions& options);

struct CurvatureCluster {
  Eigen::Vector2d position;  // in the frame of the cloud [m]
  double curvature;          // mean of its points
};

// The curvature at each point of the cloud; 0 if it has too few neighbours.
[[nodiscard]] std::vector<double> Curvatures(
    const CurvatureClusterOptions& options, const SubmapCloud& cloud);

// Most points first.
[[nodiscard]] std::vector<CurvatureCluster> FindCurvatureClusters(
    const CurvatureClusterOptions& options, const SubmapCloud& cloud);

struct ShapeContextOptions {
  double radius_meters = 2.;  // [Millane2019], Table I
  // Table I. Each bin reaches twice as far as the one inside it.
  int num_radial_bins = 3;
  int num_angular_bins = 6;  // Table I
  // Points within this distance determine the orientation [m].
  double orientation_radius_meters = 1.;
};
[[nodiscard]] std::string Validate(const ShapeContextOptions& options);

struct CloudPlaceOptions {
  SubmapCloudOptions cloud;
  CurvatureClusterOptions keypoint;
  ShapeContextOptions descriptor;
};
[[nodiscard]] std::string Validate(const CloudPlaceOptions& options);

// Features of a cloud in its frame, all of one kind and with clearance 0, in
// the order of the clusters. A keypoint whose surroundings have no orientation,
// or no points, yields no feature.
[[nodiscard]] FeatureSet DescribeByShapeContexts(
    const CloudPlaceOptions& options, const SubmapCloud& cloud);

// Describes a whole map. Its places have no surface, so only method kPaper can
// match them.
[[nodiscard]] absl::StatusOr<DescribedMap> DescribeMapByShapeContexts(
    const CloudPlaceOptions& options, const std::string& path,
    const Executor& executor, const ProgressCallback& on_progress = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_SHAPE_CONTEXT_H_
