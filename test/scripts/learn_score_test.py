#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

"""Tests of scripts/learn_score.py on tables made by hand."""

import contextlib
import io
import math
import pathlib
import sys
import tempfile
import unittest
import xml.etree.ElementTree

try:
    import numpy as np
except ImportError:
    print("skipped: the Debian package python3-numpy is not installed")
    sys.exit(77)

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import learn_score  # noqa: E402

IDS = "reference_trajectory,reference_index,query_trajectory,query_index"


def make_answers(building, cells, query_building=None, terms=("a",)):
    """From (value, number of right, number of wrong answers)."""
    values, right = [], []
    for value, num_right, num_wrong in cells:
        values += [value] * (num_right + num_wrong)
        right += [True] * num_right + [False] * num_wrong
    right = np.array(right, dtype=bool)
    return learn_score.Answers(building, building, query_building or building,
                               list(terms), values, right, ~right, right,
                               int(right.sum()))


class FitTest(unittest.TestCase):
    def test_one_binary_term_is_the_difference_of_log_odds(self):
        # Of 40 answers with a = 0, 10 are right; of 50 with a = 1, 45.
        weights, bias = learn_score.fit_sets(
            [make_answers("x", [(0., 10, 30), (1., 45, 5)])], 1e-12)
        self.assertAlmostEqual(bias, math.log(10 / 30), places=6)
        self.assertAlmostEqual(weights[0], math.log(9.) - math.log(10 / 30),
                               places=6)

    def test_units_of_a_term_do_not_matter(self):
        cells = [(0., 10, 30), (1., 45, 5), (2., 9, 4)]
        weights, bias = learn_score.fit_sets([make_answers("x", cells)], 0.1)
        scaled, scaled_bias = learn_score.fit_sets(
            [make_answers("x", [(1000. * v + 7., r, w) for v, r, w in cells])],
            0.1)
        self.assertAlmostEqual(scaled[0] * 1000., weights[0], places=6)
        self.assertAlmostEqual(scaled_bias + 7. * scaled[0], bias, places=6)

    def test_the_penalty_shrinks_to_where_the_gradient_vanishes(self):
        rng = np.random.default_rng(42)
        terms = rng.normal(size=(500, 3)) * [1., 10., 0.1]
        right = rng.random(500) < learn_score.probability(
            terms @ [1., 0.2, -5.])
        norms = []
        for penalty in (1e-3, 1e-1, 10.):
            weights, bias = learn_score.fit(terms, right, np.ones(500), penalty)
            error = learn_score.probability(terms @ weights + bias) - right
            standard = weights * terms.std(axis=0)
            gradient = (terms - terms.mean(axis=0)).T @ error / 500
            np.testing.assert_allclose(
                gradient / terms.std(axis=0) + penalty * standard, 0., atol=1e-8)
            self.assertAlmostEqual(error.mean(), 0., places=6)
            norms.append(np.linalg.norm(standard))
        self.assertGreater(norms[0], 1.)
        self.assertLess(norms[1], norms[0])
        self.assertLess(norms[2], 0.2)

    def test_separable_answers_and_constant_terms_stay_finite(self):
        answers = make_answers("x", [((0., 5.), 0, 9), ((1., 5.), 9, 0)],
                               terms=("a", "b"))
        weights, bias = learn_score.fit_sets([answers], 1e-4)
        self.assertTrue(np.isfinite(weights).all() and math.isfinite(bias))
        self.assertGreater(weights[0], 1.)
        self.assertEqual(weights[1], 0.)

    def test_buildings_weigh_the_same(self):
        # Whatever the term, a quarter is right in x, three quarters in y.
        x = make_answers("x", [(0., 1, 3), (1., 1, 3)])
        y = make_answers("y", [(0., 300, 100), (1., 300, 100)])
        weights, bias = learn_score.fit_sets([x, y], 1e-9)
        self.assertAlmostEqual(bias, 0., places=6)
        self.assertAlmostEqual(weights[0], 0., places=6)

    def test_near_answers_teach_nothing(self):
        cells = [(0., 10, 30), (1., 45, 5)]
        expected = learn_score.fit_sets([make_answers("x", cells)], 1e-3)
        answers = make_answers("x", [*cells, (7., 20, 0)])
        answers.right[-20:] = False
        found = learn_score.fit_sets([answers], 1e-3)
        self.assertAlmostEqual(found[0][0], expected[0][0], places=9)
        self.assertAlmostEqual(found[1], expected[1], places=9)

    def test_needs_right_and_wrong_answers(self):
        for cells in ([], [(0., 3, 0)], [(0., 0, 3)]):
            with self.assertRaises(learn_score.Failure):
                learn_score.fit_sets([make_answers("x", cells)], 1e-3)


class QualityTest(unittest.TestCase):
    def test_recall_before_the_first_wrong_one(self):
        answers = make_answers("x", [(9., 2, 0), (5., 0, 1), (4., 1, 0)])
        answers.num_positives = 4
        self.assertEqual(learn_score.quality(answers, answers.terms[:, 0]),
                         (0.5, 0.5, 1))

    def test_a_wrong_one_of_the_same_score_comes_first(self):
        answers = make_answers("x", [(2., 2, 1)])
        self.assertEqual(learn_score.quality(answers, answers.terms[:, 0]),
                         (0., 0., 0))

    def test_one_wrong_among_hundred_is_allowed_at_99(self):
        answers = make_answers("x", [(9., 50, 0), (8., 0, 1), (7., 50, 0)])
        at_1, at_99, num_wrong = learn_score.quality(answers,
                                                     answers.terms[:, 0])
        self.assertEqual((at_1, at_99, num_wrong), (0.5, 1., 1))

    def test_calibration(self):
        rows = learn_score.calibration(np.array([0.6, 0.7, 0.999, 1.]),
                                       np.array([True, False, True, True]))
        self.assertEqual([row[:3] for row in rows],
                         [(0.5, 0.8, 2), (0.999, 1., 2)])
        self.assertAlmostEqual(rows[0][3], 0.65)
        self.assertEqual(rows[0][4], 0.5)


class FilesTest(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = pathlib.Path(directory.name)

    def write(self, name, lines):
        path = self.directory / name
        path.write_text("".join(line + "\n" for line in lines),
                        encoding="utf-8")
        return path

    def test_reads_terms_of_any_name_and_their_labels(self):
        terms = self.write("terms.csv", [
            f"{IDS},score,alpha,beta", "0,1,0,5,9,0.5,2", "0,1,0,6,8,0.25,3",
            "0,1,0,2,7,1,1", "0,2,0,9,6,0.125,4"])
        labels = self.write("labels.csv", [
            f"{IDS},overlap,positive,verdict,translation_error,rotation_error",
            "0,2,0,9,0.1,0,near,0.7,0", "0,1,0,5,0.9,1,right,0.1,0",
            "0,1,0,6,0,0,wrong,9,1"])
        answers = learn_score.read_answers("n", "x", "x", terms, labels, 3)
        self.assertEqual(answers.names, ["alpha", "beta"])
        # The pair without a label is left out.
        np.testing.assert_array_equal(answers.terms,
                                      [[0.5, 2.], [0.25, 3.], [0.125, 4.]])
        self.assertEqual(answers.right.tolist(), [True, False, False])
        self.assertEqual(answers.wrong.tolist(), [False, True, False])
        self.assertEqual(answers.to_positive.tolist(), [True, False, False])
        self.assertEqual(answers.group, "x")
        # Of different buildings, every answer is wrong.
        different = learn_score.read_answers("n", "x", "y", terms, None, 0)
        self.assertTrue(different.wrong.all())
        self.assertEqual(len(different.wrong), 4)
        self.assertEqual(different.group, learn_score.DIFFERENT)

    def test_absent_sets_are_skipped_with_a_message(self):
        with contextlib.redirect_stderr(io.StringIO()) as messages:
            sets = list(learn_score.make_answers(
                None, learn_score.REAL_SETS, self.directory))
        self.assertEqual(sets, [])
        self.assertEqual(len(messages.getvalue().splitlines()),
                         len(learn_score.REAL_SETS))

    def test_reads_a_list_of_sets(self):
        path = self.write("sets.csv", [
            "building,map,truth,query_building,query,query_truth",
            "x,a.pbstream,a.csv,,,", "x,a.pbstream,,y,b.pbstream,"])
        self.assertEqual(learn_score.read_set_list(path)[1],
                         ("x", "a.pbstream", "", "y", "b.pbstream", ""))
        with self.assertRaisesRegex(learn_score.Failure, '"truth"'):
            learn_score.read_set_list(self.write("bad.csv", ["building,map"]))


class ReportTest(unittest.TestCase):
    def test_a_building_is_judged_by_the_others(self):
        # In x and y a high value is right; z is the other way round, so that
        # what x and y teach fails on z.
        sets = [make_answers("x", [(0., 1, 99), (5., 99, 1)]),
                make_answers("y", [(0., 1, 99), (5., 99, 1)]),
                make_answers("z", [(0., 90, 10), (5., 10, 90)]),
                make_answers("w in x", [(0., 0, 50)], query_building="w")]
        with tempfile.TemporaryDirectory() as directory:
            plot = pathlib.Path(directory) / "plot.svg"
            text = learn_score.report(sets, 1e-6, plot)
            lines = list(xml.etree.ElementTree.parse(plot).getroot().iter(
                "{http://www.w3.org/2000/svg}polyline"))
        # One for each building, one for strangers, and one for all.
        self.assertEqual(len(lines), 5)
        rows = {line.split(" | ")[0][2:]: line.split(" | ")[1:]
                for line in text.splitlines() if line.startswith("| ")}
        lines = [line for line in text.splitlines() if line.startswith("| z ")]
        # answers, right, wrong, recalls, wrong above 4, right above 4
        self.assertEqual(lines[0], "| z | 200 | 100 | 100 | 0.000 | 0.000 | "
                         "90 | 10 |")
        # Once z takes part, none is that certain any more.
        self.assertTrue(lines[-1].endswith("| 0 |"), lines[-1])
        self.assertIn("w in x", rows)
        self.assertIn("| different buildings | ", text)
        self.assertIn("score_weights = {\n  a = ", text)
        self.assertEqual(learn_score.report(sets, 1e-6), text)

    def test_lua_numbers(self):
        for number, text in ((12.3456, "12.3"), (-91.04, "-91."), (0., "0."),
                             (-1e-9, "0."), (1234.5, "1230."),
                             (0.00123456, "0.00123")):
            self.assertEqual(learn_score.format_lua(number), text)


if __name__ == "__main__":
    unittest.main()
