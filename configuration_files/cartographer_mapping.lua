-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- Options of Cartographer itself, for cartographer_sdf_run_log: mapping with a
-- planar laser and the odometry of wheels that slip. As a robot of its own does,
-- from Cartographer's own files, which are found where it is installed. Not for
-- the searcher, whose options are in sdf_live.lua.

include "map_builder.lua"
include "trajectory_builder.lua"

options = {
  map_builder = MAP_BUILDER,
  trajectory_builder = TRAJECTORY_BUILDER,
}

MAP_BUILDER.use_trajectory_builder_2d = true

-- Submaps of 120 scans that were kept, each of 60 sharing theirs with the one
-- before. Smaller: less drift inside, less to recognise a place by.
TRAJECTORY_BUILDER_2D.submaps.num_range_data = 60
-- [m] Nearer returns are the robot itself.
TRAJECTORY_BUILDER_2D.min_range = 0.1
-- [m] Beyond it nothing is believed but that the first metres are free.
TRAJECTORY_BUILDER_2D.max_range = 30.
-- Sparse scans need a search, wheels alone do not tell well enough.
TRAJECTORY_BUILDER_2D.use_online_correlative_scan_matching = true
-- [rad] A scan is kept where the robot turned by so much.
TRAJECTORY_BUILDER_2D.motion_filter.max_angle_radians = math.rad(2.)

-- Cartographer's default, 1e5, makes wheels outweigh loop closures.
POSE_GRAPH.optimization_problem.odometry_translation_weight = 1e3
POSE_GRAPH.optimization_problem.odometry_rotation_weight = 1e3

return options
