#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of README.md: docs/images/before.png and after.png.

usage: make_figures.py [PROGRAM, default build/cartographer_sdf]

Simulates a map, closes its loops, and takes the two maps out of the report.
"""

import base64
import pathlib
import re
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parent.parent
PICTURE_PIXELS = 700


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else str(SOURCE / "build" / "cartographer_sdf")
    with tempfile.TemporaryDirectory() as directory:
        work = pathlib.Path(directory)
        (work / "figures.lua").write_text(
            'include "sdf_global_constraints.lua"\n'
            f"SDF_GLOBAL_CONSTRAINTS.report.map_picture_pixels = {PICTURE_PIXELS}\n"
            "return SDF_GLOBAL_CONSTRAINTS\n")
        for arguments in (
                ["simulate", "--output", f"{work}/open_loop.pbstream", "--truth", f"{work}/truth.csv"],
                ["close_loops", "--input", f"{work}/open_loop.pbstream", "--output",
                 f"{work}/closed.pbstream", "--report", f"{work}/report",
                 "--configuration_directory", str(work),
                 "--configuration_basename", "figures.lua"]):
            subprocess.run([program, *arguments], check=True, stdout=subprocess.DEVNULL)
        page = (work / "report" / "index.html").read_text()
    pictures = re.findall(r"data:image/png;base64,([A-Za-z0-9+/=]+)", page)
    images = SOURCE / "docs" / "images"
    images.mkdir(parents=True, exist_ok=True)
    for name, picture in zip(("before", "after"), pictures):
        (images / f"{name}.png").write_bytes(base64.b64decode(picture))
        print(images / f"{name}.png")


if __name__ == "__main__":
    main()
