#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Takes the screenshots of reports in the documentation.

usage: shoot_reports.py FOLDER

FOLDER is where run_tutorials.py --keep has run. Needs chromium, chromium-driver
and python3-selenium (scripts/install_dependencies.sh --browser), and python3-pil.
"""

import io
import pathlib
import sys
import tempfile
import time

from PIL import Image
from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

IMAGES = pathlib.Path(__file__).resolve().parent.parent / "docs" / "images"
# Picture, page, size of the window, and which row is chosen, if any.
SHOTS = (
    ("inspector_close_loops.png", "monday_report", (1280, 960), 0),
    ("inspector_merge.png", "merge_report", (1280, 960), None),
    ("inspector_scan.png", "poor_report", (1280, 960), 1),
    ("fleet_summary.png", "night", (1100, 650), None),
)
LOAD_SECONDS = 60


def open_browser(profile):
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
                     "--disable-background-networking", "--disable-component-update", "--disable-sync",
                     "--hide-scrollbars", f"--user-data-dir={profile}"):
        options.add_argument(argument)
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


def set_window(driver, size):
    """Makes the page, not the window around it, of that size."""
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
        "width": size[0], "height": size[1], "deviceScaleFactor": 1, "mobile": False})


def shoot(driver, folder, work, shot):
    picture, page, size, row = shot
    # Readers have another folder than the one in which the tutorials ran.
    text = (folder / page / "index.html").read_text(encoding="utf-8").replace(str(folder), "/srv/maps")
    copy = work / f"{page}.html"
    copy.write_text(text, encoding="utf-8")
    set_window(driver, size)
    driver.get(copy.as_uri())
    if row is not None:
        rows = WebDriverWait(driver, LOAD_SECONDS).until(
            lambda browser: browser.find_elements(By.CSS_SELECTOR, "#rows tbody tr"))
        driver.execute_script("arguments[0].click(); window.scrollTo(0, 0);", rows[row])
    time.sleep(2)  # Until what was chosen is drawn.
    # A palette halves the file, and nobody sees it.
    Image.open(io.BytesIO(driver.get_screenshot_as_png())).convert("RGB").quantize(256).save(
        IMAGES / picture, optimize=True)
    print(IMAGES / picture)


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    folder = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as work:
        driver = open_browser(pathlib.Path(work) / "profile")
        try:
            for shot in SHOTS:
                shoot(driver, folder, pathlib.Path(work), shot)
        finally:
            driver.quit()


if __name__ == "__main__":
    main()
