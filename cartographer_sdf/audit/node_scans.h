// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_AUDIT_NODE_SCANS_H_
#define CARTOGRAPHER_SDF_AUDIT_NODE_SCANS_H_

#include <set>
#include <string>

#include "absl/status/statusor.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/pose_graph/lifting.h"

namespace cartographer_sdf {

// The scans of nodes as points to be registered; nodes without a scan are
// absent. Does not read the file where no node is asked for. Fails as
// ReadPointClouds does.
[[nodiscard]] absl::StatusOr<ScansByNode> ReadScans(
    const std::string& path, const std::set<NodeId>& nodes,
    const ProgressCallback& on_progress = {});

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_AUDIT_NODE_SCANS_H_
