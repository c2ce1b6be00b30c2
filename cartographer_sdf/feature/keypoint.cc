// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/feature/keypoint.h"

#include <algorithm>
#include <cmath>

#include "glog/logging.h"

namespace cartographer_sdf {
namespace {

using Eigen::ArrayXXf;
using Eigen::Index;

std::vector<float> GaussianKernel(const double sigma) {
  // Three standard deviations hold 99.7 % of the mass.
  const int radius = static_cast<int>(std::ceil(3. * sigma));
  std::vector<double> kernel(2 * radius + 1);
  double sum = 0.;
  for (int k = -radius; k <= radius; ++k) {
    sum += kernel[k + radius] = std::exp(-0.5 * k * k / (sigma * sigma));
  }
  std::vector<float> normalized;
  for (const double value : kernel) {
    normalized.push_back(static_cast<float>(value / sum));
  }
  return normalized;
}

// Scales, and convolves along the row index (the fast one).
ArrayXXf ConvolveColumns(const float scale, const ArrayXXf& values,
                         const std::vector<float>& kernel) {
  const Index radius = static_cast<Index>(kernel.size()) / 2;
  const Index rows = values.rows();
  ArrayXXf result(rows, values.cols());
  Eigen::ArrayXf padded(rows + 2 * radius);
  for (Index j = 0; j < values.cols(); ++j) {
    padded.head(radius) = scale * values(0, j);
    padded.segment(radius, rows) = scale * values.col(j);
    padded.tail(radius) = scale * values(rows - 1, j);
    result.col(j) = kernel[radius] * padded.segment(radius, rows);
    for (Index k = 0; k < radius; ++k) {
      result.col(j) += kernel[k] * (padded.segment(k, rows) +
                                    padded.segment(2 * radius - k, rows));
    }
  }
  return result;
}

ArrayXXf ConvolveRows(const ArrayXXf& values,
                      const std::vector<float>& kernel) {
  const Index radius = static_cast<Index>(kernel.size()) / 2;
  const Index cols = values.cols();
  ArrayXXf result(values.rows(), cols);
  for (Index j = 0; j < cols; ++j) {
    result.col(j) = kernel[radius] * values.col(j);
    for (Index k = 1; k <= radius; ++k) {
      result.col(j) +=
          kernel[radius + k] * (values.col(std::max<Index>(j - k, 0)) +
                                values.col(std::min<Index>(j + k, cols - 1)));
    }
  }
  return result;
}

struct Hessian {
  float xx, yy, xy;
};

// Sobel's second derivatives, normalised to units of 1 / cells.
Hessian SobelHessian(const ArrayXXf& f, const Index i, const Index j) {
  const float left = f(i - 1, j - 1) + 2.f * f(i - 1, j) + f(i - 1, j + 1);
  const float middle = f(i, j - 1) + 2.f * f(i, j) + f(i, j + 1);
  const float right = f(i + 1, j - 1) + 2.f * f(i + 1, j) + f(i + 1, j + 1);
  const float below = f(i - 1, j - 1) + 2.f * f(i, j - 1) + f(i + 1, j - 1);
  const float centre = f(i - 1, j) + 2.f * f(i, j) + f(i + 1, j);
  const float above = f(i - 1, j + 1) + 2.f * f(i, j + 1) + f(i + 1, j + 1);
  return {0.25f * (left - 2.f * middle + right),
          0.25f * (below - 2.f * centre + above),
          0.25f * (f(i + 1, j + 1) - f(i + 1, j - 1) - f(i - 1, j + 1) +
                   f(i - 1, j - 1))};
}

// |det(H)| at every inner cell; 0 on the rim.
ArrayXXf HessianMagnitude(const ArrayXXf& f) {
  const Index rows = f.rows(), cols = f.cols();
  ArrayXXf magnitude = ArrayXXf::Zero(rows, cols);
  if (rows < 3 || cols < 3) return magnitude;
  const Index n = rows - 2;
  Eigen::ArrayXf xx(n), yy(n), xy(n);
  // SobelHessian for whole columns: sums across columns first.
  for (Index j = 1; j + 1 < cols; ++j) {
    const auto left = f.col(j - 1), centre = f.col(j), right = f.col(j + 1);
    const Eigen::ArrayXf smooth = left + 2.f * centre + right;
    const Eigen::ArrayXf second = left - 2.f * centre + right;
    const Eigen::ArrayXf first = right - left;
    xx = 0.25f * (smooth.head(n) - 2.f * smooth.segment(1, n) + smooth.tail(n));
    yy = 0.25f * (second.head(n) + 2.f * second.segment(1, n) + second.tail(n));
    xy = 0.25f * (first.tail(n) - first.head(n));
    magnitude.col(j).segment(1, n) = (xx * yy - xy * xy).abs();
  }
  return magnitude;
}

// Whether a free cell meets an unobserved one within the radius.
bool NearUnobserved(const DistanceField& field, const Index i, const Index j,
                    const double radius) {
  const int reach = static_cast<int>(std::ceil(radius));
  const auto free = [&field](const Index a, const Index b) {
    return field.observed(a, b) && field.distance(a, b) > 0.f;
  };
  for (Index b = j - reach; b <= j + reach; ++b) {
    for (Index a = i - reach; a <= i + reach; ++a) {
      if (a < 1 || b < 1 || a + 1 >= field.observed.rows() ||
          b + 1 >= field.observed.cols()) {
        continue;
      }
      if (std::hypot(a - i, b - j) > radius || field.observed(a, b)) continue;
      if (free(a - 1, b) || free(a + 1, b) || free(a, b - 1) ||
          free(a, b + 1)) {
        return true;
      }
    }
  }
  return false;
}

bool IsLocalMaximum(const ArrayXXf& magnitude, const Index i, const Index j,
                    const int reach) {
  const float value = magnitude(i, j);
  for (Index b = j - reach; b <= j + reach; ++b) {
    for (Index a = i - reach; a <= i + reach; ++a) {
      const float other = magnitude(a, b);
      // Of equal values, the first in memory wins.
      if (other > value || (other == value && (b < j || (b == j && a < i)))) {
        return false;
      }
    }
  }
  return true;
}

// Offset of the peak of the parabola through three equidistant values, within
// half a step.
double PeakOffset(const double before, const double at, const double after) {
  const double curvature = before - 2. * at + after;
  if (curvature >= 0.) return 0.;
  return std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5);
}

}  // namespace

std::string Validate(const KeypointOptions& options) {
  if (!(options.smoothing_sigma_cells > 0. &&
        options.smoothing_sigma_cells <= 50.)) {
    return "smoothing_sigma_cells must lie between 0 and 50";
  }
  if (!(options.detection_threshold > 0.)) {
    return "detection_threshold must be positive";
  }
  if (options.non_maximum_suppression_cells < 1 ||
      options.non_maximum_suppression_cells > 100) {
    return "non_maximum_suppression_cells must lie between 1 and 100";
  }
  if (!(options.unobserved_border_cells >= 0. &&
        options.unobserved_border_cells <= 100.)) {
    return "unobserved_border_cells must lie between 0 and 100";
  }
  if (!(options.max_clearance_meters > 0.)) {
    return "max_clearance_meters must be positive";
  }
  return "";
}

ArrayXXf SmoothField(const DistanceField& field, const double sigma_cells) {
  const std::vector<float> kernel = GaussianKernel(sigma_cells);
  const float scale = static_cast<float>(1. / field.geometry.resolution);
  return ConvolveRows(ConvolveColumns(scale, field.distance, kernel), kernel);
}

std::vector<Keypoint> DetectKeypoints(const KeypointOptions& options,
                                      const DistanceField& field,
                                      const ArrayXXf& smoothed) {
  CHECK_EQ(Validate(options), "");
  CHECK_EQ(smoothed.rows(), field.distance.rows());
  CHECK_EQ(smoothed.cols(), field.distance.cols());
  const ArrayXXf magnitude = HessianMagnitude(smoothed);
  const float threshold = static_cast<float>(options.detection_threshold);
  const Index margin = options.non_maximum_suppression_cells;
  std::vector<Keypoint> keypoints;
  for (Index j = margin; j + margin < magnitude.cols(); ++j) {
    for (Index i = margin; i + margin < magnitude.rows(); ++i) {
      if (magnitude(i, j) <= threshold || !field.observed(i, j) ||
          !IsLocalMaximum(magnitude, i, j, static_cast<int>(margin)) ||
          NearUnobserved(field, i, j, options.unobserved_border_cells)) {
        continue;
      }
      const Eigen::Vector2d cells(
          static_cast<double>(i) + PeakOffset(magnitude(i - 1, j),
                                              magnitude(i, j),
                                              magnitude(i + 1, j)),
          static_cast<double>(j) + PeakOffset(magnitude(i, j - 1),
                                              magnitude(i, j),
                                              magnitude(i, j + 1)));
      const Eigen::Vector2d p_grid = field.geometry.CellsToGrid(cells);
      const double clearance = SampleField(field, p_grid)->distance;
      if (std::abs(clearance) > options.max_clearance_meters) continue;
      const Hessian hessian = SobelHessian(smoothed, i, j);
      const KeypointKind kind =
          hessian.xx * hessian.yy < hessian.xy * hessian.xy
              ? KeypointKind::kSaddle
          : hessian.xx + hessian.yy < 0.f ? KeypointKind::kMaximum
                                          : KeypointKind::kMinimum;
      keypoints.push_back({field.geometry.T_submap_grid * p_grid, clearance,
                           kind, magnitude(i, j)});
    }
  }
  return keypoints;
}

}  // namespace cartographer_sdf
