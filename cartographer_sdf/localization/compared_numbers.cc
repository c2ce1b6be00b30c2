// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/localization/compared_numbers.h"

#include "absl/strings/str_format.h"

namespace cartographer_sdf {

ComparedNumbers FormatCompared(const double number, const double threshold,
                               const int min_decimals) {
  constexpr int kMaxDecimals = 17;
  ComparedNumbers compared;
  int decimals = min_decimals;
  do {
    compared = {absl::StrFormat("%.*f", decimals, number),
                absl::StrFormat("%.*f", decimals, threshold)};
  } while (number != threshold && compared.number == compared.threshold &&
           ++decimals <= kMaxDecimals);
  return compared;
}

}  // namespace cartographer_sdf
