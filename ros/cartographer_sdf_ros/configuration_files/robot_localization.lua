-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- Localisation in a frozen map with cartographer_ros.

include "cartographer_localization.lua"
include "robot.lua"

return options
