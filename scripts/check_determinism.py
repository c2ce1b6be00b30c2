#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Closes the loops of maps with several builds of the program, and compares.

usage: check_determinism.py PROGRAM... --maps MAP... [--threads 1,2,8]

Each program must write the same bytes for any number of threads, and all
programs, as of gcc and of clang, the same constraints, with poses that agree to
1e-9 m and rad. Reads maps by the Python module: PYTHONPATH names it.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import cartographer_sdf as sdf

TOLERANCE = 1e-9


def close_loops(program, source, threads, output):
    subprocess.run([program, "close_loops", source, "-o", output, "--threads", str(threads)],
                   check=True, capture_output=True)
    return pathlib.Path(output).read_bytes()


def turned_back(angles):
    return np.abs((angles + np.pi) % (2 * np.pi) - np.pi)


def largest_difference(first, second):
    """Of poses of submaps and nodes [m, rad]; None if something else differs."""
    def constraints_of(world):
        return [(tuple(c.submap), tuple(c.node), c.is_inter_submap) for c in world.constraints]
    if (set(first.submaps) != set(second.submaps) or
            not np.array_equal(first.node_ids, second.node_ids) or
            constraints_of(first) != constraints_of(second)):
        return None
    submaps = [np.array([tuple(world.submaps[id]) for id in first.submaps])
               for world in (first, second)]
    largest = 0.
    for a, b in (submaps, (first.node_poses, second.node_poses)):
        difference = np.abs(a - b)
        difference[:, 2] = turned_back(a[:, 2] - b[:, 2])
        largest = max(largest, difference.max())
    return largest


def check(programs, source, threads, folder):
    """Returns whether all is the same."""
    name = pathlib.Path(source).stem
    is_right = True
    worlds = []
    for k, program in enumerate(programs):
        outputs = [str(folder / f"{k}_{count}.pbstream") for count in threads]
        contents = [close_loops(program, source, count, output)
                    for count, output in zip(threads, outputs)]
        same = all(content == contents[0] for content in contents)
        print(f"{name}: program {k + 1}, threads {threads}: "
              f"{'the same bytes' if same else 'DIFFERENT BYTES'}", flush=True)
        is_right &= same
        worlds.append(sdf.read_map(outputs[0]))
    for k, world in enumerate(worlds[1:], 2):
        difference = largest_difference(worlds[0], world)
        if difference is None:
            print(f"{name}: programs 1 and {k}: DIFFERENT CONSTRAINTS", flush=True)
        else:
            print(f"{name}: programs 1 and {k}: poses differ by {difference:.2g}", flush=True)
        is_right &= difference is not None and difference <= TOLERANCE
    return is_right


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs="+", metavar="PROGRAM")
    parser.add_argument("--maps", nargs="+", required=True)
    parser.add_argument("--threads", default="1,2,8")
    arguments = parser.parse_args()
    threads = [int(count) for count in arguments.threads.split(",")]
    with tempfile.TemporaryDirectory() as name:
        results = [check(arguments.programs, source, threads, pathlib.Path(name))
                   for source in arguments.maps]
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
