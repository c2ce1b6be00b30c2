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
import json
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

    def result_of_program(self, *arguments):
        """The JSON of --result, whatever the exit code."""
        done = subprocess.run([PROGRAM, *arguments, "--result", self.file("result.json")],
                              check=False, capture_output=True)
        self.assertIn(done.returncode, (0, 3), done.stderr)
        return json.loads(pathlib.Path(self.file("result.json")).read_text())

    def assert_is_pose(self, pose, members):
        self.assertEqual(tuple(pose), (members["x"], members["y"], members["yaw"]))

    def assert_is_answer(self, found, members):
        """As a pair of `merge` or an answer of `relocalize` in --result."""
        for name in ("verdict", "reason", "probability", "runner_up_probability", "score",
                     "runner_up_score", "agreeing", "contradicting", "compared", "crossed",
                     "changed_area"):
            self.assertEqual(getattr(found, name), members[name], name)
        self.assertEqual(len(found.contradictions) > 0, found.contradicting > 0)
        self.assertEqual(len(found.parts), len(members["parts"]))
        for part, expected in zip(found.parts, members["parts"]):
            self.assertEqual(part.first, tuple(expected["first"].values()))
            self.assertEqual(part.last, tuple(expected["last"].values()))
            self.assert_is_pose(part.placement.T_map_query, expected["T_map_query"])
            self.assertEqual(len(part.placement.votes), expected["matches"])
        self.assertEqual([(tuple(j.before), tuple(j.after), j.distance) for j in found.jumps],
                         [(tuple(j["before"].values()), tuple(j["after"].values()), j["distance"])
                          for j in members["jumps"]])
        self.assertEqual([(c.kind, *c.box, c.wall_area) for c in found.changes],
                         [tuple(c.values()) for c in members["changes"]])

    def test_relocalizes_as_the_program_does(self):
        a, b = self.file("a.pbstream"), self.file("b.pbstream")
        found = sdf.relocalize(a, b, threads=2)
        by_program = self.result_of_program("relocalize", a, b)
        self.assertTrue(found.localized)
        self.assertEqual((found.verdict, found.reason), ("localized", by_program["reason"]))
        self.assert_is_pose(found.T_map_query, by_program["T_map_query"])
        self.assert_is_answer(found, by_program)
        self.assertGreater(found.probability, 0.99)
        self.assert_is_pose(found.parts[0].placement.T_map_query, by_program["T_map_query"])
        self.assertEqual(len(found.placements[0].votes), len(by_program["closures"]))
        self.assertTrue(all(0 <= v < len(found.matches) for v in found.placements[0].votes))
        described = sdf.describe_map(a)
        window = sdf.relocalize(described, b, first_seconds=20, start_seconds=30)
        by_program = self.result_of_program("relocalize", a, b, "--first_seconds", "20",
                                            "--start_seconds", "30")
        self.assertEqual(window.reason, by_program["reason"])
        if window.localized:
            self.assert_is_pose(window.T_map_query, by_program["T_map_query"])
        # Both as one map.
        sdf.relocalize(a, b, self.file("both.pbstream"))
        self.result_of_program("relocalize", a, b, "--output", self.file("both_by_program.pbstream"))
        self.assertEqual(pathlib.Path(self.file("both.pbstream")).read_bytes(),
                         pathlib.Path(self.file("both_by_program.pbstream")).read_bytes())
        for arguments in ({"first_seconds": 0.0}, {"first_seconds": math.nan},
                          {"start_seconds": -1.0}, {"output": a, "first_seconds": 10.0}):
            with self.assertRaises(ValueError):
                sdf.relocalize(a, b, **arguments)
        with self.assertRaises(ValueError):
            sdf.relocalize(described, b, self.file("none.pbstream"))

    def test_names_what_has_changed(self):
        """Rooms of the same plan, without furniture and with it."""
        maps = []
        for density in ("0", "0.14"):
            maps.append(self.file("furniture_%s.pbstream" % density))
            subprocess.run([PROGRAM, "simulate", "--output", maps[-1], "--truth",
                            self.file("t.csv"), "--length", "120", "--plan_width", "30",
                            "--plan_height", "26", "--plan_furniture", density],
                           check=True, capture_output=True)
        found = sdf.relocalize(*maps)
        self.assert_is_answer(found, self.result_of_program("relocalize", *maps))
        self.assertTrue(found.localized)
        kinds = [change.kind for change in found.changes]
        self.assertGreater(kinds.count("appeared"), 2 * kinds.count("vanished"))
        for change in found.changes:
            x_min, y_min, x_max, y_max = change.box
            self.assertLess(x_min, x_max)
            self.assertLess(y_min, y_max)
        self.assertGreater(found.changed_area, 0)

    def write_carried_drive(self, path):
        """A drive in the map, from whose middle on the robot stands where it was at
        the start: scans of a second drive, as if odometry had noticed nothing."""
        drive = sdf.read_drive(self.file("a.pbstream"))
        half = len(drive) // 2
        jumped = drive[:half] + [
            sdf.OdometryScan(scan.time + drive[half].time - drive[0].time,
                             drive[half - 1].T_odometry_robot @
                             drive[0].T_odometry_robot.inverse() @ scan.T_odometry_robot,
                             scan.scans) for scan in drive[:half]]
        scans = [{"time": scan.time,
                  "odometry": dict(zip(("x", "y", "yaw"), scan.T_odometry_robot)),
                  "points": part.returns.tolist()} for scan in jumped for part in scan.scans]
        pathlib.Path(path).write_text(json.dumps(scans))

    def test_follows_a_drive_as_the_program_does(self):
        path, drive_path = self.file("driven.pbstream"), self.file("drive.json")
        sdf.close_loops(self.file("a.pbstream"), path)
        self.write_carried_drive(drive_path)
        by_program = self.result_of_program("relocalize", path, "--scan", drive_path)["scans"][0]
        session = sdf.ScanSession(sdf.PanoramaMap(path))
        self.assertEqual(session.answer.state, "searching")
        answers = [session.add(scan) for scan in sdf.read_drive(drive_path)]
        answer, uses = answers[-1], [answer.use for answer in answers]
        self.assertEqual(answer.state, by_program["state"])
        self.assertEqual((answer.looks, answer.distance_driven, answer.seconds),
                         (by_program["looks"], by_program["meters"], by_program["seconds"]))
        self.assertEqual(answer.state, "located")
        self.assertLessEqual({"compared", "not_moved", "carried_away"}, set(uses))
        # Where it was as it was carried: both halves are the same scans.
        before = answers[len(answers) // 2 - 1].T_map_robot
        self.assertLess(math.dist(tuple(before), tuple(answer.T_map_robot)), 0.2)
        self.assert_is_pose(answer.T_map_robot, by_program["T_map_robot"])
        self.assertEqual(answer.localization.reason, by_program["reason"])
        # Any scan is taken.
        self.assertEqual(session.add(sdf.OdometryScan(-1, sdf.Pose(), [])).use, "time_not_later")
        with self.assertRaisesRegex(sdf.Error, "no odometry"):
            still = self.file("still.json")
            pathlib.Path(still).write_text(json.dumps({"points": [[1, 2]]}))
            sdf.read_drive(still)

    def test_examines_as_info_does(self):
        path = self.file("a.pbstream")
        examined = sdf.examine_map(path, threads=1)
        by_program = self.result_of_program("info", path, "--quality")
        quality = by_program["quality"]
        for walls, members in ((examined.walls, quality["walls"]),
                               (examined.walls_along_trajectories,
                                quality["walls_along_trajectories"])):
            for name, value in members.items():
                self.assertEqual(getattr(walls, name), value, name)
        self.assertGreater(examined.walls.pairs, 0)
        self.assertEqual([tuple(id) for id in examined.broken_links],
                         [tuple(id.values()) for id in quality["broken_links"]])
        self.assertEqual([tuple(id) for id in examined.torn_submaps],
                         [tuple(id.values()) for id in by_program["torn_submaps"]])
        self.assertEqual(examined.slips,
                         {(slip["trajectory"], slip["node"]): slip["angle"]
                          for slip in by_program["slips"]})
        self.assertEqual((examined.self_similar, examined.places, examined.mean_area),
                         (quality["self_similar"], quality["places"], quality["mean_area"]))
        self.assertEqual(examined.submaps, by_program["counts"]["submaps"])
        self.assertEqual(examined.advice, quality["advice"])
        self.assertFalse(examined.is_closed)
        closed = self.file("examined.pbstream")
        sdf.close_loops(path, closed)
        self.assertTrue(sdf.examine_map(closed).is_closed)

    def test_says_what_cartographer_would_do(self):
        path = self.file("a.pbstream")
        trusting = sdf.load_options({
            "loop_closing.closing.optimization.odometry_translation_weight": 1e8,
            "loop_closing.closing.optimization.odometry_rotation_weight": 1e8})
        closed = sdf.close_loops(path, options=trusting)
        self.assertEqual(closed.host_motion.host_weights, (1e8, 1e8))
        self.assertLess(closed.host_motion.map_weights[0], 1e8)
        self.assertGreater(closed.host_motion.max_translation, 0)
        self.assertIsNone(sdf.close_loops(path, self.file("dropped.pbstream"),
                                          drop_odometry=True).host_motion)
        self.assertTrue(all(not match.accepted for match in closed.refused))

    def test_a_refusal_is_an_answer(self):
        a, b, output = self.file("a.pbstream"), self.file("b.pbstream"), self.file("no.pbstream")
        strict = sdf.load_options({"localization.placement.min_score": 1000})
        refused = sdf.relocalize(a, b, options=strict)
        self.assertFalse(refused.localized)
        self.assertIsNone(refused.T_map_query)
        self.assertNotEqual(refused.verdict, "localized")
        self.assertNotEqual(refused.reason, "")
        with self.assertRaisesRegex(sdf.Error, "nothing is written"):
            sdf.relocalize(a, b, output, options=strict)
        merged = sdf.merge([a, b], output, strict)
        self.assertFalse(merged.merged)
        self.assertNotEqual(merged.reason, "")
        self.assertFalse(pathlib.Path(output).exists())

    def test_merges_as_the_program_does(self):
        a, b = self.file("a.pbstream"), self.file("b.pbstream")
        output, other = self.file("merged.pbstream"), self.file("merged_by_program.pbstream")
        merged = sdf.merge([a, b], output, threads=2)
        by_program = self.result_of_program("merge", a, b, "-o", other)
        self.assertTrue(merged.merged)
        self.assertEqual([s.path for s in merged.sessions], [a, b])
        self.assertEqual([s.left_out for s in merged.sessions], ["", ""])
        for session, members in zip(merged.sessions, by_program["sessions"]):
            self.assert_is_pose(session.T_merged_session, members["T_merged_session"])
        link = merged.links[0]
        self.assertEqual((link.first, link.second), (0, 1))
        self.assertTrue(link.localization.localized)
        self.assert_is_answer(link.localization, by_program["pairs"][0])
        self.assertEqual(merged.overlapping_pairs, by_program["overlapping_pairs"])
        self.assertEqual(len(merged.contradictions), by_program["contradicting_pairs"])
        self.assertEqual(pathlib.Path(other).read_bytes(), pathlib.Path(output).read_bytes())
        written = sdf.read_map(output)
        self.assertEqual(written.trajectories, [0, 1])
        self.assertEqual(set(written.submaps), set(merged.submaps))
        with self.assertRaises(ValueError):
            sdf.merge([a])

    def test_audits_as_the_program_does(self):
        path, falsified = self.file("to_audit.pbstream"), self.file("falsified.pbstream")
        sdf.close_loops(self.file("a.pbstream"), path)
        subprocess.run([PROGRAM, "falsify", path, "-o", falsified, "--wrong_constraints",
                        self.file("wrong.csv")],
                       check=True, capture_output=True)
        output, other = self.file("mended.pbstream"), self.file("mended_by_program.pbstream")
        audit = sdf.audit(falsified, output)
        by_program = self.result_of_program("audit", falsified, "-o", other)
        self.assertEqual(audit.doubtful, by_program["counts"]["doubtful"])
        self.assertEqual(audit.doubtful, sum(c.is_doubtful for c in audit.constraints))
        counts = {}
        for constraint in audit.constraints:
            counts[constraint.verdict] = counts.get(constraint.verdict, 0) + 1
        self.assertEqual(counts, by_program["verdicts"])
        constraints = sdf.read_map(falsified).constraints
        self.assertTrue(all(constraints[c.index].is_inter_submap for c in audit.constraints))
        doubtful = [c for c in audit.constraints if c.is_doubtful]
        self.assertGreater(len(doubtful), 0)
        self.assertEqual(audit.refusal, "")
        self.assertGreater(max(c.error_after[0] for c in doubtful), 0)
        self.assertEqual(pathlib.Path(other).read_bytes(), pathlib.Path(output).read_bytes())
        for walls, members in ((audit.walls_before, by_program["walls_before"]),
                               (audit.walls_after, by_program["walls_after"])):
            for name, value in members.items():
                self.assertEqual(getattr(walls, name), value, name)
        self.assertLess(audit.walls_after.contradiction_ratio,
                        audit.walls_before.contradiction_ratio)
        self.assertEqual(audit.dropped, [c.index for c in doubtful])
        # A list in their place.
        chosen = [audit.constraints[0].index, audit.constraints[3].index]
        listed = sdf.audit(falsified, self.file("chosen.pbstream"), drop=chosen)
        self.assertEqual(listed.dropped, sorted(chosen))
        self.assertEqual(listed.doubtful, audit.doubtful)
        self.assertEqual(len(sdf.read_map(self.file("chosen.pbstream")).constraints),
                         len(constraints) - 2)
        with self.assertRaises(ValueError):
            sdf.audit(falsified, drop=[len(constraints)])

    def scan_in(self, filestem, x, y):
        """End points of 360 beams from (x, y) in the map of filestem.yaml."""
        with open(filestem + ".pgm", "rb") as file:
            self.assertEqual(file.readline(), b"P5\n")
            line = file.readline()
            while line.startswith(b"#"):
                line = file.readline()
            width, height = map(int, line.split())
            file.readline()
            pixels = np.frombuffer(file.read(), np.uint8).reshape(height, width)
        members = dict(line.split(":", 1) for line in
                       pathlib.Path(filestem + ".yaml").read_text().splitlines())
        resolution = float(members["resolution"])
        origin = json.loads(members["origin"])
        points = []
        for angle in np.linspace(0, 2 * math.pi, 360, endpoint=False):
            for r in np.arange(0.1, 20, resolution / 4):
                p = (x + r * math.cos(angle), y + r * math.sin(angle))
                column = int((p[0] - origin[0]) / resolution)
                row = height - 1 - int((p[1] - origin[1]) / resolution)
                if not (0 <= column < width and 0 <= row < height):
                    break
                if pixels[row, column] == 0:
                    points.append((p[0] - x, p[1] - y))
                    break
        return np.array(points)

    def test_localizes_scans_as_the_program_does(self):
        path, filestem = self.file("scans.pbstream"), self.file("scans")
        sdf.close_loops(self.file("a.pbstream"), path)
        subprocess.run([PROGRAM, "export", path, "--map_filestem", filestem], check=True,
                       capture_output=True)
        x, y, _ = sdf.read_map(path).node_poses[40]
        points = self.scan_in(filestem, x, y)
        scan_file = self.file("scan.json")
        pathlib.Path(scan_file).write_text(json.dumps({"points": points.tolist()}))
        by_program = self.result_of_program("relocalize", filestem + ".yaml", "--scan",
                                            scan_file)["scans"][0]
        panoramas = sdf.PanoramaMap(filestem + ".yaml")
        found = sdf.localize_scans(panoramas, sdf.read_scans(scan_file))
        self.assertEqual(found.reason, by_program["reason"])
        self.assertEqual(found.localized, by_program["localized"])
        self.assertEqual(len(found.candidates), len(by_program["candidates"]))
        for candidate, members in zip(found.candidates, by_program["candidates"]):
            self.assert_is_pose(candidate.T_map_robot, members["T_map_robot"])
            self.assertEqual(candidate.probability, members["probability"])
            np.testing.assert_array_equal(candidate.covariance, members["covariance"])
            self.assertEqual((candidate.beams, candidate.fit, candidate.at_wall),
                             (members["beams"], members["fit"], members["at_wall"]))
        self.assertAlmostEqual(found.elsewhere_probability +
                               sum(c.probability for c in found.candidates), 1)
        best = found.candidates[0].T_map_robot
        self.assertLess(math.hypot(best.x - x, best.y - y), 0.2)
        self.assertLess(abs(best.yaw), 0.05)
        # The same, turned by the pose of the sensor; and in the map of Cartographer.
        turned = sdf.Pose(0, 0, 1.0)
        scan = sdf.Scan(turned.inverse().apply(points), T_robot_sensor=turned)
        self.assertEqual(scan.returns.shape, (len(points), 2))
        best = sdf.localize_scans(sdf.PanoramaMap(path), [scan]).candidates[0].T_map_robot
        self.assertLess(math.hypot(best.x - x, best.y - y), 0.2)
        self.assertLess(abs(best.yaw), 0.05)
        # Too little of it.
        refused = sdf.localize_scans(panoramas, [sdf.Scan(points[:5])])
        self.assertEqual(refused.verdict, "too_little_seen")
        self.assertIsNone(refused.T_map_robot)
        self.assertIsNone(refused.elsewhere_probability)
        with self.assertRaises(ValueError):
            sdf.localize_scans(panoramas, [])
        with self.assertRaises(ValueError):
            sdf.Scan([[math.inf, 0]])
        with self.assertRaises(sdf.Error):
            sdf.PanoramaMap(sdf.Grid(np.full((9, 9), 0.1), np.ones((9, 9), bool), 0.1))

    def test_an_output_is_checked_before_the_work(self):
        a = self.file("a.pbstream")
        before = pathlib.Path(a).read_bytes()
        for function in (lambda output: sdf.close_loops(a, output),
                         lambda output: sdf.audit(a, output),
                         lambda output: sdf.merge([a, self.file("b.pbstream")], output),
                         lambda output: sdf.relocalize(self.file("b.pbstream"), a, output)):
            for output in (a, self.file("no_such_folder/map.pbstream")):
                with self.assertRaisesRegex(sdf.Error, "map.pbstream|a.pbstream"):
                    function(output)
        self.assertEqual(pathlib.Path(a).read_bytes(), before)

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
