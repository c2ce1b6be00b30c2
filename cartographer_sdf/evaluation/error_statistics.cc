// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/evaluation/error_statistics.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace cartographer_sdf {
namespace {

double Quantile(const std::vector<double>& sorted, const double fraction) {
  const double position = fraction * static_cast<double>(sorted.size() - 1);
  const size_t below = static_cast<size_t>(position);
  const size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - static_cast<double>(below)) *
                             (sorted[above] - sorted[below]);
}

}  // namespace

std::optional<ErrorStatistics> Summarize(std::vector<double> errors) {
  if (errors.empty()) return std::nullopt;
  std::sort(errors.begin(), errors.end());
  ErrorStatistics statistics;
  statistics.count = static_cast<int>(errors.size());
  statistics.mean = std::accumulate(errors.begin(), errors.end(), 0.) /
                    static_cast<double>(errors.size());
  statistics.median = Quantile(errors, 0.5);
  statistics.percentile_90 = Quantile(errors, 0.9);
  statistics.max = errors.back();
  return statistics;
}

}  // namespace cartographer_sdf
