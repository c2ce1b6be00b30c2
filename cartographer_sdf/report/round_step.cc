// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/round_step.h"

#include <cmath>

#include "glog/logging.h"

namespace cartographer_sdf {

double RoundStep(const double step) {
  CHECK(std::isfinite(step) && step > 0.) << step;
  const double magnitude = std::pow(10., std::floor(std::log10(step)));
  for (const double factor : {1., 2., 5.}) {
    // Forgives the rounding of the logarithm.
    if (factor * magnitude >= step * (1. - 1e-9)) return factor * magnitude;
  }
  return 10. * magnitude;
}

}  // namespace cartographer_sdf
