-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- As cartographer_mapping.lua, for localisation in a frozen map: the searcher
-- finds the robot's pose, and Cartographer's own local search tracks it.

include "cartographer_mapping.lua"

-- Number of submaps of the drive to keep; older ones are removed.
TRAJECTORY_BUILDER.pure_localization_trimmer = {
  max_submaps_to_keep = 3,
}
-- A constraint takes effect at the next optimisation. With a frozen map,
-- optimising often costs little.
POSE_GRAPH.optimize_every_n_nodes = 3
-- Off: the searcher replaces this search, which matches single scans with whole
-- submaps anywhere in the map.
POSE_GRAPH.global_sampling_ratio = 0.
-- [s] Time without a constraint after which Cartographer switches from its
-- local to its global search. Effectively never, because that search is off.
POSE_GRAPH.global_constraint_search_after_n_seconds = 1e9

-- A newly localised trajectory keeps its arbitrary pose until the first
-- optimisation in the map. Meanwhile the local search tries all submaps near
-- that pose, however wrong it is, and the optimisation waits for the search.
-- After that optimisation the pose is known to centimetres, so a narrow search
-- suffices. [m] Greatest distance of a submap.
POSE_GRAPH.constraint_builder.max_constraint_distance = 10.
-- Fraction of the nodes that are matched with each submap.
POSE_GRAPH.constraint_builder.sampling_ratio = 0.1
-- [m], [rad] Search window: the error of odometry between two matches. Five
-- levels of resolution suffice for a window this small.
POSE_GRAPH.constraint_builder.fast_correlative_scan_matcher.linear_search_window = 2.
POSE_GRAPH.constraint_builder.fast_correlative_scan_matcher.angular_search_window = math.rad(10.)
POSE_GRAPH.constraint_builder.fast_correlative_scan_matcher.branch_and_bound_depth = 5

return options
