// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_PBSTREAM_POINT_CLOUD_H_
#define CARTOGRAPHER_SDF_PBSTREAM_POINT_CLOUD_H_

#include <Eigen/Core>
#include <vector>

namespace cartographer_sdf {

// Points of a node's range data in its gravity-aligned frame, the node frame of
// the pose graph [m].
using PointCloud2 = std::vector<Eigen::Vector2f>;

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_POINT_CLOUD_H_
