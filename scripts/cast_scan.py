#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the scan that a lidar would take in a map, for `relocalize --scan`.

usage: cast_scan.py MAP.yaml X Y YAW [--fov DEGREES] [--range METERS]

MAP.yaml and its image (PGM) are a map of ROS, as `export --map_filestem` writes
it; X and Y [m] and YAW [rad] are the pose of the lidar in it. Prints JSON, with
null where a beam leaves what the map knows. To try a place before the robot
stands there: does the map tell it from the others?
"""

import argparse
import json
import math
import pathlib
import re
import sys

NUM_BEAMS_PER_DEGREE = 2


class PlanError(Exception):
    """The map is not as map_server's are."""


def read_map(path):
    """Returns (rows of gray values from the top, resolution, x and y of the
    lower left corner)."""
    text = path.read_text(encoding="utf-8")
    values = dict(re.findall(r"^(\w+):\s*(.+?)\s*$", text, re.MULTILINE))
    try:
        resolution = float(values["resolution"])
        origin = [float(number) for number in values["origin"].strip("[]").split(",")]
        data = (path.parent / values["image"].strip("\"'")).read_bytes()
    except (KeyError, ValueError) as fault:
        raise PlanError(f"{path} is no map of ROS: {fault}") from fault
    header = re.match(rb"P5\s(?:#[^\n]*\n)*(\d+)\s+(\d+)\s+255\s", data)
    if not header:
        raise PlanError(f"the image of {path} is no PGM of 8 bits")
    width, height = map(int, header.groups())
    pixels = data[header.end():]
    rows = [pixels[row * width:(row + 1) * width] for row in range(height)]
    return rows, resolution, origin[0], origin[1]


def cast(world, x, y, direction, max_range):
    """The range to the first dark pixel, infinity if there is none within
    max_range, None where the beam reaches an unknown one."""
    rows, resolution, left, bottom = world
    steps = int(max_range / resolution * 2)
    for step in range(steps):
        distance = step * resolution / 2
        column = math.floor((x + distance * math.cos(direction) - left) / resolution)
        row = len(rows) - 1 - math.floor((y + distance * math.sin(direction) - bottom) / resolution)
        if not (0 <= row < len(rows) and 0 <= column < len(rows[row])):
            return None
        value = rows[row][column]
        if value < 100:
            return distance
        if value < 240:
            return None
    return math.inf


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("map", type=pathlib.Path)
    for name in ("x", "y", "yaw"):
        parser.add_argument(name, type=float)
    parser.add_argument("--fov", type=float, default=270., help="field of view [degrees]")
    parser.add_argument("--range", type=float, default=20., help="range of the lidar [m]")
    arguments = parser.parse_args()
    try:
        world = read_map(arguments.map)
    except (OSError, PlanError) as fault:
        sys.exit(f"cast_scan.py: {fault}")
    count = int(arguments.fov * NUM_BEAMS_PER_DEGREE) + 1
    increment = math.radians(1 / NUM_BEAMS_PER_DEGREE)
    angle_min = -math.radians(arguments.fov) / 2
    ranges = [cast(world, arguments.x, arguments.y, arguments.yaw + angle_min + i * increment, arguments.range)
              for i in range(count)]
    # JSON has no infinity: what is beyond the range met nothing.
    ranges = [arguments.range + 1 if value == math.inf else value for value in ranges]
    json.dump({"angle_min": angle_min, "angle_increment": increment, "range_min": 0.05,
               "range_max": arguments.range, "ranges": ranges}, sys.stdout)
    print()


if __name__ == "__main__":
    main()
