// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/probability.h"

#include <cmath>

#include "absl/strings/str_format.h"

namespace cartographer_sdf {

double ProbabilityOf(const double score) {
  return 1. / (1. + std::exp(-score));
}

double ProbabilityOf(const double score,
                     const std::optional<double>& rival_score) {
  if (!rival_score) return ProbabilityOf(score);
  return 1. / (1. + std::exp(-score) + std::exp(*rival_score - score));
}

std::string FormatProbability(const double probability) {
  if (probability > 0.999) return "more than 99.9 %";
  if (probability < 0.001) return "less than 0.1 %";
  return absl::StrFormat("%.1f %%", 100. * probability);
}

}  // namespace cartographer_sdf
