#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

"""Uses the inspector, the page of --report, in a headless Chromium.

usage: inspector_test.py PROGRAM SCHEMA

Makes a report of each kind of small simulated maps, checks the documents in
them against the schema, and opens them. With INSPECTOR_SCREENSHOTS set to a
folder, pictures of them at both widths go there. Skips what needs jsonschema
(Debian's python3-jsonschema), or Chromium, its driver and selenium (chromium,
chromium-driver, python3-selenium), where they are absent; itself (exit code 77)
without any.
"""

import base64
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

try:
    import jsonschema
except ImportError:
    jsonschema = None
try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.actions.action_builder import ActionBuilder
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    webdriver = None

PROGRAM, SCHEMA, FOLDER = None, None, None
REPORTS = ("close_loops", "audit", "merge", "relocalize", "scan")
BROWSER, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
OFFICE = ("--plan_width", "30", "--plan_height", "26")
WIDE, NARROW = 1400, 400
MAX_LOAD_SECONDS = 60.
# WCAG 2.1 (AA), 1.4.3 for texts and 1.4.11 for what is drawn.
MIN_CONTRAST = 4.5
MIN_DRAWN_CONTRAST = 3.


def run(*arguments, exit_code=0):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          check=False)
    if done.returncode != exit_code:
        raise AssertionError(f"{arguments}: {done.returncode} {done.stderr}")
    return done


def luminance(color):
    parts = [int(color[k:k + 2], 16) / 255. for k in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.03928 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one, other):
    light, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


def file(name):
    return pathlib.Path(FOLDER.name) / name


def document_of(report):
    page = (file(report) / "index.html").read_text(encoding="utf-8")
    begin = page.index('id="document">') + len('id="document">')
    return page, begin, page.index("</script>", begin)


def setUpModule():
    global FOLDER
    FOLDER = tempfile.TemporaryDirectory()
    for name, seed in (("a", "1"), ("b", "2")):
        run("simulate", "-o", file(f"{name}.pbstream"), "--truth", file(f"{name}.csv"),
            "--length", "150", "--seed", seed, *OFFICE)
    run("close_loops", file("a.pbstream"), "-o", file("closed.pbstream"), "--report",
        file("close_loops"))
    run("falsify", "--input", file("closed.pbstream"), "--output", file("bad.pbstream"),
        "--wrong_constraints", file("wrong.csv"), "--pairs", "1", "--kinds", "half_turn")
    run("audit", file("bad.pbstream"), "--report", file("audit"))
    run("merge", file("a.pbstream"), file("b.pbstream"), "-o", file("merged.pbstream"),
        "--report", file("merge"))
    run("relocalize", file("a.pbstream"), file("b.pbstream"), "--report", file("relocalize"))
    file("scan.json").write_text(json.dumps(
        {"angle_min": 0., "angle_increment": 0.0175, "range_max": 30.,
         "ranges": [1.5 + 0.004 * k for k in range(359)]}))
    run("relocalize", file("a.pbstream"), "--scan", file("scan.json"), "--report", file("scan"))


def tearDownModule():
    FOLDER.cleanup()


@unittest.skipUnless(jsonschema, "needs jsonschema (python3-jsonschema)")
class DocumentTest(unittest.TestCase):
    def test_documents_follow_the_schema(self):
        schema = json.loads(pathlib.Path(SCHEMA).read_text(encoding="utf-8"))
        jsonschema.Draft202012Validator.check_schema(schema)
        validator = jsonschema.Draft202012Validator(schema)
        for report in REPORTS:
            page, begin, end = document_of(report)
            errors = [f"{'/'.join(map(str, e.absolute_path))}: {e.message[:200]}"
                      for e in validator.iter_errors(json.loads(page[begin:end]))]
            self.assertEqual(errors[:5], [], report)


@unittest.skipUnless(webdriver and BROWSER and DRIVER, "needs Chromium, its driver and selenium "
                     "(chromium, chromium-driver, python3-selenium)")
class InspectorTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        options = webdriver.ChromeOptions()
        options.binary_location = BROWSER
        for argument in ("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic",
                         "--no-first-run", "--disable-background-networking",
                         "--disable-component-update", "--disable-sync",
                         f"--user-data-dir={file('profile')}", "--force-device-scale-factor=1"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        cls.driver = webdriver.Chrome(service=Service(DRIVER), options=options)

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()

    # --- What a reader does. ---

    def park_pointer(self):
        """Elsewhere, the page that loads beneath it could point at a row at any moment."""
        actions = ActionBuilder(self.driver)
        actions.pointer_action.move_to_location(0, 0)
        actions.perform()

    def show(self, report, width=WIDE, height=900, page="index.html"):
        self.park_pointer()
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": width, "height": height, "deviceScaleFactor": 1,
                                     "mobile": width < 600})
        self.driver.get((file(report) / page).as_uri())
        deadline = time.monotonic() + MAX_LOAD_SECONDS
        while not self.script("return document.documentElement.dataset.ready === 'true'"):
            self.assertLess(time.monotonic(), deadline, self.errors())
            time.sleep(0.05)

    def script(self, text, *arguments):
        return self.driver.execute_script(text, *arguments)

    def frame(self):
        """Waits until the map is drawn."""
        self.driver.execute_async_script(
            "const done = arguments[0];"
            "requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 30)))")

    def errors(self):
        return [entry for entry in self.driver.get_log("browser")
                if entry["level"] in ("SEVERE", "WARNING")]

    def find(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def rows(self):
        return self.driver.find_elements(By.CSS_SELECTOR, "#rows tbody tr")

    def click(self, element):
        self.script("arguments[0].scrollIntoView({block: 'center'})", element)
        element.click()
        self.frame()

    def heading(self):
        return self.find("#evidence h3").text

    def picture(self):
        self.frame()
        return self.script("return document.getElementById('map').toDataURL()")

    def set_wipe(self, percent):
        self.script("const wipe = document.getElementById('wipe'); wipe.value = arguments[0];"
                    "wipe.dispatchEvent(new Event('input'))", percent)

    def screenshot(self, name):
        folder = os.environ.get("INSPECTOR_SCREENSHOTS")
        if not folder:
            return
        shot = self.driver.execute_cdp_cmd("Page.captureScreenshot",
                                           {"captureBeyondViewport": False})
        pathlib.Path(folder, f"{name}.png").write_bytes(base64.b64decode(shot["data"]))

    # --- Every kind, at both widths. ---

    def test_every_report_shows_without_an_error(self):
        for report in REPORTS:
            for width in (WIDE, NARROW):
                with self.subTest(report=report, width=width):
                    self.show(report, width)
                    self.frame()
                    self.assertEqual(self.errors(), [])
                    self.assertTrue(self.find("#map").is_displayed())
                    self.assertNotEqual(self.find(".verdict p").text.strip(), "")
                    # Nothing sticks out to the side.
                    self.assertLessEqual(
                        self.script("return document.documentElement.scrollWidth"), width)
                    # The map is drawn.
                    self.assertGreater(self.script(
                        "const c = document.getElementById('map');"
                        "const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;"
                        "let n = 0; for (let i = 3; i < d.length; i += 4) n += d[i] > 0;"
                        "return n / (d.length / 4)"), 0.05)
                    self.screenshot(f"{report}_{width}")

    def test_pictures_and_controls_have_names(self):
        for report in REPORTS:
            self.show(report)
            unnamed = self.script("""
                return [...document.querySelectorAll('img, button, select, input, canvas')]
                  .filter((e) => e.offsetParent !== null && e.getAttribute('aria-hidden') !== 'true')
                  .filter((e) => !((e.getAttribute('alt') || e.getAttribute('aria-label') ||
                                    e.textContent || '').trim() || (e.labels && e.labels.length)))
                  .map((e) => e.outerHTML.slice(0, 200))""")
            self.assertEqual(unnamed, [], report)
            self.assertRegex(self.find("#map").get_attribute("aria-label"), r"\d+ by \d+ m")

    def test_texts_stand_out(self):
        for scheme in ("light", "dark"):
            self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {
                "features": [{"name": "prefers-color-scheme", "value": scheme}]})
            self.show("close_loops")
            self.screenshot(f"close_loops_{scheme}")
            color = {name: self.script(
                "return getComputedStyle(document.documentElement).getPropertyValue(arguments[0])",
                f"--{name}").strip() for name in ("ink", "paper", "soft", "chosen", "faint",
                                                  "accent", "good", "caution", "bad")}
            for text in ("ink", "faint", "accent", "good", "caution", "bad"):
                for ground in ("paper", "soft", "chosen"):
                    self.assertGreaterEqual(contrast(color[text], color[ground]), MIN_CONTRAST,
                                            f"{scheme}: {text} on {ground}")
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})

    def test_what_is_drawn_stands_out(self):
        # Of each key of the legend, the colours that are opaque.
        opaque = """
            return [...document.querySelectorAll('canvas.key')].map((c) => {
              const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
              const colors = new Set();
              for (let i = 0; i < d.length; i += 4) {
                if (d[i + 3] === 255) {
                  colors.add('#' + [d[i], d[i + 1], d[i + 2]].map(
                    (part) => part.toString(16).padStart(2, '0')).join(''));
                }
              }
              return [c.parentElement.textContent, [...colors]];
            })"""
        for report in ("close_loops", "audit", "merge"):
            self.show(report)
            if self.rows():
                self.click(self.rows()[0])
            keys = self.script(opaque)
            self.assertGreater(len(keys), 2, report)
            for words, colors in keys:
                self.assertGreaterEqual(max(contrast(one, other) for one in colors
                                            for other in colors), MIN_DRAWN_CONTRAST, words)
            page, begin, end = document_of(report)
            document = json.loads(page[begin:end])
            for color in [part["color"] for part in document["sessions"] + document["paths"]]:
                self.assertGreaterEqual(contrast(color, "#ffffff"), MIN_DRAWN_CONTRAST)
            # Free space and what was never seen.
            unknown = self.script("return getComputedStyle(document.documentElement)"
                                  ".getPropertyValue('--unknown')").strip()
            self.assertGreaterEqual(contrast(unknown, "#ffffff"), MIN_DRAWN_CONTRAST)

    def test_without_javascript_the_main_things_are_there(self):
        self.driver.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
        try:
            self.driver.get((file("close_loops") / "index.html").as_uri())
            self.assertIn("Loops closed", self.find(".verdict").text)
            maps = self.driver.find_elements(By.CSS_SELECTOR, "#plain-maps img")
            self.assertEqual(len(maps), 2)
            for picture in maps:
                self.assertTrue(picture.is_displayed())
                self.assertGreater(picture.size["width"], 300)
            self.assertIn("SHA-256", self.find("main").text)
            self.assertFalse(self.find("#workbench").is_displayed())
        finally:
            self.driver.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": False})

    # --- The map, the table and the evidence. ---

    def test_a_click_on_a_closure_shows_its_pair(self):
        for width in (WIDE, NARROW):
            with self.subTest(width=width):
                self.show("close_loops", width)
                headings, places = [], []
                for k in (0, 3):
                    row = self.rows()[k]
                    self.click(row)
                    self.assertEqual(row.get_attribute("aria-selected"), "true")
                    names = row.find_elements(By.TAG_NAME, "td")[1].text
                    for name in re.findall(r"\d+,\d+", names):
                        self.assertIn(name, self.heading())
                    self.assertGreater(self.painted("#evidence .overlay"), 1000)
                    headings.append(self.heading())
                    self.click(self.find("#zoom-all"))
                    places.append(self.places())
                self.assertNotEqual(headings[0], headings[1])
                if width == NARROW:
                    self.screenshot("close_loops_evidence_400")
                # The first one again, by its place on the map, or what is as near.
                x, y = places[0][0]
                self.click_on_map(x, y)
                self.assertNotEqual(self.heading(), headings[1])
                self.assertLess(min(math.hypot(x - u, y - v) for u, v in self.places()), 20.)
                self.assertEqual(
                    len(self.driver.find_elements(By.CSS_SELECTOR,
                                                  "#rows tr[aria-selected='true']")), 1)
                self.screenshot(f"close_loops_selected_{width}")
                self.assertEqual(self.errors(), [])

    def places(self):
        """Where the chosen row is on the map, in its pixels."""
        return json.loads(self.script("return document.getElementById('map').dataset.selection"))

    def painted(self, selector):
        return self.script(
            "const c = document.querySelector(arguments[0]);"
            "const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;"
            "let n = 0; for (let i = 3; i < d.length; i += 4) n += d[i] > 0; return n", selector)

    def click_on_map(self, x, y):
        canvas = self.find("#map")
        self.script("arguments[0].scrollIntoView({block: 'center'})", canvas)
        box = self.script("const b = arguments[0].getBoundingClientRect();"
                          "return [b.width, b.height]", canvas)
        ActionChains(self.driver).move_to_element_with_offset(
            canvas, round(x - box[0] / 2), round(y - box[1] / 2)).click().perform()
        self.frame()

    def test_numbers_stand_beside_their_bounds(self):
        self.show("close_loops")
        self.click(self.rows()[0])
        text = self.find("#evidence").text
        self.assertIn("at most 25.0", text)
        self.assertIn("judgement.max_contradiction_ratio", text)

    def test_rows_and_places_point_at_each_other(self):
        self.show("close_loops")
        before = self.picture()
        ActionChains(self.driver).move_to_element(self.rows()[1]).perform()
        self.assertNotEqual(self.picture(), before)
        self.click(self.rows()[0])
        self.click(self.find("#zoom-all"))
        x, y = self.places()[0]
        canvas = self.find("#map")
        size = self.script("return [arguments[0].clientWidth, arguments[0].clientHeight]", canvas)
        ActionChains(self.driver).move_to_element_with_offset(
            canvas, round(x - size[0] / 2), round(y - size[1] / 2)).perform()
        self.frame()
        self.assertEqual(len(self.driver.find_elements(By.CSS_SELECTOR, "#rows tr.pointed")), 1)
        self.assertRegex(self.find("#coordinates").text, r"x -?[\d.]+ m, y -?[\d.]+ m")

    def test_the_divider_parts_before_from_after(self):
        self.show("close_loops")
        pictures = []
        for percent in (0, 50, 100):
            self.set_wipe(percent)
            pictures.append(self.picture())
        self.assertEqual(len(set(pictures)), 3)
        self.click(self.find("#wipe-last"))
        self.assertEqual(self.find("#wipe").get_attribute("value"), "0")
        self.assertEqual(self.picture(), pictures[0])

    def test_what_is_drawn_does_not_depend_on_what_was_drawn_before(self):
        for report in REPORTS:
            with self.subTest(report=report):
                self.show(report)
                first = self.picture()
                self.script("document.getElementById('wipe').dispatchEvent(new Event('input'))")
                self.assertEqual(self.picture(), first)

    def test_layers_are_off_and_can_be_shown(self):
        self.show("close_loops")
        boxes = self.driver.find_elements(By.CSS_SELECTOR, "#layers label")
        closures = [box for box in boxes if "in the graph" in box.text][0]
        self.assertFalse(closures.find_element(By.TAG_NAME, "input").is_selected())
        before = self.picture()
        self.click(closures)
        self.assertNotEqual(self.picture(), before)
        self.screenshot("close_loops_closures")

    def test_filter_and_order(self):
        self.show("close_loops")
        everything = len(self.rows())
        self.assertGreater(everything, 10)
        name = self.rows()[0].find_elements(By.TAG_NAME, "td")[1].text.split()[0]
        self.find("#filter").send_keys(name)
        found = self.rows()
        self.assertLess(len(found), everything)
        for row in found:
            self.assertIn(name, row.text)
        self.assertIn(f"{len(found)} of {everything} rows", self.find("#row-count").text)
        self.find("#filter").clear()
        self.find("#filter").send_keys("nothing of the kind")
        self.assertEqual(self.rows(), [])
        self.script("const f = document.getElementById('filter'); f.value = '';"
                    "f.dispatchEvent(new Event('input'))")
        for direction in ("descending", "ascending"):
            self.click(self.find("#rows thead button"))
            self.assertEqual(
                self.find("#rows thead th[aria-sort]:not([aria-sort='none'])").get_attribute(
                    "aria-sort"), direction)
            values = [float(re.sub("[^0-9.]", "", row.find_elements(By.TAG_NAME, "td")[2].text))
                      for row in self.rows()]
            self.assertEqual(values, sorted(values, reverse=direction == "descending"))

    def test_keys_do_what_the_mouse_does(self):
        self.show("close_loops")
        table = self.find("#table-scroll")
        table.send_keys(Keys.ARROW_DOWN)
        self.frame()
        first = self.heading()
        table.send_keys(Keys.ARROW_DOWN)
        self.frame()
        self.assertNotEqual(self.heading(), first)
        canvas = self.find("#map")
        self.script("arguments[0].focus()", canvas)
        for keys in ("+", Keys.ARROW_LEFT, "0"):
            before = self.picture()
            ActionChains(self.driver).send_keys(keys).perform()
            self.assertNotEqual(self.picture(), before, keys)

    def test_two_thousand_rows(self):
        page, begin, end = document_of("close_loops")
        document = json.loads(page[begin:end])
        rows = document["tables"][0]["rows"]
        document["tables"][0]["rows"] = [rows[k % len(rows)] for k in range(2000)]
        large = json.dumps(document).replace("<", "\\u003c")
        file("large").mkdir()
        (file("large") / "index.html").write_text(page[:begin] + large + page[end:],
                                                       encoding="utf-8")
        self.show("large")
        self.assertEqual(len(self.rows()), 2000)
        seconds = self.script(
            "const filter = document.getElementById('filter'), begin = performance.now();"
            "filter.value = '0'; filter.dispatchEvent(new Event('input'));"
            "return (performance.now() - begin) / 1000")
        self.assertLess(seconds, 5.)
        self.assertEqual(self.errors(), [])

    # --- What single kinds have. ---

    def test_sessions_can_be_hidden(self):
        self.show("merge")
        boxes = self.driver.find_elements(By.CSS_SELECTOR, "#layers label")
        session = [box for box in boxes if "b.pbstream" in box.text][0]
        before = self.picture()
        self.click(session)
        self.assertNotEqual(self.picture(), before)

    def test_candidates_have_a_probability(self):
        self.show("relocalize")
        table = self.find(".table-side").text
        self.assertIn("the answer", table)
        self.assertRegex(table, r"\d %")
        self.assertIn("Candidate 1", self.heading())

    def test_a_list_of_constraints_can_be_saved_and_fed_back(self):
        downloads = file("downloads")
        downloads.mkdir(exist_ok=True)
        self.driver.execute_cdp_cmd("Browser.setDownloadBehavior",
                                    {"behavior": "allow", "downloadPath": str(downloads)})
        self.show("audit")
        self.assertIn("--drop", self.find("#drop-command").text)
        self.click(self.find("#export"))
        saved = downloads / "drop.csv"
        deadline = time.monotonic() + 20.
        while not saved.exists():
            self.assertLess(time.monotonic(), deadline, "nothing was saved")
            time.sleep(0.1)
        lines = saved.read_text().splitlines()
        self.assertEqual(lines[0], "constraint,submap_trajectory,submap_index,node_trajectory,"
                                   "node_index")
        wrong = {line.split(",")[0]
                 for line in file("wrong.csv").read_text().splitlines()[1:]}
        self.assertTrue(wrong <= {line.split(",")[0] for line in lines[1:]})
        done = run("audit", file("bad.pbstream"), "--drop", saved, "-o",
                   file("mended.pbstream"))
        self.assertIn(f"{len(lines) - 1} constraints are dropped", done.stdout)


if __name__ == "__main__":
    PROGRAM, SCHEMA = sys.argv.pop(1), sys.argv.pop(1)
    if not jsonschema and not (webdriver and BROWSER and DRIVER):
        print("skipped: needs jsonschema (python3-jsonschema), or Chromium, its driver and "
              "selenium (chromium, chromium-driver, python3-selenium)")
        sys.exit(77)
    unittest.main(verbosity=2)
