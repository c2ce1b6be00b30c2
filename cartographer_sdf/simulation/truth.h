// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_SIMULATION_TRUTH_H_
#define CARTOGRAPHER_SDF_SIMULATION_TRUTH_H_

#include <map>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/submap_id.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"

namespace cartographer_sdf {

// True poses of a map's submaps and nodes. Absent if unknown, or if there is no
// single true pose: submaps that local SLAM tore.
struct Truth {
  std::map<SubmapId, Rigid2> T_world_submap;
  // Of the tracking frame at the nodes.
  std::map<NodeId, Rigid2> T_world_tracking;
};

// CSV with the columns kind (submap or node), trajectory, index, x, y, yaw [m,
// m, rad].
[[nodiscard]] absl::StatusOr<Truth> ReadTruth(const std::string& path);

// Precise to 1e-9 m and 1e-9 rad.
[[nodiscard]] absl::Status WriteTruth(const std::string& path,
                                      const Truth& truth);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SIMULATION_TRUTH_H_
