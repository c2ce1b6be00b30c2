// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// relocalize --scan: where in a map a robot stands, by its scans.

#ifndef CARTOGRAPHER_SDF_TOOLS_SCAN_LOCALIZATION_H_
#define CARTOGRAPHER_SDF_TOOLS_SCAN_LOCALIZATION_H_

#include "absl/status/status.h"
#include "cartographer_sdf/tools/run_record.h"
#include "gflags/gflags.h"

DECLARE_string(scan);

namespace cartographer_sdf {

// Localises each file of --scan in --map, which may be a ROS map, and writes
// what the flags ask for.
[[nodiscard]] absl::Status RunScanLocalization(RunRecord* record);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_SCAN_LOCALIZATION_H_
