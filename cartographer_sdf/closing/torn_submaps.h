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

// The submaps of a map that their own scans, where `pose_graph`'s intra-submap
// constraints place them, show to be torn. Nodes without a scan are left out.
[[nodiscard]] std::map<SubmapId, Tear> FindTornSubmaps(
    const TearOptions& options, const PoseGraph& pose_graph,
    const std::map<NodeId, PointCloud2>& scans, const Executor& executor,
    const ProgressCallback& on_progress = {});

// One line each for people: ids, by how much, and between which parts.
[[nodiscard]] std::string DescribeTear(const SubmapId& id, const Tear& tear);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CLOSING_TORN_SUBMAPS_H_
