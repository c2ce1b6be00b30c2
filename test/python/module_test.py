#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

"""Tests of the Python module.

usage: module_test.py PROGRAM SOURCE_DIRECTORY

The module is found by PYTHONPATH; PROGRAM simulates the maps.
"""

import ast
import importlib.util
import inspect
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import cartographer_sdf as sdf

PROGRAM, SOURCE = None, None


class MapTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        for name, seed in (("a", "1"), ("b", "2")):
            subprocess.run([PROGRAM, "simulate", "--output", cls.file(name + ".pbstream"), "--truth",
                            cls.file(name + ".csv"), "--length", "120", "--plan_width", "30",
                            "--plan_height", "26", "--seed", seed], check=True, capture_output=True)
        cls.map = sdf.read_map(cls.file("a.pbstream"))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def file(cls, name):
        return str(pathlib.Path(cls.folder.name) / name)

    def test_reads_what_info_counts(self):
        info = subprocess.run([PROGRAM, "info", self.file("a.pbstream"), "--result", "-"],
                              capture_output=True, check=True)
        import json
        counts = json.loads(info.stdout)["counts"]
        self.assertEqual(len(self.map.submaps), counts["submaps"])
        self.assertEqual(len(self.map.node_ids), counts["nodes"])
        self.assertEqual(len(self.map.constraints), counts["constraints"])
        self.assertEqual(self.map.node_poses.shape, (counts["nodes"], 3))
        self.assertTrue((np.diff(self.map.node_times) > 0).all())
        self.assertEqual(self.map.trajectories, [0])
        self.assertFalse(any(c.is_inter_submap for c in self.map.constraints))
        self.assertIn((0, 0), self.map.submaps)
        self.assertEqual(self.map.submaps[(0, 1)].x, self.map.submaps[sdf.SubmapId(0, 1)].x)

    def test_grids_are_arrays(self):
        grid = self.map.grid((0, 0))
        self.assertEqual(grid.probability.dtype, np.float32)
        self.assertEqual(grid.known.dtype, np.bool_)
        self.assertEqual(grid.probability.shape, grid.known.shape)
        known = grid.probability[grid.known]
        self.assertTrue(((known > 0) & (known < 1)).all())
        with self.assertRaises(KeyError):
            self.map.grid((0, 9999))
        # There and back.
        again = sdf.Grid(grid.probability, grid.known, grid.resolution, grid.T_submap_grid)
        np.testing.assert_array_equal(again.probability, grid.probability)
        np.testing.assert_array_equal(sdf.distance_field(again).distance,
                                      sdf.distance_field(grid).distance)

    def test_fields_are_distances(self):
        """Of a lone obstacle: the distance to its edge."""
        probability = np.full((60, 40), 0.1, np.float32)
        probability[10, 20] = 0.9
        grid = sdf.Grid(probability, np.ones((60, 40), bool), 0.1)
        field = sdf.distance_field(grid)
        rim = round((field.distance.shape[0] - 60) / 2)
        self.assertLess(field.distance[10 + rim, 20 + rim], 0)
        for i, j in ((30, 20), (10, 35), (13, 24)):
            centres = 0.1 * math.hypot(i - 10, j - 20)
            # The edge is half a cell from the centre, and up to 0.71 diagonally.
            distance = field.distance[i + rim, j + rim]
            self.assertLessEqual(distance, centres - 0.05 + 1e-5)
            self.assertGreaterEqual(distance, centres - 0.071 - 1e-5)
        empty = sdf.Grid(np.full((5, 5), 0.1), np.ones((5, 5), bool), 0.1)
        self.assertIsNone(sdf.distance_field(empty))
        self.assertIsNone(sdf.describe(empty))

    def test_nonsense_raises(self):
        ones = np.ones((3, 3), bool)
        for arguments in ((np.full((3, 2), 0.5), ones, 0.1), (np.full((3, 3), 1.5), ones, 0.1),
                          (np.full((3, 3), 0.5), ones, 0.0), (np.full((3, 3), np.nan), ones, 0.1),
                          (np.zeros((0, 0)), np.zeros((0, 0), bool), 0.1)):
            with self.assertRaises(ValueError):
                sdf.Grid(*arguments)
        with self.assertRaisesRegex(sdf.Error, "none.pbstream"):
            sdf.read_map(self.file("none.pbstream"))
        with self.assertRaisesRegex(sdf.Error, "use_retrieval"):
            sdf.load_options({"loop_closing.recognition.use_retrieva": False})
        with self.assertRaises(ValueError):
            sdf.describe_map(self.file("a.pbstream"), threads=-1)

    def test_options_change(self):
        options = sdf.load_options({"loop_closing.recognition.use_retrieval": False})
        self.assertIn("use_retrieval = false", str(options))
        self.assertIn("use_retrieval = true", str(sdf.Options()))
        few = sdf.load_options({"loop_closing.place.keypoint.detection_threshold": 0.02})
        grid = self.map.grid((0, 0))
        self.assertLess(len(sdf.describe(grid, options=few)), len(sdf.describe(grid)))

    def test_places_and_pairs(self):
        described = sdf.describe_map(self.file("a.pbstream"), threads=1)
        self.assertEqual(len(described), len(described.ids))
        place = described.place(described.ids[0])
        self.assertEqual(place.positions.shape, (len(place), 2))
        self.assertEqual(place.descriptors.shape, (len(place), 18))
        self.assertEqual(len(place.kinds), len(place))
        self.assertLessEqual(set(place.kinds), {"maximum", "minimum", "saddle"})
        again = sdf.describe(self.map.grid(place.id), place.id)
        np.testing.assert_array_equal(again.descriptors, place.descriptors)
        # A place in itself.
        found = sdf.match(place, sdf.describe(self.map.grid(place.id), (7, 7)))
        self.assertEqual(tuple(found.query), (7, 7))
        self.assertLess(math.hypot(found.T_reference_query.x, found.T_reference_query.y), 0.05)
        self.assertEqual(found.accepted, found.verdict == "accepted")
        self.assertEqual(found.inliers.shape[1], 4)

    def test_the_index_proposes_the_place_itself(self):
        described = sdf.describe_map(self.file("a.pbstream"))
        index = sdf.Index()
        for id in described.ids:
            index.add(described.place(id))
        self.assertEqual(len(index), len(described))
        with self.assertRaises(ValueError):
            index.add(described.place(described.ids[0]))
        id = described.ids[0]
        self.assertNotIn(id, [candidate.id for candidate in index.query(described.place(id))])
        twin = sdf.describe(self.map.grid(id), (7, 7))
        self.assertEqual(index.query(twin)[0].id, id)
        self.assertTrue(index.remove(id))
        self.assertNotIn(id, index)
        self.assertFalse(index.remove(id))

    def test_recognizes_closes_and_scores(self):
        path, output = self.file("a.pbstream"), self.file("closed.pbstream")
        described = sdf.describe_map(path)
        matches = sdf.recognize(described, threads=2)
        score = sdf.score_matches(matches, self.map, self.file("a.csv"))
        self.assertGreater(score["positives"], 0)
        self.assertEqual(score["accepted_wrong"], 0)
        closed = sdf.close_loops(path, output)
        self.assertIn("in_graph", {closure.status for closure in closed.closures})
        before = sdf.node_errors(self.map, self.file("a.csv"))
        after = sdf.node_errors(sdf.read_map(output), self.file("a.csv"))
        self.assertLess(after["mean"], before["mean"])
        # As the program does.
        other = self.file("by_program.pbstream")
        subprocess.run([PROGRAM, "close_loops", path, "-o", other], check=True, capture_output=True)
        self.assertEqual(pathlib.Path(other).read_bytes(), pathlib.Path(output).read_bytes())
        # Between two sessions.
        both = sdf.recognize(described, sdf.describe_map(self.file("b.pbstream")))
        score = sdf.score_matches(both, self.map, self.file("a.csv"),
                                  sdf.read_map(self.file("b.pbstream")), self.file("b.csv"))
        self.assertGreater(score["accepted_right"], 0)
        with self.assertRaises(ValueError):
            sdf.score_matches(both, self.map, self.file("a.csv"), self.map)

    def test_poses(self):
        a, b = sdf.Pose(1, 2, math.pi / 2), sdf.Pose(3, 0, 0.5)
        self.assertEqual(tuple(round(v, 9) for v in a @ b), (1, 5, round(math.pi / 2 + 0.5, 9)))
        np.testing.assert_allclose((a @ a.inverse()).matrix(), np.eye(3), atol=1e-12)
        np.testing.assert_allclose(a.apply([[1, 0], [0, 1]]), [[1, 3], [0, 2]], atol=1e-12)
        self.assertEqual(hash(sdf.SubmapId(1, 2)), hash((1, 2)))
        self.assertEqual(sdf.SubmapId(1, 2), (1, 2))
        self.assertLess(sdf.SubmapId(1, 2), (1, 3))

    def test_the_example_draws(self):
        if importlib.util.find_spec("matplotlib") is None:
            self.skipTest("needs matplotlib")
        picture = self.file("picture.png")
        done = subprocess.run(
            [sys.executable, str(SOURCE / "python/examples/closures_of_a_map.py"),
             self.file("a.pbstream"), picture, self.file("a.csv")],
            capture_output=True, text=True, check=False, env=dict(os.environ, MPLCONFIGDIR=self.file("")))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("recall ", done.stdout)
        self.assertGreater(pathlib.Path(picture).stat().st_size, 10000)

    def test_the_stubs_name_what_is_there(self):
        stubs = ast.parse((SOURCE / "python/cartographer_sdf/__init__.pyi").read_text())
        described = set()
        for node in stubs.body:
            if isinstance(node, ast.FunctionDef):
                described.add(node.name)
                self.assertTrue(callable(getattr(sdf, node.name)), node.name)
            if not isinstance(node, ast.ClassDef) or any(
                    getattr(base, "id", "") == "TypedDict" for base in node.bases):
                continue
            described.add(node.name)
            members = {f.name for f in node.body if isinstance(f, ast.FunctionDef)}
            actual = {name for name, _ in inspect.getmembers(getattr(sdf, node.name))
                      if not name.startswith("_")}
            self.assertEqual({m for m in members if not m.startswith("_")},
                             actual - {name for name, _ in inspect.getmembers(RuntimeError)}
                             if node.name == "Error" else actual, node.name)
        self.assertEqual(described, set(sdf.__all__))


if __name__ == "__main__":
    PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1])
