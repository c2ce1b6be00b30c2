# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""What scripts that measure and report share: where they are, what they read,
and by what a report says how it was made."""

import csv
import os
import pathlib
import subprocess

SOURCE_DIR = pathlib.Path(__file__).resolve().parent.parent
DATA_DIR = SOURCE_DIR / ".." / "shared" / "data"
PROGRAM = SOURCE_DIR / "build" / "cartographer_sdf"


class Failure(Exception):
    """A sentence for the user."""


def read_csv(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def check_program(program):
    """Fails where it is not built."""
    if not os.access(program, os.X_OK):
        raise Failure(f"build first: {program} is missing")


def output_of(*arguments):
    """What a command prints in the checkout; nothing where it fails."""
    result = subprocess.run(arguments, capture_output=True, text=True,
                            check=False, cwd=SOURCE_DIR)
    return result.stdout.strip() if result.returncode == 0 else ""


def commit_name():
    commit = output_of("git", "rev-parse", "--short", "HEAD") or "unknown"
    if output_of("git", "status", "--porcelain", "--untracked-files=no"):
        commit += " with changes"
    return commit


def processor():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            for line in file:
                if line.startswith("model name"):
                    return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return "an unknown processor"
