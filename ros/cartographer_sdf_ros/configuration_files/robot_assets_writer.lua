-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- For cartographer_assets_writer: draws a map of ROS (map.pgm and map.yaml) from
-- the scans of a bag at the poses of a map, which close_loops may have corrected.

options = {
  tracking_frame = "base_link",
  pipeline = {
    {
      action = "min_max_range_filter",
      min_range = 0.1,
      -- [m] Below what the laser reports where nothing returns.
      max_range = 30.,
    },
    {
      action = "write_ros_map",
      range_data_inserter = {
        insert_free_space = true,
        hit_probability = 0.55,
        miss_probability = 0.49,
      },
      filestem = "map",
      resolution = 0.05,
    },
  },
}

return options
