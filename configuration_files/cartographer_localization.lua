-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- As cartographer_mapping.lua, for localisation in a frozen map: the searcher
-- finds where the robot is, Cartographer's own local search keeps it there.

include "cartographer_mapping.lua"

-- Submaps of the drive that are kept; older ones are forgotten.
TRAJECTORY_BUILDER.pure_localization_trimmer = {
  max_submaps_to_keep = 3,
}
-- A constraint acts with the next optimisation. With a frozen map there is
-- little to optimise.
POSE_GRAPH.optimize_every_n_nodes = 3
-- The searcher does what this would: matching single scans with whole submaps,
-- anywhere in the map.
POSE_GRAPH.global_sampling_ratio = 0.
-- [s] After so long without a constraint, Cartographer would leave its local
-- search for the global one. Never: that is switched off.
POSE_GRAPH.global_constraint_search_after_n_seconds = 1e9

-- Until its first optimisation in the map, a trajectory that was just located is
-- still anywhere, and the local search tries all submaps there, however wrong;
-- the optimisation waits for it. Once there, it knows its place to centimetres.
-- So: [m] submaps no farther away,
POSE_GRAPH.constraint_builder.max_constraint_distance = 10.
-- this part of the nodes, for each submap,
POSE_GRAPH.constraint_builder.sampling_ratio = 0.1
-- [m], [rad] and no farther around than odometry errs between two matches. In so
-- small a window five levels of resolution do.
POSE_GRAPH.constraint_builder.fast_correlative_scan_matcher.linear_search_window = 2.
POSE_GRAPH.constraint_builder.fast_correlative_scan_matcher.angular_search_window = math.rad(10.)
POSE_GRAPH.constraint_builder.fast_correlative_scan_matcher.branch_and_bound_depth = 5

return options
