#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

"""Measures what glass, thin walls, people and the unknown do to recognition.

Simulates the same buildings and drives with one of them at a time, beside the
plain ones, and prints a table of what `match` finds in each (sums over seeds).
"""

import argparse
import collections
import concurrent.futures
import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import typing

SOURCE_DIR = pathlib.Path(__file__).resolve().parent.parent


class Place(typing.NamedTuple):
    name: str
    what: str
    flags: tuple


PLACES = [
    Place("plain", "the building of `simulate`", ()),
    Place("glass", "every room's wall to the corridor is of glass that returns "
          "30 % of the beams", ("--glass_fronts", "1")),
    Place("clear_glass", "the same, of glass that returns 5 %",
          ("--glass_fronts", "1", "--glass_echo", "0.05")),
    Place("thin_walls", "walls are 5 cm thick", ("--plan_wall_thickness", "0.05")),
    Place("table_legs", "of tables only the legs are seen, and there are twice "
          "as many pieces of furniture",
          ("--open_tables", "1", "--plan_furniture", "0.28")),
    Place("closed_tables", "the same furniture, seen whole",
          ("--plan_furniture", "0.28")),
    Place("walking", "10 people walk", ("--walking_people", "10")),
    Place("standing", "60 people stand, each two minutes in a place",
          ("--standing_people", "60")),
    Place("short_range", "the lidar sees 6 m",
          ("--lidar_range", "6")),
    Place("narrow_view", "the lidar sees 120 degrees",
          ("--lidar_field_of_view", "120")),
]


def run(program, arguments):
    """Its standard output; ends this program where it fails."""
    done = subprocess.run([program, *arguments], text=True, check=False,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if done.returncode != 0:
        sys.exit(f"{' '.join(arguments)}: {done.stderr}")
    return done.stdout


def measure(programs, directory, place, seed, configuration):
    """The numbers of one drive, by name."""
    program = programs / "cartographer_sdf"
    directory_of_options, basename = configuration
    options = ["--configuration_directory", directory_of_options,
               "--configuration_basename", basename]
    stem = pathlib.Path(directory) / f"{place.name}_{seed}"
    files = {kind: f"{stem}.{kind}" for kind in
             ("pbstream", "truth.csv", "matches.csv", "score.csv")}
    if not os.path.exists(files["truth.csv"]):
        run(program, ["simulate", "--output", files["pbstream"],
                      "--truth", files["truth.csv"], "--plan_seed", str(seed),
                      "--seed", str(seed), *place.flags])
    run(program, ["match", "--threads", "1", "--input", files["pbstream"],
                  "--output", files["matches.csv"], *options])
    run(program, ["evaluate", "--input", files["pbstream"],
                  "--truth", files["truth.csv"],
                  "--matches", files["matches.csv"],
                  "--csv", files["score.csv"]])
    keypoints = run(programs / "test" / "benchmark" / "measure_keypoints",
                    [files["pbstream"], files["truth.csv"], directory_of_options,
                     basename])
    numbers = {}
    with open(files["score.csv"], newline="", encoding="utf-8") as file:
        lines = [*file, *keypoints.splitlines()[1:]]
    for row in csv.DictReader(lines):
        numbers[row["subject"], row["quantity"]] = float(row["value"])
    with open(files["matches.csv"], newline="", encoding="utf-8") as file:
        numbers["accepted"] = sum(row["verdict"] == "accepted"
                                  for row in csv.DictReader(file))
    return numbers


def mean(values):
    return sum(values) / len(values) if values else float("nan")


def row_of(place, runs):
    def total(*name):
        return sum(run.get(name, 0) for run in runs)

    def share(subject, found, of):
        return f"{total(subject, found) / max(1, total(subject, of)):.2f}"

    kinds = [share(f"keypoints {kind}", "found", "judged")
             for kind in ("maximum", "minimum", "saddle")]
    positives = total("matches", "positives")
    recall = sum(run["matches", "recall_p1"] * run["matches", "positives"]
                 for run in runs) / max(1, positives)
    precise = sum(run["matches", "recall_p99"] * run["matches", "positives"]
                  for run in runs) / max(1, positives)
    return [place.name, str(int(total("keypoints", "features"))),
            *kinds, share("keypoints", "oriented", "found"),
            share("keypoints", "found_by_chance", "judged_by_chance"),
            str(int(positives)), f"{recall:.3f}", f"{precise:.3f}",
            str(int(total("matches", "wrong"))),
            str(sum(run["accepted"] for run in runs)),
            f"{mean([run['matches', 'median_m'] for run in runs if ('matches', 'median_m') in run]):.3f}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=pathlib.Path,
                        default=SOURCE_DIR / "build",
                        help="with benchmarks built")
    parser.add_argument("--seeds", default="1,2,3")
    parser.add_argument("--places", default=",".join(p.name for p in PLACES))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--directory", help="where maps are kept and reused")
    parser.add_argument("--configuration_directory",
                        default=str(SOURCE_DIR / "configuration_files"))
    parser.add_argument("--configuration_basename",
                        default="sdf_global_constraints.lua")
    arguments = parser.parse_args()
    names = arguments.places.split(",")
    unknown = set(names) - {place.name for place in PLACES}
    if unknown:
        parser.error(f"no place is called {' or '.join(sorted(unknown))}")
    places = [place for place in PLACES if place.name in names]
    seeds = [int(seed) for seed in arguments.seeds.split(",")]
    with tempfile.TemporaryDirectory() as temporary, \
            concurrent.futures.ThreadPoolExecutor(arguments.jobs) as executor:
        directory = arguments.directory or temporary
        pathlib.Path(directory).mkdir(parents=True, exist_ok=True)
        futures = collections.OrderedDict(
            ((place, seed), executor.submit(
                measure, arguments.build, directory, place, seed,
                (arguments.configuration_directory,
                 arguments.configuration_basename)))
            for place in places for seed in seeds)
        runs = {key: future.result() for key, future in futures.items()}
    header = ["place", "features", "maxima", "minima", "saddles", "oriented",
              "chance", "positives", "recall_p1", "recall_p99", "wrong",
              "accepted", "median_m"]
    print("| " + " | ".join(header) + " |")
    print("|" + " --- |" * len(header))
    for place in places:
        row = row_of(place, [runs[place, seed] for seed in seeds])
        print("| " + " | ".join(row) + " |")


if __name__ == "__main__":
    main()
