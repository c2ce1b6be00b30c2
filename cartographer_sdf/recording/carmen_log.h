// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Reads log files of the CARMEN toolkit, plain or gzip-compressed; most public
// recordings of 2D lasers use this format. Any input yields a recording or a
// one-sentence error that names the file and the line.

#ifndef CARTOGRAPHER_SDF_RECORDING_CARMEN_LOG_H_
#define CARTOGRAPHER_SDF_RECORDING_CARMEN_LOG_H_

#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "cartographer_sdf/recording/recording.h"

namespace cartographer_sdf {

struct CarmenLogOptions {
  // Field of view of the laser [rad]; the first beam points half of it to the
  // right of straight ahead. An odd number of beams spans it from end to end;
  // with an even number the last beam of the span is missing. The format does
  // not record it. If absent, a common value is assumed: a half turn for 180,
  // 181 and 360 beams, three quarters of a turn otherwise; for a half turn of
  // 361 beams it must be set.
  std::optional<double> field_of_view;
  // For recordings without a clock: the time of scan i is 1e9 + i *
  // seconds_per_scan [s].
  double seconds_per_scan = 0.1;
};

[[nodiscard]] std::string Validate(const CarmenLogOptions& options);

// Reads lines "FLASER n r_1 ... r_n x y theta odometry_x odometry_y
// odometry_theta time host time" and skips others. Times that are merely scan
// numbers (whole, increasing, too small for a date), or are all equal, are not
// a clock.
[[nodiscard]] absl::StatusOr<Recording> ReadCarmenLog(
    const std::string& path, const CarmenLogOptions& options);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECORDING_CARMEN_LOG_H_
