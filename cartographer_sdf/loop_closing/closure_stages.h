// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// From accepted matches to constraints, as in CloseLoops, for maps that may
// come from several files.

#ifndef CARTOGRAPHER_SDF_LOOP_CLOSING_CLOSURE_STAGES_H_
#define CARTOGRAPHER_SDF_LOOP_CLOSING_CLOSURE_STAGES_H_

#include <functional>
#include <map>
#include <set>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/closure/consistency.h"
#include "cartographer_sdf/loop_closing/described_map.h"
#include "cartographer_sdf/loop_closing/torn_submaps.h"
#include "cartographer_sdf/loop_closing/withdrawal.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/pose_graph/lifting.h"

namespace cartographer_sdf {

// Sets the fates of closures by whether they are consistent with each other. A
// closure of a torn submap has no voice: it speaks neither for nor against
// others, and needs their support.
void SelectClosures(const ConsistencyOptions& options, const MapState& state,
                    const std::map<SubmapId, Tear>& torn,
                    std::vector<ClosureOutcome>* outcomes);

// The range data of nodes, wherever it is; see ReadPointClouds.
using PointCloudReader =
    std::function<absl::StatusOr<std::map<NodeId, PointCloud2>>(
        const std::set<NodeId>&)>;

// The scans of nodes as points to be registered, all equally certain; nodes
// without a scan are absent. Does not call the reader where no node is asked
// for. Fails as the reader does.
[[nodiscard]] absl::StatusOr<ScansByNode> ReadScans(
    const std::set<NodeId>& nodes, const PointCloudReader& read_point_clouds);

// The scans that LiftClosures registers. Fails as the reader does.
[[nodiscard]] absl::StatusOr<ScansByNode> ReadScansToLift(
    const LiftingOptions& options, const PoseGraph& pose_graph,
    const std::vector<ClosureOutcome>& outcomes,
    const PointCloudReader& read_point_clouds);

// Makes constraints of the closures that are to go into the graph, or sets
// their fate to kScansDisagree.
void LiftClosures(const LiftingOptions& options, const PoseGraph& pose_graph,
                  const std::map<SubmapId, Place>& places,
                  const ScansByNode& scans, const Executor& executor,
                  std::vector<ClosureOutcome>* outcomes);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_LOOP_CLOSING_CLOSURE_STAGES_H_
