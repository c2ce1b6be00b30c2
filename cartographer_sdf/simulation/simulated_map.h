// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The map that Cartographer would have saved of a drive through a floor plan
// with loop closing switched off, and the true poses. It has one trajectory,
// number 0.

#ifndef CARTOGRAPHER_SDF_SIMULATION_SIMULATED_MAP_H_
#define CARTOGRAPHER_SDF_SIMULATION_SIMULATED_MAP_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_sdf/geometry/rigid2.h"
#include "cartographer_sdf/grid/occupancy_grid.h"
#include "cartographer_sdf/pbstream/map_file.h"
#include "cartographer_sdf/pose_graph/pose_graph.h"
#include "cartographer_sdf/simulation/drift.h"
#include "cartographer_sdf/simulation/drive.h"
#include "cartographer_sdf/simulation/floor_plan.h"
#include "cartographer_sdf/simulation/lidar.h"
#include "cartographer_sdf/simulation/people.h"

namespace cartographer_sdf {

struct SimulationOptions {
  DriveOptions drive;
  LidarOptions lidar;
  PeopleOptions people;
  DriftOptions drift;
  // A submap holds twice this number of scans and shares half of them with the
  // next.
  int num_range_data = 60;
};

[[nodiscard]] std::string Validate(const SimulationOptions& options);

// Time: as Node::time. Gravity alignment is the identity everywhere, so node,
// robot and tracking frame are one.
struct SimulatedNode {
  int64_t time = 0;
  Rigid2 T_local_node;
  Rigid2 T_world_node;
  PointCloud2 points;  // In the node frame.
};

struct SimulatedSubmap {
  // Nodes [first_node, end_node) were inserted.
  int first_node = 0;
  int end_node = 0;
  // As in the host: at the first node, with the orientation of the local frame.
  Rigid2 T_local_submap;
  // From the true pose of the first node.
  Rigid2 T_world_submap;
  OccupancyGrid grid;
};

struct SimulatedOdometry {
  int64_t time = 0;
  Rigid2 T_odometry_node;
};

// All submaps are finished, and each node is in at least one submap.
struct SimulatedMap {
  std::vector<SimulatedNode> nodes;
  std::vector<SimulatedSubmap> submaps;
  // Covers the times of all nodes.
  std::vector<SimulatedOdometry> odometry;
};

// Deterministic. A different seed yields another session in the same building,
// with other places, drift and noise. Fails on invalid options, a plan without
// room for the robot, or a drive too short for a submap. The progress is the
// fraction of the total time.
[[nodiscard]] absl::StatusOr<SimulatedMap> Simulate(
    const FloorPlan& plan, const SimulationOptions& options, uint32_t seed,
    const ProgressCallback& on_progress = {});

// Writes the map as a .pbstream that Cartographer loads, with its drifted poses
// and the constraints of local SLAM between each node and the submaps it was
// inserted in. Writes the truth as kind,trajectory,index,x,y,yaw: poses of
// submaps and nodes in the world frame. Each file is written completely or not
// at all.
[[nodiscard]] absl::Status WriteSimulatedMap(const SimulatedMap& map,
                                             const std::string& map_path,
                                             const std::string& truth_path);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_SIMULATION_SIMULATED_MAP_H_
