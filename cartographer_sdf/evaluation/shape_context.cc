// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/shape_context.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "cartographer_sdf/geometry/number_range.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

constexpr int kMaxNumShifts = 100;
// A mean shift that moves by less has converged [m].
constexpr double kLeastShift = 1e-4;

double SmallerEigenvalueFraction(const Eigen::Matrix2d& scatter) {
  const double trace = scatter.trace();
  if (!(trace > 0.)) return 0.;
  const double root =
      std::hypot(scatter(0, 0) - scatter(1, 1), 2. * scatter(0, 1));
  return std::clamp(0.5 * (trace - root) / trace, 0., 0.5);
}

// Returns the mode that the mean shift from `position` converges to.
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
    // Rounding may lose points on the very rim.
    if (!(sum_weights > 0.)) break;
    const Eigen::Vector2d mean = sum / sum_weights;
    const double length = (mean - position).norm();
    position = mean;
    if (length < kLeastShift) break;
  }
  return position;
}

// A mode, and the points whose mean shifts converge to it.
struct Mode {
  Eigen::Vector2d position;
  int num_points;
  double sum_curvatures;
};

// The indices of the points, highest weight first.
std::vector<size_t> ByFallingWeight(const std::vector<double>& weights) {
  std::vector<size_t> order(weights.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&weights](const size_t a, const size_t b) {
                     return weights[a] > weights[b];
                   });
  return order;
}

// Modes of points with higher curvature come first, and later ones join them.
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

// A mean offset shorter than this has no direction [m].
constexpr double kLeastOffset = 1e-6;

std::optional<double> Orientation(const SubmapCloud& cloud,
                                  const PointRaster& raster,
                                  const Eigen::Vector2d& centre,
                                  const double radius) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  raster.ForEachNear(centre, radius, [&](const int k) {
    sum += cloud[k] - centre;
    ++count;
  });
  if (count == 0 || sum.norm() < kLeastOffset * count) return std::nullopt;
  return std::atan2(sum.y(), sum.x());
}

// The angular index varies fastest. None if there is no point.
std::optional<Eigen::VectorXf> Describe(const ShapeContextOptions& options,
                                        const SubmapCloud& cloud,
                                        const PointRaster& raster,
                                        const Eigen::Vector2d& centre,
                                        const double orientation) {
  const int num_angular = options.num_angular_bins;
  Eigen::VectorXd histogram = Eigen::VectorXd::Zero(Eigen::Index{num_angular} *
                                                    options.num_radial_bins);
  raster.ForEachNear(centre, options.radius_meters, [&](const int k) {
    const Eigen::Vector2d d = cloud[k] - centre;
    const double octaves =
        std::log2(options.radius_meters /
                  std::max(d.norm(), 1e-9 * options.radius_meters));
    const int radial =
        std::max(0, options.num_radial_bins - 1 - static_cast<int>(octaves));
    // Splits the weight between the two nearest bin centres: with few bins, a
    // small error of the orientation would otherwise move whole walls to
    // another bin.
    const double turns =
        NormalizeAngle(std::atan2(d.y(), d.x()) - orientation) / (2. * M_PI);
    const double bin = (turns + 1.) * num_angular;
    const int low = static_cast<int>(bin);
    const double fraction = bin - low;
    histogram[radial * num_angular + low % num_angular] += 1. - fraction;
    histogram[radial * num_angular + (low + 1) % num_angular] += fraction;
  });
  const double sum = histogram.sum();
  if (!(sum > 0.)) return std::nullopt;
  return (histogram / sum).cwiseSqrt().cast<float>();
}

}  // namespace

std::string Validate(const CurvatureClusterOptions& options) {
  return FirstOutside(
      {{"scatter_radius_meters", options.scatter_radius_meters, 0.001, 100.},
       {"min_num_neighbours", options.min_num_neighbours, 1, 1e5},
       {"detection_threshold", options.detection_threshold, 1e-9, 0.5},
       {"cluster_radius_meters", options.cluster_radius_meters, 0.001, 100.},
       {"min_num_points", options.min_num_points, 1, 1e5}});
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
      // Relative to the point, to preserve precision far from the origin.
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

std::string Validate(const ShapeContextOptions& options) {
  return FirstOutside({{"radius_meters", options.radius_meters, 0.001, 100.},
                       {"num_radial_bins", options.num_radial_bins, 1, 100},
                       {"num_angular_bins", options.num_angular_bins, 2, 360},
                       {"orientation_radius_meters",
                        options.orientation_radius_meters, 0.001, 100.}});
}

std::string Validate(const CloudPlaceOptions& options) {
  for (const std::string& error :
       {Validate(options.cloud), Validate(options.keypoint),
        Validate(options.descriptor)}) {
    if (!error.empty()) return error;
  }
  return "";
}

FeatureSet DescribeByShapeContexts(const CloudPlaceOptions& options,
                                   const SubmapCloud& cloud) {
  CHECK_EQ(Validate(options), "");
  const ShapeContextOptions& descriptor = options.descriptor;
  const PointRaster raster(
      cloud,
      std::max(descriptor.radius_meters, descriptor.orientation_radius_meters));
  FeatureSet set;
  std::vector<Eigen::VectorXf> descriptors;
  for (const CurvatureCluster& cluster :
       FindCurvatureClusters(options.keypoint, cloud)) {
    const std::optional<double> orientation = Orientation(
        cloud, raster, cluster.position, descriptor.orientation_radius_meters);
    if (!orientation) continue;
    std::optional<Eigen::VectorXf> description =
        Describe(descriptor, cloud, raster, cluster.position, *orientation);
    if (!description) continue;
    set.features.push_back({Keypoint{cluster.position, 0.,
                                     KeypointKind::kMinimum, cluster.curvature},
                            *orientation});
    descriptors.push_back(*std::move(description));
  }
  set.descriptors.resize(
      Eigen::Index{descriptor.num_radial_bins} * descriptor.num_angular_bins,
      static_cast<Eigen::Index>(descriptors.size()));
  for (size_t k = 0; k < descriptors.size(); ++k) {
    set.descriptors.col(static_cast<Eigen::Index>(k)) = descriptors[k];
  }
  return set;
}

absl::StatusOr<DescribedMap> DescribeMapByShapeContexts(
    const CloudPlaceOptions& options, const std::string& path,
    const Executor& executor, const ProgressCallback& on_progress) {
  absl::StatusOr<MapState> state = ReadMap(path);
  if (!state.ok()) return state.status();
  const absl::StatusOr<std::map<SubmapId, SubmapCloud>> clouds =
      ReadSubmapClouds(options.cloud, path, state->pose_graph, on_progress);
  if (!clouds.ok()) return clouds.status();
  std::vector<std::pair<SubmapId, const SubmapCloud*>> submaps;
  for (const auto& [id, cloud] : *clouds) submaps.emplace_back(id, &cloud);
  std::vector<Place> places(submaps.size());
  executor(submaps.size(), [&](const size_t k) {
    places[k].id = submaps[k].first;
    places[k].features = DescribeByShapeContexts(options, *submaps[k].second);
  });
  DescribedMap map;
  map.state = *std::move(state);
  map.odometry = OdometryPoses(map.state);
  for (Place& place : places) {
    const SubmapId id = place.id;
    map.places.emplace(id, std::move(place));
  }
  return map;
}

}  // namespace cartographer_sdf
