# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""What scripts that measure and report share: where they are, the maps that have
a truth, poses, how they run the program, and by what a report says how it was made."""

import csv
import math
import os
import pathlib
import shlex
import subprocess
import tempfile
import typing

SOURCE_DIR = pathlib.Path(__file__).resolve().parent.parent
DATA_DIR = SOURCE_DIR / ".." / "shared" / "data"
PROGRAM = SOURCE_DIR / "build" / "cartographer_sdf"


class Failure(Exception):
    """A sentence for the user."""


class Set(typing.NamedTuple):
    """A map, or two, with the truth. Joined to the directory of the data, a path
    that is absolute stays as it is."""
    name: str
    map: str
    truth: str
    query: str = ""
    query_truth: str = ""
    relations: str = ""


def within(name, map_name="", relations=""):
    map_name = map_name or name
    return Set(name.split("/")[-1], f"{map_name}.pbstream", f"{name}.truth.csv",
               relations=relations)


def between(first, second):
    short = [name.split("/")[-1] for name in (first, second)]
    return Set(" x ".join(short), f"{first}.pbstream", f"{first}.truth.csv",
               f"{second}.pbstream", f"{second}.truth.csv")


WITHIN = [
    within("intel", "intel_open_loop", "intel.relations"),
    within("aces", "aces_open_loop"),
    within("mit_killian", "mit_killian_open_loop", "mit_killian.relations"),
    *map(within, (
        "willow_1", "willow_2", "fr079", "belgioioso", "fhw_1", "fhw_2",
        "orebro", "freiburg_campus", "tsc_2016", "tsc_2017", "labc_bare1",
        "labc_furn", "labc_d3a", "officeb_bare", "officec_R", "officec_L",
        "field/floor_4", "field/floor_6", "field/twins3_1", "field/twins3_2")),
]
BETWEEN = [between(*names) for names in (
    ("willow_1", "willow_2"), ("fhw_1", "fhw_2"), ("tsc_2016", "tsc_2017"),
    ("labc_bare1", "labc_furn"), ("labc_bare1", "labc_d3a"),
    ("officec_R", "officec_L"), ("officec_L", "officec_R"),
    ("field/floor_4", "field/floor_6"), ("field/twins3_1", "field/twins3_2"))]


def compose(T_a_b, T_b_c):
    """T_a_c; a pose is (x, y, yaw) [m, rad]."""
    c, s = math.cos(T_a_b[2]), math.sin(T_a_b[2])
    return (T_a_b[0] + c * T_b_c[0] - s * T_b_c[1],
            T_a_b[1] + s * T_b_c[0] + c * T_b_c[1], T_a_b[2] + T_b_c[2])


def inverse(T_a_b):
    """T_b_a."""
    c, s = math.cos(T_a_b[2]), math.sin(T_a_b[2])
    return (-c * T_a_b[0] - s * T_a_b[1], s * T_a_b[0] - c * T_a_b[1], -T_a_b[2])


def read_csv(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def run(*arguments):
    """(standard output, CPU seconds) of a command; fails where it does."""
    arguments = [str(argument) for argument in arguments]
    with tempfile.TemporaryFile("w+") as errors:
        child = subprocess.Popen(arguments, text=True, stdout=subprocess.PIPE,
                                 stderr=errors)
        output = child.stdout.read()
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode != 0:
            errors.seek(0)
            raise Failure(f"{shlex.join(arguments)} failed: "
                          f"{errors.read().strip()}")
    return output, usage.ru_utime + usage.ru_stime


def numbers_of(path):
    """{(subject, quantity): number} of a CSV file of `evaluate`."""
    return {(row["subject"], row["quantity"]): float(row["value"])
            for row in read_csv(path)}


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
