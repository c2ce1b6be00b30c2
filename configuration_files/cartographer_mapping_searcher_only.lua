-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- As cartographer_mapping.lua, but with Cartographer's own search for loop
-- closures off: only the searcher closes loops. With an empty
-- --sdf_configuration_basename= nothing does.

include "cartographer_mapping.lua"

-- Fraction of the pairs of nodes and submaps that are matched: of pairs near
-- each other, and of pairs whose trajectories are not connected yet.
POSE_GRAPH.constraint_builder.sampling_ratio = 0.
POSE_GRAPH.global_sampling_ratio = 0.

return options
