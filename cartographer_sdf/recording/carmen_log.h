// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Log files of the CARMEN toolkit, plain or compressed by gzip, in which most
// public recordings of 2D lasers are kept. Any bytes give a recording or one
// sentence that names the file and the line.

#ifndef CARTOGRAPHER_SDF_RECORDING_CARMEN_LOG_H_
#define CARTOGRAPHER_SDF_RECORDING_CARMEN_LOG_H_

#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "cartographer_sdf/recording/recording.h"

namespace cartographer_sdf {

struct CarmenLogOptions {
  // Of the laser [rad]; the first beam is half of it to the right of ahead. An
  // odd number of beams reaches from one end to the other, of an even number
  // the last one is left out. The format does not tell: none is what is common,
  // a half turn of 180, 181 and 360 beams, three quarters of others; a half
  // turn of 361 beams must be told.
  std::optional<double> field_of_view;
  // Of recordings whose scans are only counted: scan i was made at 1e9 + i *
  // seconds_per_scan [s].
  double seconds_per_scan = 0.1;
};

[[nodiscard]] std::string Validate(const CarmenLogOptions& options);

// Lines "FLASER n r_1 ... r_n x y theta odometry_x odometry_y odometry_theta
// time host time"; others are passed over. Times that are nothing but numbers
// of scans (whole, rising, no date), or all the same, are no clock.
[[nodiscard]] absl::StatusOr<Recording> ReadCarmenLog(
    const std::string& path, const CarmenLogOptions& options);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECORDING_CARMEN_LOG_H_
