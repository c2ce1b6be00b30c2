// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_EVALUATION_ERROR_STATISTICS_H_
#define CARTOGRAPHER_SDF_EVALUATION_ERROR_STATISTICS_H_

#include <optional>
#include <vector>

namespace cartographer_sdf {

// Of absolute errors, in their unit. Quantiles are interpolated linearly
// between the sorted values, the smallest being that of 0 and the largest that
// of 1.
struct ErrorStatistics {
  int count = 0;
  double mean = 0.;
  double median = 0.;
  double percentile_90 = 0.;
  double max = 0.;
};

// None of no errors.
[[nodiscard]] std::optional<ErrorStatistics> Summarize(
    std::vector<double> errors);

// Of poses: [m] and [rad].
struct PoseErrorStatistics {
  ErrorStatistics translation;
  ErrorStatistics rotation;
};

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_EVALUATION_ERROR_STATISTICS_H_
