// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Scans of a robot that stands still or drives, as JSON or CSV;
// docs/scan_localization.md describes the format.

#ifndef CARTOGRAPHER_SDF_RECORDING_SCAN_FILE_H_
#define CARTOGRAPHER_SDF_RECORDING_SCAN_FILE_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/grid/scan.h"

namespace cartographer_sdf {

// Any bytes yield at least one scan with at least one beam, or an error of one
// sentence. Files of more than 64 MB or with more than a million beams are
// refused.
[[nodiscard]] absl::StatusOr<std::vector<RobotScan>> ReadScanFile(
    const std::string& path);

struct ScanRecording {
  // Whether the scans have odometry. If not, they are one OdometryScan.
  bool is_drive = false;
  std::vector<OdometryScan> scans;
};

// As ReadScanFile. Where the scans have odometry, either all have it, with a
// time, or it is an error; times are as in the file, in whatever order.
[[nodiscard]] absl::StatusOr<ScanRecording> ReadScanRecording(
    const std::string& path);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_RECORDING_SCAN_FILE_H_
