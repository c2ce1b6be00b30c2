// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The scans of a robot, from whatever file has them.

#ifndef CARTOGRAPHER_SDF_APPS_ROBOT_SCANS_H_
#define CARTOGRAPHER_SDF_APPS_ROBOT_SCANS_H_

#include "absl/status/statusor.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/recording/scan_file.h"

namespace cartographer_sdf {

// Reads JSON or CSV (scan_file.h), a log of CARMEN (.log, .log.gz, .clf,
// .clf.gz), or the nodes of the first trajectory of a map (.pbstream), with the
// poses of local SLAM as odometry. There is at least one scan. Fails as the
// readers of these files do, and for a map that has no scans.
[[nodiscard]] absl::StatusOr<ScanRecording> ReadRobotScans(
    const MapSource& source);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_APPS_ROBOT_SCANS_H_
