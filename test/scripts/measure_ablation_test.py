#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

"""Tests of scripts/measure_ablation.py.

usage: measure_ablation_test.py PROGRAM
"""

import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import measure_ablation  # noqa: E402

PROGRAM = None
IDS = ",".join(measure_ablation.IDS)


class MeasureAblationTest(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = pathlib.Path(directory.name)

    def check(self, variant):
        measure_ablation.write_configuration(self.directory, variant)
        measure_ablation.check_configuration(PROGRAM, self.directory, variant)

    def test_every_variant_fits_the_options(self):
        for variant in measure_ablation.VARIANTS:
            self.check(variant)
        names = [v.name for v in measure_ablation.VARIANTS]
        self.assertEqual(len(names), len(set(names)))

    def test_overrides_that_do_not_fit_are_told(self):
        for overrides in ("place.descriptor.no_such_option = 1",
                          'drop("no such term")', 'keep("hit")'):
            with self.assertRaisesRegex(measure_ablation.Failure, "wrong"):
                self.check(measure_ablation.Variant("wrong", "", overrides))

    def test_refused_matches_are_no_answers(self):
        matches = self.directory / "matches.csv"
        matches.write_text(f"{IDS},verdict\n0,1,0,5,accepted\n"
                           "0,1,0,6,unsupported\n0,1,0,7,unlikely\n"
                           "0,1,0,8,inconsistent\n", encoding="utf-8")
        kept = self.directory / "kept.csv"
        measure_ablation.drop_refused(matches, kept)
        self.assertEqual(kept.read_text(encoding="utf-8").split(),
                         [f"{IDS},verdict", "0,1,0,5,accepted",
                          "0,1,0,7,unlikely"])

    def test_reports_ratios_of_time_and_no_counts_that_do_not_compare(self):
        variants = [v for v in measure_ablation.VARIANTS
                    if v.name in ("shipped", "wall_evidence_as_score")]
        numbers = {"recall_p1": 0.5, "recall_p99": 0.75,
                   "accepted_recall": 0.25, "accepted_wrong": 7, "cpu": 2.}
        text = measure_ablation.report(
            ["aces"], variants,
            {("aces", "shipped"): numbers,
             ("aces", "wall_evidence_as_score"): {**numbers, "cpu": 5.}}, 2)
        rows = [line for line in text.splitlines()
                if line.startswith("| wall_evidence_as_score | ")]
        self.assertEqual([row.split(" | ")[1].rstrip(" |") for row in rows[1:]],
                         ["0.500", "0.750", "-", "-", "2.50"])
        self.assertIn("| shipped | 7 |", text)

    def test_chooses_in_the_order_of_the_table(self):
        self.assertEqual(measure_ablation.choose("x", "c,a", ["a", "b", "c"]),
                         ["a", "c"])
        self.assertEqual(measure_ablation.choose("x", None, ["a"]), ["a"])
        with self.assertRaisesRegex(measure_ablation.Failure, "no x 'd'"):
            measure_ablation.choose("x", "d", ["a"])


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    PROGRAM = sys.argv.pop(1)
    unittest.main()
