#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Tests what scripts/measure_ros.py reads of nodes; skips where ROS 1 is absent.

usage: measure_ros_test.py
"""

import io
import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

SCRIPTS = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts"
sys.path.insert(0, str(SCRIPTS))
LOG = """[ INFO] [1700000001.250000000, 1.0]: I1127 17:00:00.000000 0 constraint_builder_2d.cc:260] \
Node (0, 12) with 345 points on submap (0, 3) differs by translation 0.01 rotation 0.001 with score 65.0%.
[ INFO] [1700000002.500000000, 2.0]: I1127 17:00:00.000000 0 searcher.cc:323] \
closure of submap (0, 9) with (0, 1): ready, score 7.5, 9 inliers, overlap 30, wall distance 0.03 m
[ INFO] [1700000003.000000000, 3.0]: I1127 17:00:00.000000 0 searcher.cc:323] \
closure of submap (0, 10) with (0, 1): unsupported, score 1.5, 9 inliers, overlap 30
[ INFO] [1700000004.000000000, 4.0]: I1127 17:00:00.000000 0 constraint_builder_2d.cc:281] \
90 computations resulted in 12 additional constraints.
"""


def load():
    # What comes from a built workspace is not used here.
    os.environ.setdefault("CARTOGRAPHER_ROS_PREFIX", "")
    for name in ("cartographer_ros_msgs", "cartographer_sdf_msgs"):
        sys.modules[name] = sys.modules[name + ".srv"] = mock.MagicMock()
    try:
        import measure_ros
        from geometry_msgs.msg import Point
        from std_msgs.msg import ColorRGBA
        from visualization_msgs.msg import Marker, MarkerArray
    except ImportError as error:
        raise unittest.SkipTest(str(error)) from error
    return measure_ros, Marker, MarkerArray, Point, ColorRGBA


class MeasureRosTest(unittest.TestCase):

    def test_counts_inter_constraints_of_an_encoded_message(self):
        measure_ros, Marker, MarkerArray, Point, ColorRGBA = load()
        array = MarkerArray()
        for name, count in (("Intra constraints", 7), ("Inter constraints, same trajectory", 3),
                            ("Inter residuals, same trajectory", 3),
                            ("Inter constraints, different trajectories", 2)):
            marker = Marker(ns=name, text="four", mesh_resource="of ten")
            marker.header.frame_id = "map"
            marker.points = [Point()] * (2 * count)
            marker.colors = [ColorRGBA()] * (2 * count)
            array.markers.append(marker)
        encoded = io.BytesIO()
        array.serialize(encoded)
        self.assertEqual(measure_ros.count_inter_constraints(encoded.getvalue()), 5)
        self.assertEqual(measure_ros.count_inter_constraints(b"\0\0\0\0"), 0)

    def test_finds_the_last_match_that_holds(self):
        measure_ros, *_ = load()
        with tempfile.TemporaryDirectory() as directory:
            log = pathlib.Path(directory) / "node.log"
            log.write_text(LOG)
            self.assertAlmostEqual(measure_ros.last_match(log, 1.7e9), 2.5)
            log.write_text(LOG.split("\n", 1)[0])
            self.assertAlmostEqual(measure_ros.last_match(log, 1.7e9), 1.25)
            log.write_text("")
            self.assertIsNone(measure_ros.last_match(log, 1.7e9))


if __name__ == "__main__":
    unittest.main()
