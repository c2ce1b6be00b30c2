-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- As robot_mapping.lua, but only the searcher closes loops, which takes a
-- fraction of the CPU time.

include "cartographer_mapping_searcher_only.lua"
include "robot.lua"

return options
