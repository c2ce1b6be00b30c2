-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

-- What cartographer_ros has to know of a robot, here one with a planar laser and
-- wheel odometry that publishes odom <- base_link on /tf. Copy it and change what
-- is different on yours. The other robot_*.lua include it after the options of
-- Cartographer itself.

options.map_frame = "map"
-- The frame whose pose is tracked; that of the IMU where there is one, and then
-- TRAJECTORY_BUILDER_2D.use_imu_data = true.
options.tracking_frame = "base_link"
-- Cartographer publishes map <- published_frame.
options.published_frame = "odom"
options.odom_frame = "odom"
options.provide_odom_frame = false
options.publish_frame_projected_to_2d = true
options.publish_tracked_pose = true
options.use_pose_extrapolator = true
options.use_odometry = true
options.use_nav_sat = false
options.use_landmarks = false
options.num_laser_scans = 1
options.num_multi_echo_laser_scans = 0
options.num_subdivisions_per_laser_scan = 1
options.num_point_clouds = 0
-- [s]
options.lookup_transform_timeout_sec = 0.2
options.submap_publish_period_sec = 0.3
options.pose_publish_period_sec = 5e-3
options.trajectory_publish_period_sec = 30e-3
options.rangefinder_sampling_ratio = 1.
options.odometry_sampling_ratio = 1.
options.fixed_frame_pose_sampling_ratio = 1.
options.imu_sampling_ratio = 1.
options.landmarks_sampling_ratio = 1.

TRAJECTORY_BUILDER_2D.use_imu_data = false
