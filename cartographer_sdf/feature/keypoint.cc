// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/feature/keypoint.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cartographer_sdf/field/cell_runs.h"
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

// Adds weights[t] * (one[t][i] + other[t][i]) to result[i], term by term.
template <int kNumTerms>
void AddTerms(const float* const weights, const float* const* const one,
              const float* const* const other, const CellRun& run,
              float* __restrict const result) {
  for (Index i = run.begin; i < run.end; ++i) {
    float sum = result[i];
    for (int t = 0; t < kNumTerms; ++t) {
      sum += weights[t] * (one[t][i] + other[t][i]);
    }
    result[i] = sum;
  }
}

// A kernel's values on one side, in the order in which they are added up, with
// the arrays that they weigh: one before and one behind the middle.
struct SymmetricTerms {
  std::vector<float> weights;
  std::vector<const float*> before, behind;
};

// Several terms at a time: the sum stays in registers meanwhile.
void AddTerms(const SymmetricTerms& terms, const CellRun& run,
              float* const result) {
  const size_t n = terms.weights.size();
  size_t k = 0;
  for (; k + 3 <= n; k += 3) {
    AddTerms<3>(&terms.weights[k], &terms.before[k], &terms.behind[k], run,
                result);
  }
  for (; k < n; ++k) {
    AddTerms<1>(&terms.weights[k], &terms.before[k], &terms.behind[k], run,
                result);
  }
}

// The last few columns of an array, which is computed column by column.
class ColumnRing {
 public:
  ColumnRing(const Index rows, const Index num_kept)
      : columns_(rows, num_kept) {}

  [[nodiscard]] float* Column(const Index j) {
    return &columns_(0, j % columns_.cols());
  }
  [[nodiscard]] const float* Column(const Index j) const {
    return &columns_(0, j % columns_.cols());
  }

 private:
  ArrayXXf columns_;
};

// Convolves a field with a kernel column by column. Of what it has convolved
// along the rows' index (the fast one) it keeps as many columns as the kernel
// is wide: little enough to stay in cache.
class SeparableConvolution {
 public:
  // Of the result, `runs` are needed; they need `runs_along` of what is
  // convolved along the rows' index. No argument is copied.
  SeparableConvolution(const ArrayXXf& values, const float scale,
                       const std::vector<float>& kernel,
                       const CellRuns& runs_along, const CellRuns& runs)
      : values_(values),
        scale_(scale),
        kernel_(kernel),
        runs_along_(runs_along),
        runs_(runs),
        radius_(static_cast<Index>(kernel.size()) / 2),
        padded_(values.rows() + 2 * radius_),
        along_(values.rows(), 2 * radius_ + 1) {
    for (Index k = 0; k < radius_; ++k) {
      inwards_.weights.push_back(kernel[k]);
      inwards_.before.push_back(padded_.data() + k);
      inwards_.behind.push_back(padded_.data() + 2 * radius_ - k);
      outwards_.weights.push_back(kernel[radius_ + 1 + k]);
    }
    outwards_.before.resize(radius_);
    outwards_.behind.resize(radius_);
  }

  // Call for each column j from 0 on.
  void Convolve(const Index j, float* const result) {
    const Index last = values_.cols() - 1;
    const Index needed = std::min(j + radius_, last);
    while (num_along_ <= needed) ConvolveAlong(num_along_++);
    for (Index k = 0; k < radius_; ++k) {
      outwards_.before[k] = along_.Column(std::max<Index>(j - k - 1, 0));
      outwards_.behind[k] = along_.Column(std::min(j + k + 1, last));
    }
    const float* const middle = along_.Column(j);
    for (const CellRun& run : runs_.OfColumn(j)) {
      for (Index i = run.begin; i < run.end; ++i) {
        result[i] = kernel_[radius_] * middle[i];
      }
      AddTerms(outwards_, run, result);
    }
  }

 private:
  void ConvolveAlong(const Index j) {
    float* const along = along_.Column(j);
    for (const CellRun& run : runs_along_.OfColumn(j)) {
      Pad(j, run);
      for (Index i = run.begin; i < run.end; ++i) {
        along[i] = kernel_[radius_] * padded_[i + radius_];
      }
      AddTerms(inwards_, run, along);
    }
  }

  // Scales what the convolution of a run reads. Beyond the rim its value is
  // repeated.
  void Pad(const Index j, const CellRun& run) {
    const Index rows = values_.rows();
    const Index begin = std::max<Index>(run.begin - radius_, 0);
    const Index end = std::min(run.end + radius_, rows);
    padded_.segment(begin + radius_, end - begin) =
        scale_ * values_.col(j).segment(begin, end - begin);
    if (begin == 0) padded_.head(radius_) = padded_[radius_];
    if (end == rows) padded_.tail(radius_) = padded_[rows + radius_ - 1];
  }

  const ArrayXXf& values_;
  const float scale_;
  const std::vector<float>& kernel_;
  const CellRuns& runs_along_;
  const CellRuns& runs_;
  const Index radius_;
  // A scaled column, continued beyond the rim.
  Eigen::ArrayXf padded_;
  ColumnRing along_;
  Index num_along_ = 0;
  SymmetricTerms inwards_;   // within padded_, from the rim of the kernel
  SymmetricTerms outwards_;  // columns of along_, from the kernel's middle
};

ArrayXXf Convolved(const DistanceField& field, const std::vector<float>& kernel,
                   const CellRuns& runs_along, const CellRuns& runs) {
  const float scale = static_cast<float>(1. / field.geometry.resolution);
  SeparableConvolution convolution(field.distance, scale, kernel, runs_along,
                                   runs);
  ArrayXXf smoothed(field.distance.rows(), field.distance.cols());
  for (Index j = 0; j < smoothed.cols(); ++j) {
    convolution.Convolve(j, &smoothed(0, j));
  }
  return smoothed;
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

// Computes |det(H)| of whole runs of cells, with SobelHessian's operations.
class HessianMagnitude {
 public:
  // The argument is not copied.
  explicit HessianMagnitude(const ArrayXXf& f)
      : f_(f), smooth_(f.rows()), second_(f.rows()), first_(f.rows()) {}

  // Writes a run of column j; 0 on the rim.
  void Evaluate(const Index j, const CellRun& run, float* const magnitude) {
    if (j == 0 || j + 1 == f_.cols()) {
      std::fill(magnitude + run.begin, magnitude + run.end, 0.f);
      return;
    }
    const Index begin = std::max<Index>(run.begin, 1);
    const Index end = std::min(run.end, f_.rows() - 1);
    CombineColumns(j, begin - 1, end + 1);
    const float* const smooth = smooth_.data();
    const float* const second = second_.data();
    const float* const first = first_.data();
    for (Index i = begin; i < end; ++i) {
      const float xx =
          0.25f * (smooth[i - 1] - 2.f * smooth[i] + smooth[i + 1]);
      const float yy =
          0.25f * (second[i - 1] + 2.f * second[i] + second[i + 1]);
      const float xy = 0.25f * (first[i + 1] - first[i - 1]);
      magnitude[i] = std::abs(xx * yy - xy * xy);
    }
    if (run.begin == 0) magnitude[0] = 0.f;
    if (run.end == f_.rows()) magnitude[f_.rows() - 1] = 0.f;
  }

 private:
  void CombineColumns(const Index j, const Index begin, const Index end) {
    const float* const left = &f_(0, j - 1);
    const float* const centre = &f_(0, j);
    const float* const right = &f_(0, j + 1);
    float* const smooth = smooth_.data();
    float* const second = second_.data();
    float* const first = first_.data();
    for (Index i = begin; i < end; ++i) {
      smooth[i] = left[i] + 2.f * centre[i] + right[i];
      second[i] = left[i] - 2.f * centre[i] + right[i];
      first[i] = right[i] - left[i];
    }
  }

  const ArrayXXf& f_;
  // Sums and differences across three columns.
  std::vector<float> smooth_, second_, first_;
};

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

bool IsLocalMaximum(const ColumnRing& magnitude, const Index i, const Index j,
                    const Index reach) {
  const float value = magnitude.Column(j)[i];
  for (Index b = j - reach; b <= j + reach; ++b) {
    const float* const column = magnitude.Column(b);
    for (Index a = i - reach; a <= i + reach; ++a) {
      const float other = column[a];
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

// The keypoint in the cell (i, j), where the magnitude is extremal; none if it
// is too far from every wall.
std::optional<Keypoint> MakeKeypoint(const KeypointOptions& options,
                                     const DistanceField& field,
                                     const ArrayXXf& smoothed,
                                     const ColumnRing& magnitude, const Index i,
                                     const Index j) {
  const float* const column = magnitude.Column(j);
  const Eigen::Vector2d cells(
      static_cast<double>(i) +
          PeakOffset(column[i - 1], column[i], column[i + 1]),
      static_cast<double>(j) + PeakOffset(magnitude.Column(j - 1)[i], column[i],
                                          magnitude.Column(j + 1)[i]));
  const Eigen::Vector2d p_grid = field.geometry.CellsToGrid(cells);
  const double clearance = SampleField(field, p_grid)->distance;
  if (std::abs(clearance) > options.max_clearance_meters) return std::nullopt;
  const Hessian hessian = SobelHessian(smoothed, i, j);
  const KeypointKind kind =
      hessian.xx * hessian.yy < hessian.xy * hessian.xy ? KeypointKind::kSaddle
      : hessian.xx + hessian.yy < 0.f                   ? KeypointKind::kMaximum
                                      : KeypointKind::kMinimum;
  return Keypoint{field.geometry.T_submap_grid * p_grid, clearance, kind,
                  column[i]};
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

std::string Validate(const KeypointKinds& kinds) {
  if (!kinds.maxima && !kinds.minima && !kinds.saddles) {
    return "maxima, minima or saddles must be true";
  }
  return "";
}

bool Contains(const KeypointKinds& kinds, const KeypointKind kind) {
  switch (kind) {
    case KeypointKind::kMaximum:
      return kinds.maxima;
    case KeypointKind::kMinimum:
      return kinds.minima;
    case KeypointKind::kSaddle:
      return kinds.saddles;
  }
  LOG(FATAL) << "no such kind";
}

ArrayXXf SmoothField(const DistanceField& field, const double sigma_cells) {
  const CellRuns runs =
      CellRuns::All(field.distance.rows(), field.distance.cols());
  return Convolved(field, GaussianKernel(sigma_cells), runs, runs);
}

ArrayXXf SmoothFieldNearObserved(const DistanceField& field,
                                 const double sigma_cells, const int reach) {
  CHECK_GE(reach, 0);
  const std::vector<float> kernel = GaussianKernel(sigma_cells);
  const Index radius = static_cast<Index>(kernel.size()) / 2;
  return Convolved(field, kernel,
                   CellRuns::Near(field.observed, reach, reach + radius),
                   CellRuns::Near(field.observed, reach, reach));
}

std::vector<Keypoint> DetectKeypoints(const KeypointOptions& options,
                                      const DistanceField& field,
                                      const ArrayXXf& smoothed) {
  CHECK_EQ(Validate(options), "");
  CHECK_EQ(smoothed.rows(), field.distance.rows());
  CHECK_EQ(smoothed.cols(), field.distance.cols());
  const Index margin = options.non_maximum_suppression_cells;
  const CellRuns runs = CellRuns::Near(field.observed, margin, margin);
  ColumnRing magnitude(smoothed.rows(), 2 * margin + 1);
  HessianMagnitude hessian(smoothed);
  const float threshold = static_cast<float>(options.detection_threshold);
  std::vector<Keypoint> keypoints;
  for (Index last = 0; last < smoothed.cols(); ++last) {
    for (const CellRun& run : runs.OfColumn(last)) {
      hessian.Evaluate(last, run, magnitude.Column(last));
    }
    const Index j = last - margin;
    if (j < margin) continue;
    const float* const column = magnitude.Column(j);
    for (const CellRun& run : runs.OfColumn(j)) {
      const Index end = std::min(run.end, smoothed.rows() - margin);
      for (Index i = std::max(run.begin, margin); i < end; ++i) {
        if (column[i] <= threshold || !field.observed(i, j) ||
            !IsLocalMaximum(magnitude, i, j, margin) ||
            NearUnobserved(field, i, j, options.unobserved_border_cells)) {
          continue;
        }
        const std::optional<Keypoint> keypoint =
            MakeKeypoint(options, field, smoothed, magnitude, i, j);
        if (keypoint) keypoints.push_back(*keypoint);
      }
    }
  }
  return keypoints;
}

}  // namespace cartographer_sdf
