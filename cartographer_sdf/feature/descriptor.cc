// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/feature/descriptor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

using Eigen::ArrayXXf;
using Eigen::Index;

constexpr double kMillimetresPerMetre = 1000.;

// Gradients within the window of a keypoint, in the grid frame.
struct Window {
  std::vector<float> orientations;  // [0, 2 pi]
  std::vector<float> weights;       // magnitude times Gaussian
  double mean_distance = 0.;        // [m]
};

// atan2 in [0, 2 pi], 0 at the origin, to 3e-7: vector code is made of it.
// [Abramowitz1964], 4.4.49, for the arc tangent.
inline float Angle(const float y, const float x) {
  constexpr float kPi = static_cast<float>(M_PI);
  const float abs_x = std::abs(x), abs_y = std::abs(y);
  const float larger = abs_x < abs_y ? abs_y : abs_x;
  const float smaller = abs_x < abs_y ? abs_x : abs_y;
  const float t = smaller / (larger + std::numeric_limits<float>::min());
  const float s = t * t;
  float sum = 0.0028662257f;
  sum = sum * s - 0.0161657367f;
  sum = sum * s + 0.0429096138f;
  sum = sum * s - 0.0752896400f;
  sum = sum * s + 0.1065626393f;
  sum = sum * s - 0.1420889944f;
  sum = sum * s + 0.1999355085f;
  sum = sum * s - 0.3333314528f;
  float angle = t + t * s * sum;
  angle = abs_x < abs_y ? 0.5f * kPi - angle : angle;
  angle = x < 0.f ? kPi - angle : angle;
  return y < 0.f ? 2.f * kPi - angle : angle;
}

// Bin k of n is centred on k * 2 pi / n.
class CircularHistogram {
 public:
  explicit CircularHistogram(const int num_bins)
      : num_bins_(num_bins),
        bins_per_radian_(static_cast<float>(num_bins / (2. * M_PI))),
        parts_(num_bins + 1) {}

  // Splits each weight linearly between the two bins nearest to its angle,
  // which is relative to `origin`, both in [0, 2 pi].
  void Add(const std::vector<float>& angles, const std::vector<float>& weights,
           const float origin) {
    constexpr float kTurn = static_cast<float>(2. * M_PI);
    constexpr size_t kChunk = 256;
    std::array<int, kChunk> low;
    std::array<float, kChunk> fraction;
    for (size_t begin = 0; begin < angles.size(); begin += kChunk) {
      const size_t size = std::min(kChunk, angles.size() - begin);
      const float* const angle = &angles[begin];
      for (size_t k = 0; k < size; ++k) {
        const float difference = angle[k] - origin;
        const float bin = bins_per_radian_ *
                          (difference < 0.f ? difference + kTurn : difference);
        low[k] = static_cast<int>(bin);
        fraction[k] = bin - static_cast<float>(low[k]);
      }
      for (size_t k = 0; k < size; ++k) {
        const double weight = weights[begin + k];
        const double high_weight = fraction[k] * weight;
        Part& part = parts_[low[k]][k % kNumSums];
        part.low += weight - high_weight;
        part.high += high_weight;
      }
    }
  }

  [[nodiscard]] std::vector<double> Bins() const {
    std::vector<double> bins(num_bins_, 0.);
    for (int k = 0; k <= num_bins_; ++k) {
      for (const Part& part : parts_[k]) {
        bins[k % num_bins_] += part.low;
        bins[(k + 1) % num_bins_] += part.high;
      }
    }
    return bins;
  }

 private:
  // What goes to a bin and to the next one.
  struct Part {
    double low = 0., high = 0.;
  };
  // Neighbouring cells have similar angles: with several sums a bin, none waits
  // for another's.
  static constexpr size_t kNumSums = 4;

  const int num_bins_;
  const float bins_per_radian_;
  // Rounding may yield a bin after the last, which is the first.
  std::vector<std::array<Part, kNumSums>> parts_;
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

  // The part of the axis whose squared distances are at most `limit`.
  [[nodiscard]] std::pair<size_t, size_t> Within(const double limit) const {
    size_t begin = 0, end = squared_distances.size();
    while (begin < end && squared_distances[begin] > limit) ++begin;
    while (begin < end && squared_distances[end - 1] > limit) --end;
    return {begin, end};
  }
};

// Appends gradients by central differences, at `size` cells of a column from
// the given one on, times the weights of their rows and of the column.
void AppendGradients(const ArrayXXf& values, const Index i, const Index j,
                     const size_t size, const double* const row_weights,
                     const double column_weight, Window* const window) {
  const size_t old_size = window->weights.size();
  window->orientations.resize(old_size + size);
  window->weights.resize(old_size + size);
  float* __restrict const orientations = &window->orientations[old_size];
  float* __restrict const weights = &window->weights[old_size];
  const float* const left = &values(i, j - 1);
  const float* const below = &values(i - 1, j);
  const float* const above = &values(i + 1, j);
  const float* const right = &values(i, j + 1);
  for (size_t k = 0; k < size; ++k) {
    const float x = 0.5f * (above[k] - below[k]);
    const float y = 0.5f * (right[k] - left[k]);
    orientations[k] = Angle(y, x);
    weights[k] = static_cast<float>(row_weights[k] * column_weight) *
                 std::sqrt(x * x + y * y);
  }
}

// Gradients and the mean distance within the radius of a point given in
// (continuous) cells; cells beyond the rim are skipped.
void ExtractWindow(const DescriptorOptions& options, const DistanceField& field,
                   const ArrayXXf& smoothed, const Eigen::Vector2d& centre,
                   Window* const window) {
  const double radius = options.radius_meters / field.geometry.resolution;
  const double sigma = options.gaussian_sigma_ratio * radius;
  const WindowAxis x(centre.x(), radius, sigma, field.distance.rows());
  const WindowAxis y(centre.y(), radius, sigma, field.distance.cols());
  window->orientations.clear();
  window->weights.clear();
  double sum = 0., sum_distance = 0.;
  for (size_t b = 0; b < y.weights.size(); ++b) {
    const auto [begin, end] =
        x.Within(radius * radius - y.squared_distances[b]);
    if (begin == end) continue;
    const Index i = x.first + static_cast<Index>(begin);
    const Index j = y.first + static_cast<Index>(b);
    AppendGradients(smoothed, i, j, end - begin, &x.weights[begin],
                    y.weights[b], window);
    const float* const distance = &field.distance(i, j);
    for (size_t a = begin; a < end; ++a) {
      const double gaussian = x.weights[a] * y.weights[b];
      sum += gaussian;
      sum_distance += gaussian * distance[a - begin];
    }
  }
  window->mean_distance = sum > 0. ? sum_distance / sum : 0.;
}

// Peaks of the circular histogram, at sub-bin positions [rad], highest first.
std::vector<double> DominantOrientations(const DescriptorOptions& options,
                                         const Window& window) {
  const int n = options.num_orientation_bins;
  CircularHistogram sharp(n);
  sharp.Add(window.orientations, window.weights, 0.f);
  const std::vector<double> raw = sharp.Bins();
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
  histogram.Add(window.orientations, window.weights,
                static_cast<float>(orientation));
  const std::vector<double> bins = histogram.Bins();
  Eigen::VectorXd descriptor(options.num_bins + 1);
  descriptor.head(options.num_bins) =
      Eigen::Map<const Eigen::VectorXd>(bins.data(), options.num_bins)
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

int SmoothedReach(const DescriptorOptions& options, const double resolution) {
  // Up to half a cell of the keypoint's own, and the neighbour that a gradient
  // reads.
  return static_cast<int>(std::ceil(options.radius_meters / resolution + 0.5)) +
         1;
}

FeatureSet DescribeKeypoints(const DescriptorOptions& options,
                             const DistanceField& field,
                             const ArrayXXf& smoothed,
                             const std::vector<Keypoint>& keypoints) {
  CHECK_EQ(Validate(options), "");
  const Rigid2 T_grid_submap = field.geometry.T_submap_grid.Inverse();
  FeatureSet set;
  std::vector<Eigen::VectorXf> descriptors;
  Window window;
  for (const Keypoint& keypoint : keypoints) {
    ExtractWindow(options, field, smoothed,
                  field.geometry.GridToCells(T_grid_submap * keypoint.position),
                  &window);
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
