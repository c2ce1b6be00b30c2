-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- As cartographer_mapping.lua, but with Cartographer's own search for loop
-- closures off: only the searcher closes loops. With an empty
-- --sdf_configuration_basename= nothing does.

include "cartographer_mapping.lua"

-- [m] Greatest distance of a submap to match a node with. Not
-- constraint_builder.sampling_ratio = 0.: with that, Cartographer logs a warning
-- for each node and submap.
POSE_GRAPH.constraint_builder.max_constraint_distance = 0.
-- Fraction of the nodes to match with whole submaps of trajectories that are not
-- connected yet.
POSE_GRAPH.global_sampling_ratio = 0.

return options
