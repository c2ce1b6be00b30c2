// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_CLOSURE_LOOP_CLOSURE_H_
#define CARTOGRAPHER_SDF_CLOSURE_LOOP_CLOSURE_H_

#include <Eigen/Core>

#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/submap_id.h"

namespace cartographer_sdf {

// Why a match is believed.
struct ClosureEvidence {
  // Keypoint correspondences that agree with the pose.
  int inliers = 0;
  // Observed area seen by both [m^2], and as a fraction of the smaller one.
  double overlap_area = 0.;
  double overlap = 0.;
  // Of the wall points of either submap that fall into what the other has
  // observed: the fraction (weighted by certainty) on a wall of the other, and
  // the fraction deep in its free space. The worse of both directions.
  double hit_ratio = 0.;
  double contradiction_ratio = 0.;
  // Root mean square distance of the hits to the other's walls [m].
  double residual = 0.;
};

// A verified match of two submaps, to become constraints of the pose graph.
struct LoopClosure {
  SubmapId reference;
  SubmapId query;
  Rigid2 T_reference_query;
  // Inverse covariance of (x, y, yaw) of T_reference_query, [m, m, rad], in the
  // reference frame; scaled for independent residuals, hence optimistic.
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  // Log-odds of being right; comparable across pairs and maps.
  double score = 0.;
  ClosureEvidence evidence;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CLOSURE_LOOP_CLOSURE_H_
