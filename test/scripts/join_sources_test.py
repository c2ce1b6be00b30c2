#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Tests what scripts/join_sources.py joins, and that clang's analyser sees into it.

usage: join_sources_test.py
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts" / "join_sources.py"

FIRST = "#include <vector>\n#ifdef FIRST\n#include <map>\n#endif\nint First() { return 1; }\n"
# Reads what no pointer points to unless k is large, which only paths tell.
SECOND = """#include <map>
#include <vector>
#include <vector>
int* Find(int k);
int Second(int k) {
  int* found = nullptr;
  if (k > 3) found = Find(k);
  return *found;
}
"""


class JoinSourcesTest(unittest.TestCase):

    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.build = pathlib.Path(directory.name).resolve()
        self.joined = self.build / "joined"
        self.unity = self.build / "CMakeFiles" / "part.dir" / "Unity" / "unity_0_cxx.cxx"
        self.unity.parent.mkdir(parents=True)
        lines = []
        for name, text in (("first.cc", FIRST), ("second.cc", SECOND)):
            (self.build / name).write_text(text)
            lines.append(f'#include "{self.build / name}"\n')
        self.unity.write_text("".join(lines))
        self.write_commands(self.unity, self.build / "first.cc")

    def write_commands(self, *files):
        (self.build / "compile_commands.json").write_text(json.dumps([
            {"directory": str(self.build), "file": str(file), "command": f"clang++ -std=c++17 -c {file}"}
            for file in files]))

    def join(self):
        subprocess.run([sys.executable, SCRIPT, self.build, self.joined], check=True)
        return self.joined / "part_unity_0_cxx.cc"

    def name(self, text):
        return subprocess.run([sys.executable, SCRIPT, "--name", self.joined], input=text, capture_output=True,
                              text=True, check=True).stdout

    def test_holds_the_sources_and_blanks_what_one_before_has_included(self):
        lines = self.join().read_text().splitlines()
        # What is under a condition may not be included; what a source repeats is its own fault.
        expected = FIRST.splitlines() + SECOND.replace("#include <vector>\n", "\n", 1).splitlines()
        self.assertEqual(expected, lines)

    def test_compiles_the_joined_file_and_leaves_others(self):
        joined = self.join()
        entries = json.loads((self.joined / "compile_commands.json").read_text())
        self.assertEqual([str(joined), str(self.build / "first.cc")], [entry["file"] for entry in entries])
        self.assertEqual([f"clang++ -std=c++17 -c {entry['file']}" for entry in entries],
                         [entry["command"] for entry in entries])

    def test_names_the_places_in_the_sources(self):
        joined = self.join()
        for line, expected in ((1, "first.cc:1"), (5, "first.cc:5"), (6, "second.cc:1"), (14, "second.cc:9")):
            self.assertEqual(f"{self.build}/{expected}:7: warning: x\n", self.name(f"{joined}:{line}:7: warning: x\n"))
        self.assertEqual("elsewhere.cc:3:7: warning: x\n", self.name("elsewhere.cc:3:7: warning: x\n"))

    def test_leaves_all_places_where_nothing_is_joined(self):
        self.write_commands(self.build / "first.cc")
        self.join()
        self.assertEqual("first.cc:3:7: warning: x\n", self.name("first.cc:3:7: warning: x\n"))

    @unittest.skipUnless(shutil.which("clang-tidy"), "needs clang-tidy")
    def test_the_analyser_follows_paths_in_it(self):
        # In the unity file it would say nothing.
        joined = self.join()
        found = subprocess.run(["clang-tidy", "-p", self.joined, "--quiet", "--checks=-*,clang-analyzer-core.*", joined],
                               capture_output=True, text=True, check=False).stdout
        self.assertIn(f"{self.build}/second.cc:8:10: warning: Dereference of null pointer", self.name(found))


if __name__ == "__main__":
    unittest.main()
