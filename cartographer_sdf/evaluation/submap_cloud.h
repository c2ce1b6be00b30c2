// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Submaps as point clouds, for the baseline method ([Millane2019], Sec. V-A):
// back-projected scans, aggregated with the optimised trajectory.

#ifndef CARTOGRAPHER_SDF_EVALUATION_SUBMAP_CLOUD_H_
#define CARTOGRAPHER_SDF_EVALUATION_SUBMAP_CLOUD_H_

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/pbstream/map_file.h"

namespace cartographer_sdf {

struct SubmapCloudOptions {
  // Scans used per submap, evenly spaced ([Millane2019]: about 30).
  int max_num_scans = 30;
  // Points in one square of this side are replaced by their mean [m], so that
  // surfaces seen from close by or in many scans do not weigh more.
  double voxel_size_meters = 0.05;
};
[[nodiscard]] std::string Validate(const SubmapCloudOptions& options);

using SubmapCloud = std::vector<Eigen::Vector2d>;  // submap frame [m]

// A square of a raster with the given side [m].
using Square = std::pair<int64_t, int64_t>;
[[nodiscard]] Square SquareAt(const Eigen::Vector2d& point, double side);

// Means of the points in each square of a raster, in the order of the raster.
[[nodiscard]] SubmapCloud DownsampleCloud(const SubmapCloud& cloud,
                                          double voxel_size);

// A cloud sorted into squares, for radius search. Holds a reference to the
// points.
class PointRaster {
 public:
  // `radius` > 0 is the largest search radius.
  PointRaster(const SubmapCloud& points, double radius);

  // Calls `function(index)` for each point within the radius of `centre`, in an
  // order that depends only on the points and the centre.
  template <typename Function>
  void ForEachNear(const Eigen::Vector2d& centre, const double radius,
                   const Function& function) const {
    const auto [x, y] = SquareAt(centre, side_);
    for (int64_t j = y - 1; j <= y + 1; ++j) {
      for (int64_t i = x - 1; i <= x + 1; ++i) {
        const auto square = squares_.find({i, j});
        if (square == squares_.end()) continue;
        for (const int k : square->second) {
          if ((points_[k] - centre).squaredNorm() <= radius * radius) {
            function(k);
          }
        }
      }
    }
  }

 private:
  const SubmapCloud& points_;
  const double side_;
  std::map<Square, std::vector<int>> squares_;
};

// Returns a cloud for each submap of the pose graph that scans were inserted
// into. Skips nodes without a point cloud. The file holds clouds as the host
// matched them: undistorted and gravity-aligned. Fails as ReadPointClouds does.
[[nodiscard]] absl::StatusOr<std::map<SubmapId, SubmapCloud>> ReadSubmapClouds(
    const SubmapCloudOptions& options, const std::string& path,
    const PoseGraph& pose_graph, const ProgressCallback& on_progress = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_SUBMAP_CLOUD_H_
