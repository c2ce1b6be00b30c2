#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Simulates the drives of a campus, for measuring how time and memory grow.

usage: make_campus.py PROGRAM DIRECTORY [--drives N] [--length METRES]

PROGRAM is cartographer_sdf. Writes DIRECTORY/drive_00.pbstream and so on, N
drives in N places that all differ: floors of office buildings of several sizes,
and, as every eighth, ways outdoors between houses, trees and hedges. Drives that
are there already stay. test/benchmark/join_maps makes one map of some of them.
"""

import argparse
import os
import random
import subprocess
import sys

# Width and height of the office floors [m].
FLOORS = [(60, 45), (80, 30), (50, 50), (70, 40), (45, 60)]
OUTDOORS_EVERY = 8
# Of the ways outdoors [m].
OUTDOORS_SIDE = 120.
RESOLUTION = 0.1


class Plan:
    """An image in which walls are dark."""

    def __init__(self, side):
        self.size = int(side / RESOLUTION)
        self.rows = [bytearray(b'\xff' * self.size) for _ in range(self.size)]

    def box(self, x, y, width, height):
        first, last = (max(0, int(at / RESOLUTION)) for at in (x, x + width))
        for row in self.rows[max(0, int(y / RESOLUTION)):
                             int((y + height) / RESOLUTION) + 1]:
            row[first:last + 1] = b'\0' * (min(last + 1, self.size) - first)

    def write(self, path):
        with open(path, 'wb') as file:
            file.write(b'P5\n%d %d\n255\n' % (self.size, self.size))
            file.write(b''.join(self.rows))


def outdoors(seed):
    """Houses in a raster with ways between them; trees and hedges along these."""
    generator = random.Random(seed)
    plan = Plan(OUTDOORS_SIDE)
    side = OUTDOORS_SIDE
    for x, y, width, height in ((0, 0, side, .3), (0, side - .4, side, .3),
                                (0, 0, .3, side), (side - .4, 0, .3, side)):
        plan.box(x, y, width, height)
    pitch = 30.
    for column in range(int(side / pitch)):
        for row in range(int(side / pitch)):
            x, y = pitch * column, pitch * row
            plan.box(x + generator.uniform(6., 10.), y + generator.uniform(6., 10.),
                     generator.uniform(8., 14.), generator.uniform(8., 14.))
            plan.box(x + generator.uniform(4., 6.), y + generator.uniform(6., 12.),
                     .6, generator.uniform(2., 8.))
            for _ in range(6):
                plan.box(x + generator.uniform(2., 28.), y + generator.uniform(2., 28.),
                         .4, .4)
    return plan


def drive_of(number, directory, length):
    """Returns the arguments of simulate for the drive of that number."""
    arguments = ['--length', str(length), '--seed', str(number + 1)]
    if number % OUTDOORS_EVERY == OUTDOORS_EVERY - 1:
        path = os.path.join(directory, f'outdoors_{number:02}.pgm')
        outdoors(number).write(path)
        return arguments + ['--map', path, '--map_resolution', str(RESOLUTION)]
    width, height = FLOORS[number % len(FLOORS)]
    return arguments + ['--plan_seed', str(number + 1), '--plan_width', str(width),
                        '--plan_height', str(height)]


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument('program')
    parser.add_argument('directory')
    parser.add_argument('--drives', type=int, default=20)
    parser.add_argument('--length', type=float, default=1250.)
    options = parser.parse_args()
    os.makedirs(options.directory, exist_ok=True)
    for number in range(options.drives):
        name = os.path.join(options.directory, f'drive_{number:02}')
        if os.path.exists(name + '.pbstream'):
            continue
        status = subprocess.run(
            [options.program, 'simulate', '--output', name + '.part.pbstream',
             '--truth', name + '.truth.csv',
             *drive_of(number, options.directory, options.length)],
            stdout=subprocess.DEVNULL, check=False).returncode
        if status != 0:
            return f'make_campus.py: simulate failed for drive {number}'
        os.rename(name + '.part.pbstream', name + '.pbstream')
    return None


if __name__ == '__main__':
    sys.exit(main())
