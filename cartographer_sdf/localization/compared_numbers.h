// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_LOCALIZATION_COMPARED_NUMBERS_H_
#define CARTOGRAPHER_SDF_LOCALIZATION_COMPARED_NUMBERS_H_

#include <string>

namespace cartographer_sdf {

// A number and the threshold that it misses or passes, as a message shows them:
// with as many decimals as it takes to tell them apart, "6.496" and "6.500".
struct ComparedNumbers {
  std::string number;
  std::string threshold;
};

[[nodiscard]] ComparedNumbers FormatCompared(double number, double threshold,
                                             int min_decimals);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOCALIZATION_COMPARED_NUMBERS_H_
