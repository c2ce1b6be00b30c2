#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of the tutorials, as a reader would type them.

usage: run_tutorials.py [PROGRAM, default build/cartographer_sdf] [--keep DIRECTORY]

What stands in blocks of `sh` in docs/tutorials and docs/howto/short_lidar.md is run
in one folder, page by page, in the order in which the pages follow each other.
Stops at the first command that fails. Takes some minutes.
"""

import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parent.parent
PAGES = ("tutorials/folded_map", "tutorials/two_sessions", "tutorials/start_up", "tutorials/fleet", "howto/short_lidar")


def blocks(text):
    """The blocks that a reader types."""
    return re.findall(r"^```sh\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def files(text):
    """(name, content) of configuration files that the text has its reader write."""
    return re.findall(r"say `(\w+\.lua)`:\n\n```lua\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def run_page(page, folder, environment):
    text = (SOURCE / "docs" / f"{page}.md").read_text(encoding="utf-8")
    for name, content in files(text):
        (folder / name).write_text(content, encoding="utf-8")
    for block in blocks(text):
        print(f"--- {page}\n{block}", flush=True)
        subprocess.run(["bash", "-euo", "pipefail", "-c", block], cwd=folder, env=environment, check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("program", nargs="?", type=pathlib.Path, default=SOURCE / "build" / "cartographer_sdf")
    parser.add_argument("--keep", type=pathlib.Path, help="run in this folder, and leave what was made")
    arguments = parser.parse_args()
    environment = dict(os.environ, PATH=f"{arguments.program.resolve().parent}:{os.environ['PATH']}")
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.keep or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        if not (folder / "scripts").exists():
            (folder / "scripts").symlink_to(SOURCE / "scripts")
        try:
            for page in PAGES:
                run_page(page, folder, environment)
        except subprocess.CalledProcessError as fault:
            sys.exit(f"run_tutorials.py: {fault.cmd[-1].strip()}: exit code {fault.returncode}")
    print(f"the commands of {len(PAGES)} pages have run")


if __name__ == "__main__":
    main()
