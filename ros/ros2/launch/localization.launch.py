# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Cartographer with the searcher around it: localisation in a frozen map."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

ARGUMENTS = [
    DeclareLaunchArgument('configuration_directory'),
    DeclareLaunchArgument('configuration_basename'),
    DeclareLaunchArgument('sdf_configuration_basename', default_value='sdf_live.lua'),
    DeclareLaunchArgument('scan', default_value='scan'),
    DeclareLaunchArgument('odometry', default_value='odom'),
    DeclareLaunchArgument('imu', default_value='imu'),
    DeclareLaunchArgument('map', description='The .pbstream to localise in'),
]


def generate_launch_description():
    """The node, and cartographer_ros's that publishes the map."""
    cartographer = Node(
        package='cartographer_sdf_ros',
        executable='cartographer_sdf_node',
        name='cartographer_node',
        output='screen',
        arguments=[
            '-configuration_directory', LaunchConfiguration('configuration_directory'),
            '-configuration_basename', LaunchConfiguration('configuration_basename'),
            '-sdf_configuration_basename', LaunchConfiguration('sdf_configuration_basename'),
            '-load_state_filename', LaunchConfiguration('map'),
            '-load_frozen_state=true',
        ],
        remappings=[
            ('scan', LaunchConfiguration('scan')),
            ('odom', LaunchConfiguration('odometry')),
            ('imu', LaunchConfiguration('imu')),
        ])
    grid = Node(
        package='cartographer_ros',
        executable='cartographer_occupancy_grid_node',
        name='cartographer_occupancy_grid_node',
        arguments=['-resolution', '0.05'])
    return LaunchDescription([*ARGUMENTS, cartographer, grid])
