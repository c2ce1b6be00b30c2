// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/curvature_clusters.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cartographer_sdf/evaluation/point_raster.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr int kMaxNumShifts = 100;
// A mean shift that moves less has arrived [m].
constexpr double kLeastShift = 1e-4;

double SmallerEigenvalueFraction(const Eigen::Matrix2d& scatter) {
  const double trace = scatter.trace();
  if (!(trace > 0.)) return 0.;
  const double root =
      std::hypot(scatter(0, 0) - scatter(1, 1), 2. * scatter(0, 1));
  return std::clamp(0.5 * (trace - root) / trace, 0., 0.5);
}

// Where the mean shift ends that starts at `position`.
Eigen::Vector2d FindMode(const PointRaster& raster, const SubmapCloud& points,
                         const std::vector<double>& weights,
                         const double radius, Eigen::Vector2d position) {
  for (int shift = 0; shift < kMaxNumShifts; ++shift) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double sum_weights = 0.;
    raster.ForEachNear(position, radius, [&](const int k) {
      sum += weights[k] * points[k];
      sum_weights += weights[k];
    });
    // By rounding, points on the very rim may be lost.
    if (!(sum_weights > 0.)) break;
    const Eigen::Vector2d mean = sum / sum_weights;
    const double length = (mean - position).norm();
    position = mean;
    if (length < kLeastShift) break;
  }
  return position;
}

// Where mean shifts end, and what began them.
struct Mode {
  Eigen::Vector2d position;
  int num_points;
  double sum_curvatures;
};

// The indices of the points, the sharpest first.
std::vector<size_t> ByFallingWeight(const std::vector<double>& weights) {
  std::vector<size_t> order(weights.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&weights](const size_t a, const size_t b) {
                     return weights[a] > weights[b];
                   });
  return order;
}

// The modes of the sharpest points are the ones that others join.
std::vector<Mode> FindModes(const SubmapCloud& points,
                            const std::vector<double>& weights,
                            const double radius) {
  const PointRaster raster(points, radius);
  std::vector<Mode> modes;
  for (const size_t k : ByFallingWeight(weights)) {
    const Eigen::Vector2d mode =
        FindMode(raster, points, weights, radius, points[k]);
    const auto known =
        std::find_if(modes.begin(), modes.end(), [&](const Mode& other) {
          return (other.position - mode).norm() < radius;
        });
    if (known == modes.end()) {
      modes.push_back({mode, 1, weights[k]});
    } else {
      ++known->num_points;
      known->sum_curvatures += weights[k];
    }
  }
  return modes;
}

}  // namespace

std::string Validate(const CurvatureClusterOptions& options) {
  if (!(options.scatter_radius_meters > 0. &&
        options.scatter_radius_meters <= 100.)) {
    return "scatter_radius_meters must lie between 0 and 100";
  }
  if (options.min_num_neighbours < 1) {
    return "min_num_neighbours must be positive";
  }
  if (!(options.detection_threshold > 0. &&
        options.detection_threshold <= 0.5)) {
    return "detection_threshold must lie between 0 and 0.5";
  }
  if (!(options.cluster_radius_meters > 0. &&
        options.cluster_radius_meters <= 100.)) {
    return "cluster_radius_meters must lie between 0 and 100";
  }
  if (options.min_num_points < 1) return "min_num_points must be positive";
  return "";
}

std::vector<double> Curvatures(const CurvatureClusterOptions& options,
                               const SubmapCloud& cloud) {
  CHECK_EQ(Validate(options), "");
  const PointRaster raster(cloud, options.scatter_radius_meters);
  std::vector<double> curvatures;
  for (const Eigen::Vector2d& centre : cloud) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    Eigen::Matrix2d sum_squares = Eigen::Matrix2d::Zero();
    int count = 0;
    raster.ForEachNear(centre, options.scatter_radius_meters, [&](const int k) {
      // Relative, lest far from the origin digits are lost.
      const Eigen::Vector2d d = cloud[k] - centre;
      sum += d;
      sum_squares += d * d.transpose();
      ++count;
    });
    curvatures.push_back(
        count < options.min_num_neighbours
            ? 0.
            : SmallerEigenvalueFraction(sum_squares -
                                        sum * sum.transpose() / count));
  }
  return curvatures;
}

std::vector<CurvatureCluster> FindCurvatureClusters(
    const CurvatureClusterOptions& options, const SubmapCloud& cloud) {
  const std::vector<double> curvatures = Curvatures(options, cloud);
  SubmapCloud points;
  std::vector<double> weights;
  for (size_t k = 0; k < cloud.size(); ++k) {
    if (curvatures[k] <= options.detection_threshold) continue;
    points.push_back(cloud[k]);
    weights.push_back(curvatures[k]);
  }
  std::vector<Mode> modes =
      FindModes(points, weights, options.cluster_radius_meters);
  std::stable_sort(
      modes.begin(), modes.end(),
      [](const Mode& a, const Mode& b) { return a.num_points > b.num_points; });
  std::vector<CurvatureCluster> clusters;
  for (const Mode& mode : modes) {
    if (mode.num_points < options.min_num_points) continue;
    clusters.push_back({mode.position, mode.sum_curvatures / mode.num_points});
  }
  return clusters;
}

}  // namespace cartographer_sdf
