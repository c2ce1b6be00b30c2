// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_CLOSING_TORN_SUBMAPS_H_
#define CARTOGRAPHER_SDF_CLOSING_TORN_SUBMAPS_H_

#include <map>
#include <string>

#include "cartographer_sdf/execution/executor.h"
#include "cartographer_sdf/execution/progress.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/verification/tear.h"

namespace cartographer_sdf {

// Finds the submaps that are torn according to their own scans, placed by the
// intra-submap constraints of `pose_graph`. Skips nodes without a scan.
[[nodiscard]] std::map<SubmapId, Tear> FindTornSubmaps(
    const TearOptions& options, const PoseGraph& pose_graph,
    const std::map<NodeId, PointCloud2>& scans, const Executor& executor,
    const ProgressCallback& on_progress = {});

// Returns one human-readable line: the id, the two parts, and their offset.
[[nodiscard]] std::string DescribeTear(const SubmapId& id, const Tear& tear);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CLOSING_TORN_SUBMAPS_H_
