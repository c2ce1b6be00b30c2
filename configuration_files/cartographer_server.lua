-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- Options of Cartographer itself, for cartographer_sdf_grpc_server: a pose graph
-- that several robots share. What a trajectory needs, its robot sends. The
-- searcher's options are in sdf_live.lua.

include "map_builder_server.lua"

MAP_BUILDER.use_trajectory_builder_2d = true

-- Where robots connect. Whoever can may stop the server, and write files as its
-- user: no more of the network than necessary. "0.0.0.0:50051" is all of it.
MAP_BUILDER_SERVER.server_address = "localhost:50051"

-- Only the searcher closes loops, see cartographer_mapping_searcher_only.lua.
POSE_GRAPH.constraint_builder.max_constraint_distance = 0.
POSE_GRAPH.global_sampling_ratio = 0.
-- As in cartographer_mapping.lua.
POSE_GRAPH.optimization_problem.odometry_translation_weight = 1e3
POSE_GRAPH.optimization_problem.odometry_rotation_weight = 1e3

return MAP_BUILDER_SERVER
