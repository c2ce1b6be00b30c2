#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

"""Checks what every subcommand writes to --result against the schema.

usage: result_schema_test.py PROGRAM SCHEMA

Skips itself (exit code 77) without jsonschema.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

try:
    import jsonschema
except ImportError:
    print("skipped: needs jsonschema (python3-jsonschema)")
    sys.exit(77)

PROGRAM, SCHEMA = None, None
OFFICE = ("--plan_width", "30", "--plan_height", "26")


class ResultSchemaTest(unittest.TestCase):
    """Each test adds what it ran to `seen`, which the last one looks at."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.seen, cls.counts = {}, set()
        cls.schema = json.loads(pathlib.Path(SCHEMA).read_text(encoding="utf-8"))
        jsonschema.Draft202012Validator.check_schema(cls.schema)
        cls.validator = jsonschema.Draft202012Validator(cls.schema)
        test = cls("test_all")
        for name, seed in (("a", "1"), ("b", "2")):
            test.check("done", 0, "simulate", "--output", cls.file(name + ".pbstream"),
                       "--truth", cls.file(name + ".csv"), "--length", "100", "--seed", seed, *OFFICE)
        test.check("done", 0, "simulate", "--output", cls.file("c.pbstream"), "--truth",
                   cls.file("c.csv"), "--length", "60", "--plan_seed", "7", *OFFICE)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def file(cls, name):
        return str(pathlib.Path(cls.folder.name) / name)

    def check(self, status, exit_code, *arguments):
        result = pathlib.Path(self.file("result.json"))
        result.unlink(missing_ok=True)
        done = subprocess.run([PROGRAM, *arguments, "--result", result], capture_output=True,
                              text=True, check=False)
        self.assertEqual(done.returncode, exit_code, (arguments, done.stderr))
        content = json.loads(result.read_text(encoding="utf-8"))
        errors = [f"{'/'.join(map(str, e.absolute_path))}: {e.message}"
                  for e in self.validator.iter_errors(content)]
        self.assertEqual(errors, [], arguments)
        self.assertEqual(content["status"], status, arguments)
        self.assertEqual(content["exit_code"], exit_code, arguments)
        self.assertEqual(content["command"]["name"], arguments[0])
        self.seen.setdefault(arguments[0], set()).add(status)
        self.counts.update(content["counts"])
        return content

    def test_all(self):
        a, b, c = (self.file(f"{name}.pbstream") for name in "abc")
        closed, matches = self.file("closed.pbstream"), self.file("matches.csv")
        content = self.check("done", 0, "close_loops", a, "-o", closed, "--picture",
                             self.file("a.png"), "--report", self.file("report"), "--closures",
                             self.file("closures.csv"))
        self.assertGreater(content["counts"]["closures"], 0)
        self.assertEqual({output["flag"] for output in content["outputs"]},
                         {"output", "picture", "report", "closures"})
        self.check("nothing", 3, "close_loops", closed, "-o", self.file("again.pbstream"),
                   "--fail_on", "nothing")
        self.check("done", 0, "match", a, "-o", matches)
        self.check("nothing", 0, "match", a, c, "-o", self.file("none.csv"))
        self.check("done", 0, "relocalize", a, b)
        self.check("refused", 0, "relocalize", a, c)
        self.check("refused", 3, "relocalize", a, c, "--fail_on", "refused")
        self.check("refused", 3, "relocalize", a, c, "-o", self.file("x.pbstream"))
        self.check("done", 0, "relocalize", a, b, "--first_seconds", "40", "--num_starts", "2")
        scan = pathlib.Path(self.file("scan.json"))
        scan.write_text(json.dumps({"angle_min": 0., "angle_increment": 0.0175, "range_max": 30.,
                                    "ranges": [0.3 + 0.002 * k for k in range(359)]}))
        content = self.check("refused", 0, "relocalize", a, "--scan", scan)
        self.assertEqual(len(content["scans"]), 1)
        content = self.check("done", 0, "merge", a, b, c, "-o", self.file("merged.pbstream"))
        self.assertEqual([bool(session["left_out"]) for session in content["sessions"]],
                         [False, False, True])
        self.check("refused", 3, "merge", a, c, "-o", self.file("x.pbstream"))
        self.check("done", 0, "audit", closed, "--constraints", self.file("constraints.csv"))
        self.check("nothing", 0, "audit", a)
        self.check("done", 0, "evaluate", a, "--truth", self.file("a.csv"), "--matches", matches,
                   "--csv", self.file("evaluation.csv"), "--labels", self.file("labels.csv"),
                   "--curves", self.file("curves.csv"))
        self.check("done", 0, "figures", a, "-o", self.file("figures"))
        self.check("done", 0, "falsify", closed, "-o", self.file("false.pbstream"),
                   "--wrong_constraints", self.file("wrong.csv"), "--kinds", "random")
        self.check("done", 0, "info", a, "--torn_submaps")
        content = self.check("done", 0, "inspect", a, b, "--submap", "0,0", "--partner", "0,1",
                             "--features", self.file("features.csv"))
        features = pathlib.Path(self.file("features.csv")).read_text().splitlines()
        self.assertEqual(len(features), content["counts"]["features"] + 1)
        self.assertEqual(len(features[0].split(",")), 7 + 18)
        self.check("done", 0, "inspect", a, "--submap", "0,0")
        self.check("done", 0, "export", closed, "--pgm", self.file("a.pgm"), "--png",
                   self.file("a2.png"), "--geojson", self.file("a.geojson"))
        self.check("done", 0, "batch", a, b, "-o", self.file("batch"))
        # What goes wrong.
        self.check("failed", 1, "info", self.file("none.pbstream"))
        self.check("failed", 1, "inspect", a, "--submap", "0,999")
        self.check("failed", 1, "batch", a, self.file("none.pbstream"), "-o", self.file("batch2"))
        self.check("wrong_usage", 2, "merge", a, "-o", self.file("x.pbstream"))
        self.check_seen()
        self.check_tables()

    def check_seen(self):
        general = subprocess.run([PROGRAM, "--help"], capture_output=True, text=True, check=True)
        listed = re.findall(r"^  ([a-z_]+) {2,}", general.stdout.split("Subcommands:")[1], re.M)
        self.assertGreater(len(listed), 9)
        self.assertEqual(set(self.seen) - {"falsify"}, set(listed))
        self.assertEqual(set(self.schema["properties"]["command"]["properties"]["name"]["enum"]),
                         set(self.seen) | {""})

    def check_tables(self):
        """Every column of every table is in the documentation of tables."""
        document = (pathlib.Path(SCHEMA).parent / "command_line.md").read_text(encoding="utf-8")
        section = document.split("## Tables and other files")[1]
        words = set(re.findall(r"\w+", section))
        prefixes = tuple(re.findall(r"(\w+_)\.\.\.", section))
        tables = sorted(pathlib.Path(self.folder.name).rglob("*.csv"))
        self.assertGreater(len(tables), 10)
        for table in tables:
            columns = table.read_text(encoding="utf-8").splitlines()[0].split(",")
            unknown = [column for column in columns
                       if column not in words and not column.startswith(prefixes)
                       and not (table.name == "features.csv" and re.fullmatch(r"d\d+", column))
                       and not (table.name == "summary.csv" and column in self.counts)]
            self.assertEqual(unknown, [], table.name)

    def test_the_schema_can_fail(self):
        content = self.check("done", 0, "info", self.file("a.pbstream"))
        for name in self.schema["required"]:
            self.assertFalse(self.validator.is_valid(
                {key: value for key, value in content.items() if key != name}), name)
        content["records"] = 3
        self.assertFalse(self.validator.is_valid(content))


if __name__ == "__main__":
    PROGRAM, SCHEMA = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1])
