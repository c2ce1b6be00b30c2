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

struct PolarGradient {
  float orientation;  // grid frame, [0, 2 pi]
  float magnitude;
};

struct Window {
  std::vector<PolarGradient> gradients;  // weighted
  double mean_distance = 0.;             // [m]
};

// Gradients by central differences. As windows overlap, each gradient is
// computed once, on first use.
class GradientCache {
 public:
  explicit GradientCache(const ArrayXXf& values)
      : values_(values),
        gradients_(values.size(), PolarGradient{0.f, kMissing}) {}

  // The cell must not lie on the rim.
  const PolarGradient& At(const Index i, const Index j) {
    PolarGradient& gradient = gradients_[j * values_.rows() + i];
    if (gradient.magnitude == kMissing) {
      const float x = 0.5f * (values_(i + 1, j) - values_(i - 1, j));
      const float y = 0.5f * (values_(i, j + 1) - values_(i, j - 1));
      const float angle = std::atan2(y, x);
      gradient.orientation =
          angle < 0.f ? angle + static_cast<float>(2. * M_PI) : angle;
      gradient.magnitude = std::sqrt(x * x + y * y);
    }
    return gradient;
  }

 private:
  static constexpr float kMissing = -1.f;

  const ArrayXXf& values_;
  std::vector<PolarGradient> gradients_;
};

// Bin k of n is centred on k * 2 pi / n.
class CircularHistogram {
 public:
  explicit CircularHistogram(const int num_bins)
      : num_bins_(num_bins),
        bins_per_radian_(num_bins / (2. * M_PI)),
        bins_(num_bins, 0.) {}

  // Splits the weight linearly between the two bins nearest to the angle, which
  // lies in (-2 pi, 4 pi).
  void Add(const double angle, const double weight) {
    const double bin = angle * bins_per_radian_ + num_bins_;  // positive
    int low = static_cast<int>(bin);
    const double fraction = bin - low;
    while (low >= num_bins_) low -= num_bins_;
    bins_[low] += (1. - fraction) * weight;
    bins_[low + 1 < num_bins_ ? low + 1 : 0] += fraction * weight;
  }
  const std::vector<double>& bins() const { return bins_; }

 private:
  const int num_bins_;
  const double bins_per_radian_;
  std::vector<double> bins_;
};

// The inner cells of one axis that lie within the radius of a centre, with
// their squared distances and Gaussian weights.
struct WindowAxis {
  Index first;
  std::vector<double> squared_distances;
  std::vector<double> weights;

  WindowAxis(const double centre, const double radius, const double sigma,
             const Index size)
      : first(std::max<Index>(1,
                              static_cast<Index>(std::ceil(centre - radius)))) {
    const Index last = std::min<Index>(
        size - 2, static_cast<Index>(std::floor(centre + radius)));
    for (Index k = first; k <= last; ++k) {
      const double d = static_cast<double>(k) - centre;
      squared_distances.push_back(d * d);
      weights.push_back(std::exp(-0.5 * d * d / (sigma * sigma)));
    }
  }
};

// Gradients and the mean distance within the radius of a point given in
// (continuous) cells; cells beyond the rim are skipped.
Window ExtractWindow(const DescriptorOptions& options,
                     const DistanceField& field, const Eigen::Vector2d& centre,
                     GradientCache* const gradients) {
  const double radius = options.radius_meters / field.geometry.resolution;
  const double sigma = options.gaussian_sigma_ratio * radius;
  const WindowAxis x(centre.x(), radius, sigma, field.distance.rows());
  const WindowAxis y(centre.y(), radius, sigma, field.distance.cols());
  Window window;
  window.gradients.reserve(x.weights.size() * y.weights.size());
  double sum = 0., sum_distance = 0.;
  for (size_t b = 0; b < y.weights.size(); ++b) {
    for (size_t a = 0; a < x.weights.size(); ++a) {
      if (x.squared_distances[a] + y.squared_distances[b] > radius * radius) {
        continue;
      }
      const Index i = x.first + static_cast<Index>(a);
      const Index j = y.first + static_cast<Index>(b);
      const double gaussian = x.weights[a] * y.weights[b];
      const PolarGradient& gradient = gradients->At(i, j);
      window.gradients.push_back(
          {gradient.orientation,
           static_cast<float>(gaussian) * gradient.magnitude});
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
  CircularHistogram sharp(n);
  for (const PolarGradient& gradient : window.gradients) {
    sharp.Add(gradient.orientation, gradient.magnitude);
  }
  const std::vector<double>& raw = sharp.bins();
  std::vector<double> histogram(n);
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
  CircularHistogram histogram(options.num_bins);
  for (const PolarGradient& gradient : window.gradients) {
    histogram.Add(gradient.orientation - orientation, gradient.magnitude);
  }
  Eigen::VectorXd descriptor(options.num_bins + 1);
  descriptor.head(options.num_bins) =
      Eigen::Map<const Eigen::VectorXd>(histogram.bins().data(),
                                        options.num_bins)
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
  GradientCache gradients(smoothed);
  FeatureSet set;
  std::vector<Eigen::VectorXf> descriptors;
  for (const Keypoint& keypoint : keypoints) {
    const Window window = ExtractWindow(
        options, field,
        field.geometry.GridToCells(T_grid_submap * keypoint.position),
        &gradients);
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
