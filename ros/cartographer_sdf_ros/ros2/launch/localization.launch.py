# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Cartographer with the searcher around it: localisation in a frozen map."""

import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

SHARE_DIRECTORY = get_package_share_directory('cartographer_sdf_ros')
CONFIGURATION_DIRECTORY = os.path.join(SHARE_DIRECTORY, 'configuration_files')
ARGUMENTS = [
    DeclareLaunchArgument('configuration_directory', default_value=CONFIGURATION_DIRECTORY),
    DeclareLaunchArgument('configuration_basename', default_value='robot_localization.lua'),
    DeclareLaunchArgument('sdf_configuration_basename', default_value='sdf_live.lua'),
    DeclareLaunchArgument('scan', default_value='scan'),
    DeclareLaunchArgument('odometry', default_value='odom'),
    DeclareLaunchArgument('imu', default_value='imu'),
    DeclareLaunchArgument('use_sim_time', default_value='false'),
    DeclareLaunchArgument('collect_metrics', default_value='false'),
    DeclareLaunchArgument('rviz', default_value='false'),
    DeclareLaunchArgument('pose_topic', default_value='sdf_pose'),
    DeclareLaunchArgument('matches_topic', default_value='sdf_matches'),
    DeclareLaunchArgument('diagnostics_topic', default_value='/diagnostics'),
    DeclareLaunchArgument('map', description='The .pbstream to localise in'),
    DeclareLaunchArgument(
        'initial_pose_topic', default_value='',
        description='For programs that wait for an initial pose; empty: none'),
    DeclareLaunchArgument(
        'restart_to_search', default_value='true',
        description='/sdf_localize ends the trajectory and starts another'),
]
PARAMETERS = [
    ('use_sim_time', bool),
    ('pose_topic', str),
    ('matches_topic', str),
    ('diagnostics_topic', str),
    ('initial_pose_topic', str),
    ('restart_to_search', bool),
]


def generate_launch_description():
    """The node, cartographer_ros's that publishes the map, and RViz on request."""
    cartographer = Node(
        package='cartographer_sdf_ros',
        executable='cartographer_sdf_node',
        name='cartographer_node',
        output='screen',
        # glibc keeps what describing a submap frees (docs/live.md).
        additional_env={
            'MALLOC_TRIM_THRESHOLD_': '536870912',
            'MALLOC_MMAP_THRESHOLD_': '33554432',
        },
        parameters=[{name: ParameterValue(LaunchConfiguration(name), value_type=kind)
                     for name, kind in PARAMETERS}],
        arguments=[
            '-configuration_directory', LaunchConfiguration('configuration_directory'),
            '-configuration_basename', LaunchConfiguration('configuration_basename'),
            '-sdf_configuration_basename', LaunchConfiguration('sdf_configuration_basename'),
            ['-collect_metrics=', LaunchConfiguration('collect_metrics')],
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
        parameters=[{'use_sim_time': LaunchConfiguration('use_sim_time')}],
        arguments=['-resolution', '0.05'])
    rviz = Node(
        package='rviz2',
        executable='rviz2',
        name='rviz',
        arguments=['-d', os.path.join(SHARE_DIRECTORY, 'rviz', 'searcher_ros2.rviz')],
        condition=IfCondition(LaunchConfiguration('rviz')))
    return LaunchDescription([*ARGUMENTS, cartographer, grid, rviz])
