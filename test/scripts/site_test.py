#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

"""Checks the parts of the site that need no generator: links of the Markdown
files, pages that are made from the program and the sources, the link checker,
and the scripts that draw maps and cast scans.

usage: site_test.py PROGRAM SOURCE_DIRECTORY
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCE = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
sys.path[:0] = [str(SOURCE / "scripts" / "site"), str(SOURCE / "scripts")]

import cast_scan  # noqa: E402
import check_links  # noqa: E402
import doxygen_headers  # noqa: E402
import draw_maps  # noqa: E402
import reference  # noqa: E402
import stage  # noqa: E402


class StageTest(unittest.TestCase):
    """The pages of this checkout, without the C++ API."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.pages = pathlib.Path(cls.folder.name)
        cls.site = stage.Site(SOURCE, cls.pages)
        stage.stage_documents(cls.site)
        stage.stage_reference(cls.site, PROGRAM)
        stage.stage_sources(cls.site)
        stage.stage_navigation(cls.site)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def text(self, page):
        return (self.pages / page).read_text(encoding="utf-8")

    def test_no_link_of_a_markdown_file_leads_nowhere(self):
        self.assertEqual(self.site.faults, [])

    def test_every_page_of_the_navigation_exists(self):
        for _, pages in stage.NAVIGATION:
            for page in pages:
                if page != "reference/cpp/index":
                    self.assertTrue((self.pages / f"{page}.md").exists(), page)

    def test_new_pages_are_added_to_the_navigation(self):
        groups = dict(stage.navigation(["index", "install", "new", "howto/new", "results/new"]))
        self.assertEqual(groups["Guides"][-1], "new")
        self.assertEqual(groups["How to"][-1], "howto/new")
        self.assertEqual(groups["Start"], ["install"])
        self.assertEqual(sum(pages.count("results/new") for pages in groups.values()), 0)

    def test_every_subcommand_has_a_page_with_its_flags(self):
        names = [name for name, _ in reference.subcommands(PROGRAM)]
        self.assertIn("close_loops", names)
        for name in names:
            self.assertIn("`--result` string", self.text(f"reference/subcommands/{name}.md"))

    def test_every_option_has_a_default_and_a_comment(self):
        text = self.text("reference/options/sdf_global_constraints.md")
        self.assertIn("`min_unsupported_score` = `7.`\n: Least score of a match that stands alone", text)
        self.assertIn("## localization.placement\n", text)
        self.assertIn("`query_interval_meters` = `0.5`", self.text("reference/options/sdf_live.md"))

    def test_every_folder_of_headers_is_explained(self):
        summaries = stage.folder_summaries((SOURCE / "docs/design/overview.md").read_text(encoding="utf-8"))
        self.assertEqual(summaries["file"], "Text and whole files; logs of robots, scans")
        for folder in self.site.cpp_folders:
            self.assertIn(folder, summaries)

    def test_verdicts_are_named_as_they_are_printed(self):
        text = self.text("reference/verdicts.md")
        for name in ("too_little_overlap", "scans_disagree", "contradicted_by_map", "nothing_alike", "searching"):
            self.assertIn(f"`{name}`\n: ", text)

    def test_python_and_ros(self):
        self.assertIn("def close_loops(", self.text("reference/python.md"))
        self.assertIn("| `scan` | `scan` |", self.text("reference/ros.md"))
        self.assertIn("## cartographer_sdf_msgs/Locate", self.text("reference/ros.md"))


class RewriteTest(unittest.TestCase):
    def setUp(self):
        self.site = stage.Site(SOURCE, pathlib.Path("unused"))

    def rewrite(self, text):
        return self.site.rewrite(text, "docs/design/closing.md", "design/closing.md").rstrip("\n")

    def test_headers_options_and_sources_have_pages(self):
        self.assertEqual(self.rewrite("[a](../../cartographer_sdf/place/place.h)"),
                         "[a](../reference/cpp/place.md#placeh)")
        self.assertEqual(self.rewrite("[a](../../configuration_files/sdf_live.lua)"),
                         "[a](../reference/options/sdf_live.md)")
        self.assertEqual(self.rewrite("[a](../../scripts/demo.sh)"), "[a](../source/scripts/demo.sh.md)")
        self.assertEqual(self.rewrite("[a](../ros.md#x)"), "[a](../ros.md#x)")

    def test_code_and_other_sites_stay(self):
        for text in ("```\n[a](nowhere.md)\n```", "[a](https://example.org/x)", "[a](#here)"):
            self.assertEqual(self.rewrite(text), text)
        self.assertEqual(self.site.faults, [])

    def test_a_link_that_leads_nowhere_is_a_fault(self):
        self.rewrite("[a](nowhere.md)")
        self.assertEqual(self.site.faults, ["docs/design/closing.md: nowhere.md leads nowhere"])


class ReferenceTest(unittest.TestCase):
    def test_lua_tables_and_aliases(self):
        options = reference.LuaOptions(
            "-- About the file.\n\ninclude \"x.lua\"\n-- Of b.\nlocal b = A.b\n-- Of c.\nb.c = 1.\nT = {\n"
            "  -- Of d.\n  d = {\n    -- Of e.\n    e = true,\n  },\n}\nreturn T\n")
        self.assertEqual(options.introduction, ["About the file."])
        self.assertEqual(options.options, [("A.b", "c", "1.", "Of c."), ("T.d", "e", "true", "Of e.")])
        self.assertEqual((options.tables["A.b"], options.tables["T.d"]), ("Of b.", "Of d."))

    def test_lua_that_is_not_understood_is_an_error(self):
        with self.assertRaises(ValueError):
            reference.LuaOptions("for i = 1, 2 do\n")

    def test_comments_become_those_of_doxygen(self):
        text = ["// SPDX-A", "", "// The file.", "", "#ifndef A", "// Above <b>.", "int f();", "int x;  // [m]", "        // more",
                "// Of nothing.", "", "int y;"]
        self.assertEqual(list(doxygen_headers.convert(text)), [
            "#ifndef A", "/// Above \\<b\\>.", "int f();", "int x;  ///< [m]", "        ///< more", "// Of nothing.", "",
            "int y;"])


class CheckLinksTest(unittest.TestCase):
    def check(self, **pages):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in pages.items():
                (pathlib.Path(folder) / f"{name}.html").write_text(text, encoding="utf-8")
            return check_links.check(pathlib.Path(folder))

    def test_good_links(self):
        self.assertEqual(self.check(a='<a href="b.html#x">b</a><a href="https://example.org">e</a>', b='<p id="x">'),
                         ([], 2, 1))

    def test_faults(self):
        for text in ('<a href="c.html">', '<a href="#no">', '<img src="data:," alt="">',
                     '<script src="https://example.org/x.js"></script>'):
            faults, _, _ = self.check(a=text)
            self.assertEqual(len(faults), 1, text)


class MapImageTest(unittest.TestCase):
    """A room of 4 m x 3 m, walls of one cell, cells of 10 cm, corner at (-1, -1)."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        inside = bytes([0]) + bytes([254]) * 38 + bytes([0])
        rows = [bytes(40), *[inside] * 28, bytes(40)]
        folder = pathlib.Path(self.folder.name)
        (folder / "m.pgm").write_bytes(b"P5\n# a comment\n40 30\n255\n" + b"".join(rows))
        self.map = folder / "m.yaml"
        self.map.write_text('image: "m.pgm"\nresolution: 0.1\norigin: [-1., -1., 0.]\n', encoding="utf-8")

    def tearDown(self):
        self.folder.cleanup()

    def test_ranges_end_at_walls(self):
        world = cast_scan.read_map(self.map)
        # The near sides of the walls are at x = 2.9 and y = 1.9.
        self.assertAlmostEqual(cast_scan.cast(world, 0., 0., 0., 20.), 2.9, delta=0.051)
        self.assertAlmostEqual(cast_scan.cast(world, 0., 0., math.pi / 2, 20.), 1.9, delta=0.051)
        self.assertEqual(cast_scan.cast(world, 0., 0., 0., 1.), math.inf)
        self.assertIsNone(cast_scan.cast(world, 9., 0., 0., 1.))

    def test_a_scan_of_the_map_is_found_in_it(self):
        done = subprocess.run([sys.executable, SOURCE / "scripts" / "cast_scan.py", self.map, "0", "0", "0"],
                              capture_output=True, text=True, check=True)
        scan = json.loads(done.stdout)
        self.assertEqual(len(scan["ranges"]), 541)
        self.assertAlmostEqual(scan["ranges"][270], 2.9, delta=0.051)

    def test_pictures_lie_side_by_side_and_keep_walls(self):
        worlds = [self.map, self.map]
        picture = draw_maps.draw(worlds, 0.2)
        self.assertTrue(picture.startswith(b"\x89PNG"))
        rows, _, _, _ = cast_scan.read_map(self.map)
        lines = list(draw_maps.shrink(rows, 0, 0, (20, 15), 2))
        self.assertEqual((len(lines), set(map(len, lines))), (15, {20}))
        self.assertEqual(set(lines[0]), {draw_maps.WALL})
        self.assertEqual(lines[7], bytes([draw_maps.WALL] + [draw_maps.FREE] * 18 + [draw_maps.WALL]))
        # A window that begins outside of the map shows what is unknown there.
        self.assertEqual(next(draw_maps.shrink(rows, -2, 0, (3, 1), 2)), bytes(
            [draw_maps.UNKNOWN, draw_maps.WALL, draw_maps.WALL]))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
