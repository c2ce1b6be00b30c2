#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Tests that the layouts for Foxglove and RViz fit each other, the nodes, and what
the programs expect; and that the picture of Foxglove's has all of its panels.

usage: ros_layouts_test.py
"""

import json
import pathlib
import re
import sys
import tempfile
import types
import unittest

SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent
ROS = SOURCE / "ros" / "cartographer_sdf_ros"
sys.path.insert(0, str(SOURCE / "scripts"))
import draw_foxglove_layout as drawing  # noqa: E402

# Settings of the panels that are used, as Foxglove's SDK (foxglove.layouts) and the
# settings of its panels name them.
PANEL_KEYS = {
    "3D": {"followTf", "followMode", "scene", "cameraState", "transforms", "topics", "layers",
           "foxglovePanelTitle"},
    "DiagnosticStatusPanel": {"selectedHardwareId", "selectedName", "splitFraction",
                              "topicToRender", "numericPrecision", "secondsUntilStale"},
    "DiagnosticSummary": {"minLevel", "pinnedIds", "topicToRender", "hardwareIdFilter",
                          "sortByLevel", "secondsUntilStale"},
    "CallService": {"serviceName", "requestPayload", "layout", "buttonText", "buttonTooltip",
                    "buttonColor", "editingMode", "timeoutSeconds", "foxglovePanelTitle"},
}
CAMERA_KEYS = {"distance", "perspective", "phi", "target", "targetOffset", "targetOrientation",
               "thetaOffset", "fovy", "near", "far", "logDepth"}
# By type of the topic's messages.
TOPIC_KEYS = {
    "OccupancyGrid": {"visible", "frameLocked", "colorMode", "minColor", "maxColor",
                      "unknownColor", "invalidColor", "alpha"},
    "MarkerArray": {"visible", "color", "namespaces", "showOutlines", "selectedIdVariable"},
    "PoseWithCovarianceStamped": {"visible", "type", "axisScale", "arrowScale", "color",
                                  "showCovariance", "covarianceColor"},
    "PointCloud2": {"visible", "colorMode", "flatColor", "colorField", "gradient", "colorMap",
                    "explicitAlpha", "minValue", "maxValue", "pointSize", "pointShape",
                    "decayTime"},
}
# Of cartographer_node and, /map, cartographer_occupancy_grid_node.
HOST_TOPICS = {"/map": "OccupancyGrid", "/trajectory_node_list": "MarkerArray",
               "/landmark_poses_list": "MarkerArray", "/constraint_list": "MarkerArray",
               "/scan_matched_points2": "PointCloud2"}


def our_topics():
    """What both nodes publish, with their default parameters."""
    defaults = dict(re.findall(r'std::string (\w+)_topic = "/?(\w+)"',
                               (ROS / "messages.h").read_text()))
    return {"/" + defaults["pose"]: "PoseWithCovarianceStamped",
            "/" + defaults["matches"]: "MarkerArray",
            "/" + defaults["diagnostics"]: "DiagnosticArray"}


class FoxgloveLayoutTest(unittest.TestCase):

    def setUp(self):
        self.layout = json.loads((ROS / "foxglove" / "searcher.json").read_text())
        self.configs = {drawing.type_of(panel): config
                        for panel, config in self.layout["configById"].items()}

    def test_every_panel_has_its_settings_and_its_place(self):
        panels = drawing.arrange(self.layout["layout"], (0., 0., 100., 50.))
        self.assertEqual(sorted(panel for panel, _ in panels), sorted(self.layout["configById"]))
        self.assertAlmostEqual(sum(box[2] * box[3] for _, box in panels), 100. * 50.)
        self.assertEqual(set(self.configs), set(drawing.PANELS))

    def test_settings_are_those_of_the_panels(self):
        for kind, config in self.configs.items():
            self.assertLessEqual(set(config), PANEL_KEYS[kind], kind)
        self.assertLessEqual(set(self.configs["3D"]["cameraState"]), CAMERA_KEYS)

    def test_shows_only_topics_that_are_published(self):
        published = {**HOST_TOPICS, **our_topics()}
        self.assertLessEqual(drawing.topics_of(self.layout), set(published))
        for topic, settings in self.configs["3D"]["topics"].items():
            self.assertLessEqual(set(settings), TOPIC_KEYS[published[topic]], topic)
        for kind in ("DiagnosticStatusPanel", "DiagnosticSummary"):
            self.assertEqual(published[self.configs[kind]["topicToRender"]], "DiagnosticArray")

    def test_names_the_hardware_of_the_status(self):
        hardware = re.search(r'hardware_id = "(\w+)"', (ROS / "messages.h").read_text())[1]
        self.assertEqual(self.configs["DiagnosticStatusPanel"]["selectedHardwareId"], hardware)
        self.assertEqual(self.configs["DiagnosticSummary"]["hardwareIdFilter"], hardware)

    def test_calls_a_service_of_both_nodes_with_its_fields(self):
        config = self.configs["CallService"]
        for node in ("ros1", "ros2"):
            self.assertIn('"' + config["serviceName"].strip("/") + '"',
                          (ROS / node / "node_main.cc").read_text())
        request = (ROS.parent / "cartographer_sdf_msgs/srv/Locate.srv").read_text().split("---")[0]
        fields = re.findall(r"^(int32|bool) (\w+)$", request, re.MULTILINE)
        kinds = {"int32": int, "bool": bool}
        self.assertEqual({name: type(value)
                          for name, value in json.loads(config["requestPayload"]).items()},
                         {name: kinds[kind] for kind, name in fields})


class RvizLayoutTest(unittest.TestCase):

    def setUp(self):
        foxglove = json.loads((ROS / "foxglove" / "searcher.json").read_text())
        self.shown = set(foxglove["configById"]["3D!map"]["topics"])

    def displays(self, name):
        text = (ROS / "rviz" / name).read_text()
        return text[:text.index("Global Options:")]

    def test_shows_what_foxglove_shows(self):
        self.assertEqual(set(re.findall(r"(?:Marker )?Topic: (/\w+)",
                                        self.displays("searcher.rviz"))), self.shown)
        self.assertEqual(set(re.findall(r"Value: (/\w+)",
                                        self.displays("searcher_ros2.rviz"))), self.shown)

    def test_gets_what_was_published_before_in_ros_2(self):
        latched = re.findall(r"Durability Policy: Transient Local\n.*\n.*\n *Value: (/\w+)",
                             self.displays("searcher_ros2.rviz"))
        self.assertEqual(set(latched), {"/map", "/sdf_matches", "/sdf_pose"})


class DrawingTest(unittest.TestCase):

    def test_arranges_splits(self):
        node = {"direction": "row", "splitPercentage": 70, "first": "a",
                "second": {"direction": "column", "splitPercentage": 60, "first": "b",
                           "second": {"direction": "column", "first": "c", "second": "d"}}}
        boxes = dict(drawing.arrange(node, (0, 0, 1000, 500)))
        for name, expected in {"a": (0, 0, 700, 500), "b": (700, 0, 300, 300),
                               "c": (700, 300, 300, 100), "d": (700, 400, 300, 100)}.items():
            for value, of_expected in zip(boxes[name], expected):
                self.assertAlmostEqual(value, of_expected)

    def test_chains_frames(self):
        def transform(parent, child, x, yaw):
            turn = types.SimpleNamespace(z=drawing.math.sin(yaw / 2.), w=drawing.math.cos(yaw / 2.))
            return child, types.SimpleNamespace(
                header=types.SimpleNamespace(frame_id=parent),
                transform=types.SimpleNamespace(translation=types.SimpleNamespace(x=x, y=0.),
                                                rotation=turn))

        quarter = drawing.math.pi / 2.
        transforms = dict([transform("map", "odom", 1., quarter),
                           transform("odom", "base_link", 2., quarter)])
        for value, expected in zip(drawing.pose_in("map", "base_link", transforms),
                                   (1., 2., 2. * quarter)):
            self.assertAlmostEqual(value, expected)
        self.assertIsNone(drawing.pose_in("map", "laser", transforms))

    def test_draws_every_panel_without_messages(self):
        try:
            import matplotlib  # noqa: F401
        except ImportError as error:
            raise unittest.SkipTest(str(error)) from error
        layout = json.loads((ROS / "foxglove" / "searcher.json").read_text())
        with tempfile.TemporaryDirectory() as directory:
            path = pathlib.Path(directory) / "picture.png"
            drawing.draw(layout, ({}, {}, {}), path)
            self.assertEqual(path.read_bytes()[16:24],
                             drawing.WIDTH.to_bytes(4, "big") + drawing.HEIGHT.to_bytes(4, "big"))


if __name__ == "__main__":
    unittest.main()
