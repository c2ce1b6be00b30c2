// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Keypoints of a 2D point cloud where its surfaces bend: the comparison method
// of [Millane2019], after [BosseZlot2009]. The curvature at a point is the
// smaller eigenvalue of the scatter of the points around it, as a fraction of
// both: 0 on straight walls, 0.5 where they spread alike in all directions.
// Points of high curvature are clustered by mean shift, weighed by curvature;
// the modes are the keypoints. Heuristic.

#ifndef CARTOGRAPHER_SDF_EVALUATION_CURVATURE_CLUSTERS_H_
#define CARTOGRAPHER_SDF_EVALUATION_CURVATURE_CLUSTERS_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cartographer_sdf/evaluation/submap_cloud.h"

namespace cartographer_sdf {

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

// Of each point of the cloud; 0 where there are too few neighbours.
[[nodiscard]] std::vector<double> Curvatures(
    const CurvatureClusterOptions& options, const SubmapCloud& cloud);

// Most points first.
[[nodiscard]] std::vector<CurvatureCluster> FindCurvatureClusters(
    const CurvatureClusterOptions& options, const SubmapCloud& cloud);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_CURVATURE_CLUSTERS_H_
