// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_TOOLS_MEASUREMENT_H_
#define CARTOGRAPHER_SDF_TOOLS_MEASUREMENT_H_

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"

namespace cartographer_sdf {

// A line of a result: its subject, and named numbers, which may be absent.
// Neither subject nor names have commas.
struct Measurement {
  std::string subject;
  std::vector<std::pair<std::string, std::optional<double>>> numbers;
};

// Consecutive measurements of the same numbers share a table.
[[nodiscard]] std::string FormatMeasurements(
    const std::vector<Measurement>& measurements);

// CSV with the columns subject, quantity, value. Values have nine digits.
[[nodiscard]] absl::Status WriteMeasurements(
    const std::string& path, const std::vector<Measurement>& measurements);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_MEASUREMENT_H_
