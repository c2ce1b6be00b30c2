# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated maps of places and lidars that few recordings have: halls, ways
outdoors, rooms with little in them, short and sparse lidars."""

import random
import typing

import make_campus
from measuring import Set, run

LENGTH = ("--length", "600")


def hall(seed, side, num_boxes):
    """A square hall with pilasters along its walls and boxes on its floor."""
    generator = random.Random(seed)
    plan = make_campus.Plan(side)
    for x, y, width, height in ((0, 0, side, .3), (0, side - .4, side, .3),
                                (0, 0, .3, side), (side - .4, 0, .3, side)):
        plan.box(x, y, width, height)
    for _ in range(int(side / 3.)):
        along = generator.uniform(0., side - 2.)
        depth, width = generator.uniform(.3, 1.), generator.uniform(.4, 2.)
        x, y, width, height = generator.choice((
            (along, 0., width, depth), (along, side - depth, width, depth),
            (0., along, depth, width), (side - depth, along, depth, width)))
        plan.box(x, y, width, height)
    for _ in range(num_boxes):
        plan.box(generator.uniform(2., side - 4.), generator.uniform(2., side - 4.),
                 generator.uniform(.3, 2.), generator.uniform(.3, 2.))
    return plan


class Place(typing.NamedTuple):
    what: str
    flags: tuple  # of `simulate`
    plan: object = None  # makes one of a seed; the random office if None


PLACES = {
    "wide_hall": Place("a hall of 70 m, 40 boxes, a lidar of 8 m",
                       ("--lidar_range", "8"), lambda seed: hall(seed, 70., 40)),
    "open_hall": Place("a hall of 60 m, 8 boxes, a lidar of 20 m",
                       (), lambda seed: hall(seed, 60., 8)),
    "houses": Place("ways between houses, trees and hedges, a lidar of 20 m",
                    (), make_campus.outdoors),
    "bare_office": Place("an office without furniture",
                         ("--plan_furniture", "0")),
    "short_lidar": Place("an office, a lidar of 8 m and 180 degrees",
                         ("--lidar_range", "8",
                          "--lidar_field_of_view", "180")),
    "sparse_lidar": Place("an office, a lidar of 60 beams with 5 cm of noise",
                          ("--lidar_beams", "60",
                           "--lidar_noise", "0.05")),
}


def simulate(program, directory, name, seed):
    """The set of one place: building and drive both depend on the seed."""
    place = PLACES[name]
    stem = directory / f"{name}_{seed}"
    flags = [*LENGTH, *place.flags, "--seed", seed]
    if place.plan is None:
        flags += ["--plan_seed", seed]
    else:
        place.plan(seed).write(f"{stem}.pgm")
        flags += ["--map", f"{stem}.pgm", "--map_resolution",
                  make_campus.RESOLUTION]
    made = Set(stem.name, f"{stem}.pbstream", f"{stem}.truth.csv")
    run(program, "simulate", "--output", made.map, "--truth", made.truth, *flags)
    return made
