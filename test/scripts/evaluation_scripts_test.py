#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

"""Tests of scripts/grid_search.py and scripts/evaluation_report.py.

usage: evaluation_scripts_test.py PROGRAM
"""

import argparse
import contextlib
import io
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import evaluation_report  # noqa: E402
import grid_search  # noqa: E402

PROGRAM = None

# Stands in for `cartographer_sdf evaluate`: the recall is larger where the
# configuration has a radius of 1.2 m and 12 angular bins; each call is noted.
FAKE = """#!/usr/bin/env python3
import os, pathlib, sys
flags = dict(zip(sys.argv[2::2], sys.argv[3::2]))
lua = (pathlib.Path(flags["--configuration_directory"]) /
       flags["--configuration_basename"]).read_text()
with open(os.environ["CALLS"], "a") as calls:
    calls.write(lua.replace("\\n", ";") + "\\n")
recall = 0.25 + 0.5 * ("radius_meters = 1.2" in lua or "bins = 12" in lua)
method = flags["--methods"]
with open(flags["--csv"], "w") as csv:
    csv.write("subject,quantity,value\\n")
    csv.write(f"{method} overlap>=0.5,recall_p1,{recall}\\n")
    csv.write(f"{method} overlap>=0.5,ap,0.5\\n")
"""


class GridSearchTest(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = pathlib.Path(directory.name)
        program = self.directory / "program"
        program.write_text(FAKE, encoding="utf-8")
        program.chmod(0o755)
        for name in ("a", "b"):
            (self.directory / f"{name}.pbstream").write_text(name)
            (self.directory / f"{name}.truth.csv").write_text(name)
        # Of each option the first two values.
        grids = grid_search.GRIDS
        self.addCleanup(setattr, grid_search, "GRIDS", grids)
        grid_search.GRIDS = {
            method: [(name, short, values[:2 if keep else 1])
                     for keep, (name, short, values) in zip(
                         (True, False, method == "shape_context", True), grid)]
            for method, grid in grids.items()}
        self.calls = self.directory / "calls"
        os.environ["CALLS"] = str(self.calls)
        self.arguments = argparse.Namespace(
            data=self.directory, tune="a", report_on="b",
            methods="paper,shape_context", pairs=10, seed=1, min_overlap=0.5,
            max_points=0, jobs=2, program=program,
            output=self.directory / "out" / "grid_search.md")

    def num_calls(self):
        return len(self.calls.read_text().splitlines())

    def search(self):
        with contextlib.redirect_stdout(io.StringIO()), \
                contextlib.redirect_stderr(io.StringIO()):
            grid_search.search(self.arguments)
        return self.arguments.output.read_text(encoding="utf-8")

    def test_finds_the_best_and_goes_on_where_it_was(self):
        text = self.search()
        points = sum(len(list(grid_search.points_of(m)))
                     for m in grid_search.GRIDS)
        self.assertEqual(self.num_calls(), points + 4)
        self.assertIn("| 1.2 | 0.0025 | 0.002 | 0.75 | 0.750 |", text)
        self.assertIn("| b | paper | tuned | 0.750 |", text)
        self.assertIn("| b | paper | shipped | 0.250 |", text)
        self.assertIn("| b | shape_context | tuned | 0.750 |", text)
        # Nothing is measured twice; what was lost is, half a line included.
        table = self.arguments.output.with_suffix(".csv")
        lines = table.read_text(encoding="utf-8").splitlines()
        self.search()
        self.assertEqual(self.num_calls(), points + 4)
        table.write_text("\n".join(lines[:-2] + [lines[-1][:20]]),
                         encoding="utf-8")
        self.assertEqual(self.search(), text)
        self.assertEqual(self.num_calls(), points + 6)
        # Of another map nothing is known.
        (self.directory / "b.truth.csv").write_text("other")
        self.search()
        self.assertEqual(self.num_calls(), points + 10)

    def test_draws_points_by_the_seed(self):
        self.arguments.max_points = 3
        self.arguments.methods = "paper"
        self.assertIn("3 of 4 combinations", self.search())
        first = sorted(self.calls.read_text().splitlines())
        self.calls.unlink()
        self.arguments.output.with_suffix(".csv").unlink()
        self.search()
        self.assertEqual(sorted(self.calls.read_text().splitlines()), first)

    def test_tells_what_is_wrong(self):
        self.arguments.methods = "sdf"
        with self.assertRaisesRegex(grid_search.Failure, "no grid .* 'sdf'"):
            self.search()
        self.arguments.methods = "paper"
        self.arguments.tune = "c"
        with self.assertRaisesRegex(grid_search.Failure, "no map c"):
            self.search()
        self.arguments.tune = "a"
        self.arguments.program.write_text("#!/bin/sh\necho broken >&2; exit 1\n")
        with self.assertRaisesRegex(grid_search.Failure, "broken"):
            self.search()

    def test_the_shipped_point_comes_first_and_fits_the_options(self):
        for method in grid_search.GRIDS:
            options = next(grid_search.points_of(method))
            (self.directory / "point.lua").write_text(
                grid_search.configuration(method, options), encoding="utf-8")
            self.directory.joinpath("no_map").touch()
            result = subprocess.run(
                [PROGRAM, "match", "--input", self.directory / "no_map",
                 "--output", "-", "--method", method, "--configuration_directory",
                 self.directory, "--configuration_basename", "point.lua"],
                capture_output=True, text=True, check=False)
            self.assertNotIn("configuration file", result.stderr)
            # It came as far as the map.
            self.assertIn("is not a .pbstream file", result.stderr)
            self.assertEqual(result.returncode, 1)


class EvaluationReportTest(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = pathlib.Path(directory.name)

    def touch(self, *names):
        for name in names:
            (self.directory / name).write_text("")

    def test_finds_maps_with_truth(self):
        self.touch("x.truth.csv", "x.pbstream", "y.truth.csv",
                   "y_open_loop.pbstream", "y_stock.pbstream", "y.relations",
                   "z.truth.csv", "w.pbstream")
        maps = evaluation_report.discover(self.directory)
        self.assertEqual([m.name for m in maps], ["x", "y"])
        self.assertIsNone(maps[0].relations)
        self.assertEqual(maps[1].path.name, "y_open_loop.pbstream")
        self.assertEqual(maps[1].stock.name, "y_stock.pbstream")
        self.assertEqual(maps[1].relations.name, "y.relations")

    def test_reads_a_map_of_the_command_line(self):
        self.touch("m", "t")
        text = f"n={self.directory}/m,{self.directory}/t"
        self.assertEqual(evaluation_report.parse_map(text).name, "n")
        for wrong in ("n", f"={text}", f"{text},x", f"{text},x,y"):
            with self.assertRaises(evaluation_report.Failure):
                evaluation_report.parse_map(wrong)

    def test_reads_options_of_every_method(self):
        options = """SDF_GLOBAL_CONSTRAINTS = {
  loop_closing = {
    match = {
      method = "paper",
      ransac = {
        inlier_distance_meters = 0.3,
      },
      seed = 42,
    },
  },
  report = {
    map_picture_pixels = 1600,
  },
}
"""
        values = evaluation_report.option_values(options)
        self.assertEqual(values["loop_closing.match.seed"], "42")
        self.assertEqual(
            values["loop_closing.match.ransac.inlier_distance_meters"], "0.3")
        self.assertEqual(values["report.map_picture_pixels"], "1600")

    def test_the_page_shows_the_pictures_that_the_repository_keeps(self):
        shown = evaluation_report.SHOWN
        self.assertEqual(
            evaluation_report.pictures(
                pathlib.Path("results") / "evaluation",
                [(shown[0], "one"), ("other.svg", "two"), (shown[1], "three")]),
            [f"![one](evaluation/{shown[0]})", "",
             f"![three](evaluation/{shown[1]})", ""])
        ignored = (evaluation_report.SOURCE_DIR / ".gitignore").read_text(
            encoding="utf-8").splitlines()
        kept = [line.rpartition("/")[2] for line in ignored
                if line.startswith("!/docs/results/evaluation/")]
        self.assertEqual(sorted(kept), sorted(shown))


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    PROGRAM = sys.argv.pop(1)
    unittest.main()
