// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/feature/descriptor.h"

#include <algorithm>
#include <cmath>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

using Eigen::ArrayXXf;
using Eigen::Index;

constexpr double kMillimetresPerMetre = 1000.;

struct WeightedGradient {
  double orientation;  // grid frame, [0, 2 pi)
  double weight;
};

struct Window {
  std::vector<WeightedGradient> gradients;
  double mean_distance = 0.;  // [m]
};

// Adds `weight` to the two bins nearest to the angle, by their closeness. Bin k
// is centred on k * 2 pi / n.
void AddToHistogram(const double angle, const double weight,
                    std::vector<double>* const histogram) {
  const int n = static_cast<int>(histogram->size());
  const double bin = angle * n / (2. * M_PI);
  const double floor = std::floor(bin);
  const int low = ((static_cast<int>(floor) % n) + n) % n;
  const double fraction = bin - floor;
  (*histogram)[low] += (1. - fraction) * weight;
  (*histogram)[(low + 1) % n] += fraction * weight;
}

// Gradients of the smoothed field and the mean distance within the radius of a
// point given in (continuous) cells; what lies beyond the rim is left out.
Window ExtractWindow(const DescriptorOptions& options,
                     const DistanceField& field, const ArrayXXf& smoothed,
                     const Eigen::Vector2d& centre) {
  const double radius = options.radius_meters / field.geometry.resolution;
  const double sigma = options.gaussian_sigma_ratio * radius;
  const double exponent = -0.5 / (sigma * sigma);
  const auto first = [radius](const double c) {
    return std::max<Index>(1, static_cast<Index>(std::ceil(c - radius)));
  };
  const auto last = [radius](const double c, const Index size) {
    return std::min<Index>(size - 2,
                           static_cast<Index>(std::floor(c + radius)));
  };
  Window window;
  double sum = 0., sum_distance = 0.;
  for (Index j = first(centre.y()); j <= last(centre.y(), smoothed.cols());
       ++j) {
    for (Index i = first(centre.x()); i <= last(centre.x(), smoothed.rows());
         ++i) {
      const double dx = static_cast<double>(i) - centre.x();
      const double dy = static_cast<double>(j) - centre.y();
      const double squared = dx * dx + dy * dy;
      if (squared > radius * radius) continue;
      const double gaussian = std::exp(exponent * squared);
      const double gx = 0.5 * (smoothed(i + 1, j) - smoothed(i - 1, j));
      const double gy = 0.5 * (smoothed(i, j + 1) - smoothed(i, j - 1));
      const double angle = std::atan2(gy, gx);
      window.gradients.push_back({angle < 0. ? angle + 2. * M_PI : angle,
                                  gaussian * std::hypot(gx, gy)});
      sum += gaussian;
      sum_distance += gaussian * field.distance(i, j);
    }
  }
  if (sum > 0.) window.mean_distance = sum_distance / sum;
  return window;
}

// Peaks of the circular histogram, at sub-bin positions [rad], highest first.
std::vector<double> DominantOrientations(const DescriptorOptions& options,
                                         const Window& window) {
  const int n = options.num_orientation_bins;
  std::vector<double> raw(n, 0.), histogram(n);
  for (const WeightedGradient& gradient : window.gradients) {
    AddToHistogram(gradient.orientation, gradient.weight, &raw);
  }
  for (int k = 0; k < n; ++k) {
    histogram[k] =
        0.25 * raw[(k + n - 1) % n] + 0.5 * raw[k] + 0.25 * raw[(k + 1) % n];
  }
  std::vector<std::pair<double, double>> peaks;  // (-height, angle)
  const double highest = *std::max_element(histogram.begin(), histogram.end());
  if (!(highest > 0.)) return {};
  for (int k = 0; k < n; ++k) {
    const double before = histogram[(k + n - 1) % n], at = histogram[k],
                 after = histogram[(k + 1) % n];
    if (at <= before || at < after ||
        at < options.secondary_orientation_ratio * highest) {
      continue;
    }
    const double curvature = before - 2. * at + after;
    const double offset =
        curvature < 0. ? 0.5 * (before - after) / curvature : 0.;
    peaks.emplace_back(-at, (k + offset) * 2. * M_PI / n);
  }
  std::sort(peaks.begin(), peaks.end());
  std::vector<double> orientations;
  for (const auto& peak : peaks) orientations.push_back(peak.second);
  return orientations;
}

Eigen::VectorXf Describe(const DescriptorOptions& options, const Window& window,
                         const double orientation) {
  std::vector<double> histogram(options.num_bins, 0.);
  for (const WeightedGradient& gradient : window.gradients) {
    AddToHistogram(gradient.orientation - orientation, gradient.weight,
                   &histogram);
  }
  Eigen::VectorXd descriptor(options.num_bins + 1);
  descriptor.head(options.num_bins) =
      Eigen::Map<const Eigen::VectorXd>(histogram.data(), options.num_bins)
          .normalized();
  descriptor[options.num_bins] =
      options.distance_weight * kMillimetresPerMetre * window.mean_distance;
  return descriptor.cast<float>();
}

}  // namespace

std::string Validate(const DescriptorOptions& options) {
  if (!(options.radius_meters > 0. && options.radius_meters <= 10.)) {
    return "radius_meters must lie between 0 and 10";
  }
  if (options.num_bins < 2 || options.num_bins > 360) {
    return "num_bins must lie between 2 and 360";
  }
  if (options.num_orientation_bins < 4 || options.num_orientation_bins > 3600) {
    return "num_orientation_bins must lie between 4 and 3600";
  }
  if (!(options.distance_weight >= 0. && options.distance_weight <= 1e3)) {
    return "distance_weight must lie between 0 and 1000";
  }
  if (!(options.gaussian_sigma_ratio > 0. &&
        options.gaussian_sigma_ratio <= 100.)) {
    return "gaussian_sigma_ratio must lie between 0 and 100";
  }
  if (!(options.secondary_orientation_ratio > 0. &&
        options.secondary_orientation_ratio <= 1.)) {
    return "secondary_orientation_ratio must lie between 0 and 1";
  }
  return "";
}

FeatureSet DescribeKeypoints(const DescriptorOptions& options,
                             const DistanceField& field,
                             const ArrayXXf& smoothed,
                             const std::vector<Keypoint>& keypoints) {
  CHECK_EQ(Validate(options), "");
  const Rigid2 T_grid_submap = field.geometry.T_submap_grid.Inverse();
  FeatureSet set;
  std::vector<Eigen::VectorXf> descriptors;
  for (const Keypoint& keypoint : keypoints) {
    const Window window = ExtractWindow(
        options, field, smoothed,
        field.geometry.GridToCells(T_grid_submap * keypoint.position));
    for (const double orientation : DominantOrientations(options, window)) {
      set.features.push_back(
          {keypoint, NormalizeAngle(orientation - T_grid_submap.rotation())});
      descriptors.push_back(Describe(options, window, orientation));
    }
  }
  set.descriptors.resize(options.num_bins + 1,
                         static_cast<Index>(descriptors.size()));
  for (size_t k = 0; k < descriptors.size(); ++k) {
    set.descriptors.col(static_cast<Index>(k)) = descriptors[k];
  }
  return set;
}

}  // namespace cartographer_sdf
