#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

"""Measures relocalize in buildings whose rooms are all alike, and between them.

Simulates hotels, with equal rooms on either side of a corridor, and warehouses
with equal racks. Of each, five sessions: four of a part of it, one of all; and
one session each of two others that are shorter by some rooms and otherwise
the same. Every session is searched for in every other of its building, and in
those of the others. Writes the counts as Markdown.
"""

import argparse
import collections
import concurrent.futures
import itertools
import json
import math
import pathlib
import random
import sys

import make_campus
from measuring import (PROGRAM, Failure, check_program, commit_name, compose,
                       inverse, processor, read_csv, run)

# An answer is wrong if its typical match is farther off [m], [rad].
WRONG_METERS, WRONG_RADIANS = 1., math.radians(10.)
SESSIONS = ((1, 60), (2, 60), (3, 60), (4, 90), (5, 240))  # (seed, metres)
OTHER_SESSION = (1, 160)


class Building(make_campus.Plan):
    """Solid, until rooms are cleared of it."""

    def __init__(self, side):
        super().__init__(side)
        self.box(0., 0., side, side)

    def clear(self, x, y, width, height):
        first, last = (int(at / make_campus.RESOLUTION) for at in (x, x + width))
        for row in self.rows[int(y / make_campus.RESOLUTION):
                             int((y + height) / make_campus.RESOLUTION)]:
            row[first:last] = b"\xff" * (last - first)


def hotel(seed, num_rooms, width, depth, corridor, furniture):
    """Rooms on either side of a corridor along x, walls of 15 cm between. Their
    furniture is the same in all, mirrored on the other side, the same on each
    side ("sides"), or other in each ("varied")."""
    wall = .15
    plan = Building(max(num_rooms * (width + wall), 2. * depth + corridor) + 2.)
    lower = 1. + depth + wall  # side of the corridor
    plan.clear(1., lower, num_rooms * (width + wall) - wall, corridor)
    for room, side in itertools.product(range(num_rooms), (0, 1)):
        x = 1. + room * (width + wall)
        y = (1., lower + corridor + wall)[side]
        plan.clear(x, y, width, depth)
        plan.clear(x + 1., (lower - 2. * wall, lower + corridor - wall)[side],
                   1.1, 3. * wall)
        generator = random.Random(
            {"equal": seed, "sides": 2 * seed + side,
             "varied": f"{seed} {room} {side}"}[furniture])
        for _ in range(4):
            across, along = generator.uniform(.4, 1.6), generator.uniform(.4, 1.6)
            left = generator.uniform(.3, width - across - .3)
            from_window = generator.uniform(.3, depth - along - 1.6)
            plan.box(x + left,
                     (y + from_window, y + depth - from_window - along)[side],
                     across, along)
    return plan


def warehouse(num_columns, num_rows, gap):
    """Racks of 8 m x 1 m, 3 m from the next in their row."""
    plan = Building(max(num_columns * 11. + 3., num_rows * (1. + gap) + gap) + 2.)
    plan.clear(1., 1., num_columns * 11. + 3., num_rows * (1. + gap) + gap)
    for column, row in itertools.product(range(num_columns), range(num_rows)):
        plan.box(4. + column * 11., 1. + gap + row * (1. + gap), 8., 1.)
    return plan


# Each makes a building that is so many rooms, or rows of racks, shorter.
FAMILIES = {
    "hotel, 24 equal rooms of 4 m x 5 m":
        lambda less: hotel(30, 12 - less, 4., 5., 2.2, "equal"),
    "hotel, 20 rooms of 5 m x 5 m, equal on each side":
        lambda less: hotel(31, 10 - less, 5., 5., 2.6, "sides"),
    "hotel, 28 equal rooms of 3.6 m x 6 m":
        lambda less: hotel(32, 14 - less, 3.6, 6., 2., "equal"),
    "hotel, 16 rooms of 6 m x 7 m, equal on each side":
        lambda less: hotel(34, 8 - less, 6., 7., 3., "sides"),
    "hotel, 24 rooms of 4 m x 5 m, other furniture in each":
        lambda less: hotel(33, 12 - less, 4., 5., 2.2, "varied"),
    "warehouse, 4 x 6 racks, ways of 2.4 m":
        lambda less: warehouse(4, 6 - less, 2.4),
    "warehouse, 3 x 10 racks, ways of 3 m":
        lambda less: warehouse(3, 10 - less, 3.),
}


def simulate(program, directory, name, plan, seed, length):
    """The stem of the map of a session, and of its truth."""
    stem = directory / f"{name}_{seed}"
    if not stem.with_suffix(".csv").exists():
        image = directory / f"{name}.pgm"
        plan.write(image)
        run(program, "simulate", "--map", image, "--map_resolution",
            make_campus.RESOLUTION, "--seed", seed, "--length", length, "--output",
            stem.with_suffix(".pbstream"), "--truth", stem.with_suffix(".csv"))
    return stem


def true_poses(stem):
    return {int(row["index"]): tuple(float(row[key]) for key in ("x", "y", "yaw"))
            for row in read_csv(stem.with_suffix(".csv")) if row["kind"] == "submap"}


def is_right(result, reference, query):
    """Whether the median of the matches that agree lies near the truth."""
    poses, errors = (true_poses(reference), true_poses(query)), []
    for match in result["closures"]:
        true = compose(inverse(poses[0][match["reference_index"]]),
                       poses[1][match["query_index"]])
        error = compose(inverse(true), (match["x"], match["y"], match["yaw"]))
        errors.append((math.hypot(error[0], error[1]),
                       abs(math.remainder(error[2], 2. * math.pi))))
    middle = [sorted(values)[len(values) // 2] for values in zip(*errors)]
    return middle[0] <= WRONG_METERS and middle[1] <= WRONG_RADIANS


def answer(program, reference, query, is_same):
    output, _ = run(program, "relocalize", "--threads", 1, "--map",
                    reference.with_suffix(".pbstream"), "--query",
                    query.with_suffix(".pbstream"), "--result", "-")
    result = json.loads(output[output.index("{"):])
    if not result["localized"]:
        return "refused"
    return "right" if is_same and is_right(result, reference, query) else "wrong"


def measure(programs, directory, jobs):
    """{(family, program, whether it is the same building): counts of answers}"""
    counts = collections.defaultdict(collections.Counter)
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for number, (family, make) in enumerate(FAMILIES.items()):
            name = f"family_{number}"
            stems = list(pool.map(
                lambda job: (job[0], simulate(programs["program"], directory, *job)),
                [(name, make(0), *session) for session in SESSIONS] +
                [(f"{name}_less_{less}", make(less), *OTHER_SESSION)
                 for less in (2, 3)]))
            pairs = [(label, a, b) for label in programs
                     for a, b in itertools.permutations(stems, 2)]
            answers = pool.map(
                lambda pair: answer(programs[pair[0]], pair[1][1], pair[2][1],
                                    pair[1][0] == pair[2][0]), pairs)
            for (label, a, b), what in zip(pairs, answers):
                counts[family, label, a[0] == b[0]][what] += 1
            for label in programs:
                print(family, label, dict(counts[family, label, True]),
                      dict(counts[family, label, False]), flush=True)
    return counts


def report(counts, programs):
    yield ("| buildings | same building: pairs | right | wrong | other building: pairs | "
           "wrong |")
    yield "| --- | --- | --- | --- | --- | --- |"

    def cell(family, is_same, what):
        values = [counts[family, label, is_same][what] for label in programs]
        return f"{values[0]} ({values[1]})" if len(values) > 1 else str(values[0])
    for family in FAMILIES:
        pairs = [counts[family, "program", is_same].total() for is_same in (True, False)]
        yield (f"| {family} | {pairs[0]} | {cell(family, True, 'right')} | "
               f"{cell(family, True, 'wrong')} | {pairs[1]} | "
               f"{cell(family, False, 'wrong')} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--program", type=pathlib.Path, default=PROGRAM)
    parser.add_argument("--baseline", type=pathlib.Path,
                        help="another program to ask the same, in brackets")
    parser.add_argument("--work", type=pathlib.Path, required=True,
                        help="directory for the maps; those that are there are not made again")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--output", type=pathlib.Path, required=True,
                        help="the table, as Markdown")
    arguments = parser.parse_args()
    programs = {"program": arguments.program}
    if arguments.baseline:
        programs["baseline"] = arguments.baseline
    for program in programs.values():
        check_program(program)
    arguments.work.mkdir(parents=True, exist_ok=True)
    counts = measure(programs, arguments.work, arguments.jobs)
    lines = [f"Commit {commit_name()}, {processor()}.", "", *report(counts, programs)]
    arguments.output.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit(f"measure_equal_rooms.py: {failure}")
