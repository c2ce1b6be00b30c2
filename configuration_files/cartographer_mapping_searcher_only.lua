-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- As cartographer_mapping.lua, but Cartographer's own search for loop closures
-- is off: what closes a loop is the searcher. With --sdf_configuration_basename=
-- (nothing) no loop is closed at all.

include "cartographer_mapping.lua"

-- Of all pairs of nodes and submaps, the fraction that is matched: of those near
-- each other, and of those whose trajectories have nothing in common yet.
POSE_GRAPH.constraint_builder.sampling_ratio = 0.
POSE_GRAPH.global_sampling_ratio = 0.

return options
