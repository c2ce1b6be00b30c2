-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- Options of Cartographer itself, for cartographer_sdf_run_log: mapping with a
-- planar laser and odometry from wheels that slip. Builds on Cartographer's own
-- files, as a robot's configuration does; they are found where Cartographer is
-- installed. The searcher's options are in sdf_live.lua.

include "map_builder.lua"
include "trajectory_builder.lua"

options = {
  map_builder = MAP_BUILDER,
  trajectory_builder = TRAJECTORY_BUILDER,
}

MAP_BUILDER.use_trajectory_builder_2d = true

-- A submap holds twice this many kept scans and shares half of them with the
-- previous submap. Smaller: less drift within a submap, less to recognise a
-- place by.
TRAJECTORY_BUILDER_2D.submaps.num_range_data = 60
-- [m] Closer returns come from the robot itself.
TRAJECTORY_BUILDER_2D.min_range = 0.1
-- [m] Of longer beams, only the free space of the first metres is used.
TRAJECTORY_BUILDER_2D.max_range = 30.
-- Sparse scans need a search: wheel odometry alone is too inaccurate.
TRAJECTORY_BUILDER_2D.use_online_correlative_scan_matching = true
-- [rad] A scan is kept when the robot has turned by this angle.
TRAJECTORY_BUILDER_2D.motion_filter.max_angle_radians = math.rad(2.)

-- With Cartographer's default, 1e5, odometry outweighs loop closures.
POSE_GRAPH.optimization_problem.odometry_translation_weight = 1e3
POSE_GRAPH.optimization_problem.odometry_rotation_weight = 1e3

return options
