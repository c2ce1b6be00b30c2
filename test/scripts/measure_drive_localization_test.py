#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

"""Tests of scripts/measure_drive_localization.py.

usage: measure_drive_localization_test.py PROGRAM
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import measure_drive_localization as measure  # noqa: E402
import measure_scan_localization as scans  # noqa: E402

PROGRAM = None


class FakeMeasurement:
    """A robot that stands at (1, 2, 0), of which the truth knows nothing after 8 s."""

    def right_poses_at(self, _, seconds):
        return [(1., 2., 0.)] if seconds <= 108. else None

    def first_scan_at(self, _, seconds):
        return seconds

    def was_in_map(self, _, seconds):
        return seconds < 104.


def step(seconds, located, x, milliseconds=10.):
    pose = {"x": x, "y": 2., "yaw": 0.}
    return {"seconds": seconds, "meters": .5 * seconds, "T_map_robot": pose if located else None,
            "best_T_map_robot": pose, "best_probability": .9, "cpu_milliseconds": milliseconds,
            "state": "located" if located else "searching"}


def drive(*history):
    return {"start_seconds": 100., "history": list(history), "localized": history[-1]["state"] == "located",
            "cpu_milliseconds": history[-1]["cpu_milliseconds"]}


class MeasureTest(unittest.TestCase):
    def judge(self, *history):
        return measure.judge_drive(FakeMeasurement(), scans.FULL[0], drive(*history))

    def test_the_last_step_in_time_counts(self):
        judged = self.judge(step(0., False, 1.2), step(4., False, 5.), step(7., True, 1.1, 30.))
        self.assertEqual(judged[5.], (False, False, False, 10., 2., False))
        self.assertEqual(judged[10.], (True, False, True, 30., 3.5, False))

    def test_what_was_ever_wrong_stays_so(self):
        judged = self.judge(step(0., True, 9.), step(4., False, 1.), step(7., True, 1.1))
        self.assertTrue(judged[5.][1] and judged[10.][1])
        self.assertFalse(judged[10.][0])

    def test_what_the_truth_does_not_know_does_not_count(self):
        self.assertTrue(self.judge(step(3., True, 1.), step(9., True, 9.))[10.][0])
        self.assertEqual(self.judge(step(9., True, 1.)), {})

    def test_tables(self):
        results = [drive(step(0., True, 1.)), drive(step(0., False, 5.))]
        own = measure.own_table(FakeMeasurement(), [(scans.FULL[0], results)], 5.)
        self.assertIn("| 2 | 50 % | 0 | 50 % | 2 | 50 % | 50 % | 0.0 | 10 |", own[-2])
        certain = measure.certain_table([(scans.FULL[0], results)], "drives")
        self.assertIn("| 2 | 1 | 0.900 | 10 |", certain[-2])

    def test_a_history_counts_from_the_first_scan(self):
        drives = measure.Drives(argparse.Namespace(program="", data="", work="", starts=1))
        drives.query = lambda name: (name, None)
        drives.times_of[scans.FULL[0].query] = [(0., 3), (.7, 4), (1.5, 5)]
        self.assertEqual(drives.first_scan_at(scans.FULL[0], 0.), 0.)
        self.assertEqual(drives.first_scan_at(scans.FULL[0], .2), .7)
        self.assertEqual(drives.first_scan_at(scans.FULL[0], 1.5), 1.5)
        self.assertEqual(drives.node_at(scans.FULL[0], .7), 4)

    def test_a_small_run(self):
        """A drive through a symmetric building that the script itself draws, in that building."""
        with tempfile.TemporaryDirectory() as directory:
            output = pathlib.Path(directory) / "out.md"
            subprocess.run([sys.executable, measure.__file__, "--program", PROGRAM, "--data",
                            directory, "--work", directory, "--starts", "2", "--output", output,
                            "four-fold"], check=True, stdout=subprocess.DEVNULL)
            self.assertIn("| four-fold ring | 2 | 0 |", output.read_text())


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    arguments, rest = parser.parse_known_args()
    PROGRAM = arguments.program
    unittest.main(argv=[sys.argv[0], *rest])
