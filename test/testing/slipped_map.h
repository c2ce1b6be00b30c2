// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Simulated maps with a tear in known submaps.

#ifndef TEST_TESTING_SLIPPED_MAP_H_
#define TEST_TESTING_SLIPPED_MAP_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_sdf/grid/scan_grid.h"
#include "cartographer_sdf/simulation/office.h"
#include "cartographer_sdf/simulation/simulated_map.h"
#include "glog/logging.h"

namespace cartographer_sdf::testing {

enum class Slip { kNone, kInSubmaps8And9 };
constexpr int kSlippedNode = 9 * 60 + 30;
// (before <- after), as seen from the robot.
inline Rigid2 SlipPose() { return Rigid2(0.4, 0.5, 0.05); }

// Draws the grids anew from where local SLAM has the nodes.
inline void DrawGrids(SimulatedMap* const map) {
  for (SimulatedSubmap& submap : map->submaps) {
    const SimulatedNode& first = map->nodes[submap.first_node];
    submap.T_local_submap = Rigid2(first.T_local_node.translation(), 0.);
    const Rigid2 T_submap_local = submap.T_local_submap.Inverse();
    submap.T_world_submap =
        first.T_world_node * (T_submap_local * first.T_local_node).Inverse();
    ScanGrid grid((ScanGridOptions()));
    for (int k = submap.first_node; k < submap.end_node; ++k) {
      grid.Insert(T_submap_local * map->nodes[k].T_local_node,
                  {map->nodes[k].points, {}});
    }
    submap.grid = grid.Crop();
  }
}

// A drive through an invented office. Where local SLAM slips, it does so once,
// by 0.64 m and 0.05 rad as seen from the robot, in the middle of the 60 scans
// that submaps 8 and 9 share.
inline void WriteOffice(const Slip slip, const std::string& path) {
  SimulationOptions options;
  options.drive.length = 240.;
  absl::StatusOr<SimulatedMap> map =
      Simulate(MakeOffice(OfficeOptions(), 1), options, 1);
  CHECK(map.ok()) << map.status();
  if (slip == Slip::kInSubmaps8And9) {
    const Rigid2 T_local_node = map->nodes[kSlippedNode].T_local_node;
    const Rigid2 T_before_after =
        T_local_node * SlipPose() * T_local_node.Inverse();
    for (size_t k = kSlippedNode; k < map->nodes.size(); ++k) {
      map->nodes[k].T_local_node = T_before_after * map->nodes[k].T_local_node;
    }
  }
  DrawGrids(&*map);
  const absl::Status status =
      WriteSimulatedMap(*map, path, path + ".truth.csv");
  CHECK(status.ok()) << status;
}

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_SLIPPED_MAP_H_
