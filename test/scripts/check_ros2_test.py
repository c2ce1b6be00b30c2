#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Tests how scripts/check_ros2.py finds packages, and that it says why it skips.

usage: check_ros2_test.py
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts"
sys.path.insert(0, str(SCRIPTS))
import check_ros2  # noqa: E402


def add_package(root, folder, name, *dependencies):
    (root / folder).mkdir(parents=True)
    (root / folder / "package.xml").write_text(
        f"<package format='3'><name>{name}</name>{''.join(dependencies)}</package>")


class CheckRos2Test(unittest.TestCase):

    def setUp(self):
        self.directory = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.directory.name)

    def tearDown(self):
        self.directory.cleanup()

    def test_needs_what_is_depended_on_in_ros_2(self):
        add_package(self.root, "a/node", "node",
                    '<depend condition="$ROS_VERSION == 2">client</depend>',
                    '<depend condition="$ROS_VERSION != 2">client_of_ros_1</depend>',
                    "<build_depend>messages</build_depend>", "<exec_depend>player</exec_depend>",
                    "<depend>absent</depend>")
        add_package(self.root, "b/client", "client", "<depend>node</depend>")
        for name in ("messages", "player", "client_of_ros_1"):
            add_package(self.root, f"b/{name}", name)
        packages = check_ros2.find_packages(self.root)
        self.assertEqual(packages["client"], self.root / "b" / "client")
        self.assertEqual(sorted(check_ros2.needed_packages(packages, ["node"])),
                         ["client", "messages", "node"])

    def test_our_node_needs_its_messages(self):
        packages = check_ros2.find_packages(check_ros2.SOURCE / "ros")
        self.assertEqual(sorted(check_ros2.needed_packages(packages, ["cartographer_sdf_ros"])),
                         ["cartographer_sdf_msgs", "cartographer_sdf_ros"])

    def test_skips_with_a_reason(self):
        environment = {**os.environ, "CXX": "true", "ROS2_SOURCES": str(self.root),
                       "BUILD_DIR": str(self.root)}
        result = subprocess.run([sys.executable, SCRIPTS / "check_ros2.py"], env=environment,
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, "^check_ros2.py: skipped: there is no .+\n$")


if __name__ == "__main__":
    unittest.main()
