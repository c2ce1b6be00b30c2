// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_LOOP_CLOSING_TORN_SUBMAPS_H_
#define CARTOGRAPHER_SDF_LOOP_CLOSING_TORN_SUBMAPS_H_

#include <map>
#include <string>

#include "absl/status/statusor.h"
#include "cartographer_sdf/loop_closing/described_map.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/verification/self_contradiction.h"

namespace cartographer_sdf {

// The submaps of a saved map that their own scans show to be torn. Reads the
// scans from the file, some thousands at a time, where `pose_graph`'s
// intra-submap constraints place them. Fails as ReadPointClouds does; nodes
// without a scan are left out.
[[nodiscard]] absl::StatusOr<std::map<SubmapId, Tear>> FindTornSubmaps(
    const TearOptions& options, const std::string& path,
    const PoseGraph& pose_graph, const Executor& executor,
    const ProgressCallback& on_progress = {});

// One line each for people: ids, by how much, and between which parts.
[[nodiscard]] std::string DescribeTear(const SubmapId& id, const Tear& tear);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOOP_CLOSING_TORN_SUBMAPS_H_
