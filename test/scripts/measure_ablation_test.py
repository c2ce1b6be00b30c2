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
NUMBERS = {"positives": 4, "recall_p1": 0.5, "recall_p99": 0.75,
           "accepted_recall": 0.25, "accepted_wrong": 7, "cpu": 2.}


class MeasureAblationTest(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = pathlib.Path(directory.name)

    def check(self, variant):
        measure_ablation.write_configuration(self.directory, variant)
        measure_ablation.check_configuration(PROGRAM, self.directory, variant)

    def test_every_variant_fits_the_options(self):
        for study in measure_ablation.STUDIES.values():
            for variant in study.variants:
                self.check(variant)
            names = [v.name for v in study.variants]
            self.assertEqual(len(names), len(set(names)))

    def test_variants_share_candidates_unless_retrieval_differs(self):
        variants = measure_ablation.KEYPOINT_VARIANTS
        candidates = measure_ablation.candidates_of(variants)
        for variant in {v.name: v for v in candidates.values()}.values():
            self.check(variant)
        self.assertIs(candidates["no_maxima_matching"], candidates["shipped"])
        self.assertIs(candidates["no_maxima_retrieval"],
                      candidates["no_maxima"])
        self.assertIsNot(candidates["no_maxima"], candidates["shipped"])

    def test_each_set_is_in_one_group(self):
        names = [name for group in measure_ablation.KEYPOINT_SETS.values()
                 for name in group]
        self.assertEqual(sorted(names),
                         sorted({*measure_ablation.RECORDED,
                                 *measure_ablation.simulated_sets.PLACES}))

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
        variants = [v for v in measure_ablation.STAGE_VARIANTS
                    if v.name in ("shipped", "wall_evidence_as_score")]
        text = measure_ablation.report(
            measure_ablation.STUDIES["stages"], variants,
            {"aces": {"shipped": NUMBERS,
                      "wall_evidence_as_score": {**NUMBERS, "cpu": 5.}}}, 2)
        rows = [line for line in text.splitlines()
                if line.startswith("| wall_evidence_as_score | ")]
        self.assertEqual([row.split(" | ")[1].rstrip(" |") for row in rows[1:]],
                         ["0.500", "0.750", "-", "-", "2.500"])
        self.assertIn("| shipped | 7 |", text)

    def test_pools_positives_and_puts_the_worst_set_first(self):
        variants = [v for v in measure_ablation.KEYPOINT_VARIANTS
                    if v.name in ("shipped", "walls_only")]
        few = {**NUMBERS, "positives": 10, "candidate_recall": 1.}
        many = {**few, "positives": 30, "accepted_recall": 0.75}
        text = measure_ablation.report(
            measure_ablation.STUDIES["keypoints"], variants,
            {"open_hall_1": {"shipped": many, "walls_only": many},
             "fhw_1": {"shipped": many,
                       "walls_only": {**few, "accepted_recall": 0.25}}}, 1)
        self.assertIn("| variant | halls | largest loss | largest gain |", text)
        self.assertIn(
            "| walls_only | 0.625 | fhw_1 0.750 to 0.250 | - |", text)
        self.assertLess(text.index("| fhw_1, 30 |"),
                        text.index("| open_hall_1, 30 |"))

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
