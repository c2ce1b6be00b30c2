#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

"""Tests of scripts/measure_scan_localization.py.

usage: measure_scan_localization_test.py PROGRAM
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import measure_scan_localization as measure  # noqa: E402
import split_map  # noqa: E402

PROGRAM = None


def result(verdict, *candidates):
    return {"verdict": verdict, "localized": verdict == "localized", "cpu_milliseconds": 10.,
            "candidates": [{"probability": p, "T_map_robot": dict(zip(("x", "y", "yaw"), pose))}
                           for p, pose in candidates]}


class MeasureTest(unittest.TestCase):
    def test_plans_are_symmetric(self):
        for folds in (2, 4):
            plan = measure.draw_plan(folds)
            side = len(plan)
            for turn in range(0, 4, 4 // folds):
                turned = plan
                for _ in range(turn):
                    turned = [[turned[side - 1 - i][j] for i in range(side)] for j in range(side)]
                self.assertEqual(plan, turned)
            free = sum(value == 254 for row in plan for value in row)
            self.assertGreater(free, 30000)

    def test_clouds(self):
        values = [2, 0, -1, 0, 500 << 10 | 20, 1023, 1, 1, 0, 0, 7]
        packed = b"".join(split_map.varint(value) for value in values)
        cloud = split_map.message([(1, 0, 3), (3, 2, packed)])
        for point, expected in zip(measure.decompress(cloud),
                                   ((.02, -.524), (1.023, -1.024), (1.031, 0.))):
            self.assertAlmostEqual(point[0], expected[0])
            self.assertAlmostEqual(point[1], expected[1])

    def test_right_and_wrong(self):
        truth = [(1., 2., 3.1)]
        right, near, wrong = (result("uncertain", (1., pose))["candidates"][0] for pose in (
            (1.3, 2., -3.1), (1.7, 2., 3.1), (1., 2., 0.)))
        self.assertTrue(measure.is_right(right, truth))
        self.assertFalse(measure.is_right(near, truth) or measure.is_wrong(near, truth))
        self.assertTrue(measure.is_wrong(wrong, truth))

    def test_tables(self):
        rows = [
            {"result": result("localized", (.995, (0., 0., 0.))), "right": 0, "wrong": False, "in_map": True},
            {"result": result("localized", (.992, (5., 0., 0.))), "right": None, "wrong": True, "in_map": False},
            {"result": result("nothing_alike", (.1, (5., 0., 0.))), "right": None, "wrong": True, "in_map": False},
            {"result": result("uncertain", (.6, (0., 0., 0.))), "right": 0, "wrong": False, "in_map": True}]
        own = measure.own_table("title", "target", [(measure.FULL[0], rows)])
        self.assertIn("| 4 | 25 % | 1 | 50 % | 50 % | 2 | 50 % | 100 % | 10 |", own[-2])
        reliability = "\n".join(measure.reliability_table([(measure.FULL[0], rows)]))
        self.assertIn("| [0.99, 0.999) | 2 | 0.994 | 0.500 | 2 |", reliability)
        self.assertIn("| [0.5, 0.8) | 1 | 0.600 | 1.000 | 1 |", reliability)

    def test_a_small_run(self):
        """A scan of a symmetric building that the script itself draws, in that building."""
        with tempfile.TemporaryDirectory() as directory:
            output = pathlib.Path(directory) / "out.md"
            subprocess.run([sys.executable, measure.__file__, "--program", PROGRAM, "--data",
                            directory, "--work", directory, "--starts", "2", "--output", output,
                            "four-fold"], check=True, stdout=subprocess.DEVNULL)
            self.assertIn("| four-fold ring | 2 | 0 | 100 % |", output.read_text())


def main():
    global PROGRAM
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    arguments, rest = parser.parse_known_args()
    PROGRAM = arguments.program
    unittest.main(argv=sys.argv[:1] + rest)


if __name__ == "__main__":
    main()
