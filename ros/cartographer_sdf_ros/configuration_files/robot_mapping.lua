-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- Mapping with cartographer_ros, with Cartographer's own loop search and the
-- searcher.

include "cartographer_mapping.lua"
include "robot.lua"

return options
