// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/shape_context.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "cartographer_sdf/evaluation/point_raster.h"
#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

// A middle of points this near to the keypoint has no direction [m].
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

// Bins of the direction run fastest. None where there is no point.
std::optional<Eigen::VectorXf> Describe(const ShapeContextOptions& options,
                                        const SubmapCloud& cloud,
                                        const PointRaster& raster,
                                        const Eigen::Vector2d& centre,
                                        const double orientation) {
  const int num_angular = options.num_angular_bins;
  Eigen::VectorXd histogram =
      Eigen::VectorXd::Zero(options.num_radial_bins * num_angular);
  raster.ForEachNear(centre, options.radius_meters, [&](const int k) {
    const Eigen::Vector2d d = cloud[k] - centre;
    const double octaves =
        std::log2(options.radius_meters /
                  std::max(d.norm(), 1e-9 * options.radius_meters));
    const int radial =
        std::max(0, options.num_radial_bins - 1 - static_cast<int>(octaves));
    // Split between the two bins whose centres are nearest: with few bins, a
    // small error of the orientation would else move whole walls.
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

std::string Validate(const ShapeContextOptions& options) {
  if (!(options.radius_meters > 0. && options.radius_meters <= 100.)) {
    return "radius_meters must lie between 0 and 100";
  }
  if (options.num_radial_bins < 1 || options.num_radial_bins > 100) {
    return "num_radial_bins must lie between 1 and 100";
  }
  if (options.num_angular_bins < 2 || options.num_angular_bins > 360) {
    return "num_angular_bins must lie between 2 and 360";
  }
  if (!(options.orientation_radius_meters > 0. &&
        options.orientation_radius_meters <= 100.)) {
    return "orientation_radius_meters must lie between 0 and 100";
  }
  return "";
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
      descriptor.num_radial_bins * descriptor.num_angular_bins,
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
