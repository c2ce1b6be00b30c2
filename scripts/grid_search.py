#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Searches the major parameters of the paper's method and of its comparison.

Every combination is tried on one map, by recall at precision 1 over random
pairs (`cartographer_sdf evaluate --random_pairs`); the best of each method, and
the shipped parameters, are then tried on the others. Runs as many processes as
there are cores. What was measured is kept in a table beside the report, by
program, map and options: a run that was broken off, or that tries more, goes on
from there.

usage: grid_search.py [--tune willow_1] [--report_on intel,aces,...] ...
"""

import argparse
import concurrent.futures
import csv
import datetime
import hashlib
import itertools
import os
import pathlib
import random
import shlex
import shutil
import subprocess
import sys
import tempfile
import threading

from measuring import (DATA_DIR, PROGRAM, SOURCE_DIR, Failure, check_program,
                       commit_name, read_csv)

# Lua name of each option, its short name, and the values that are tried. The
# shipped one is always among them.
GRIDS = {
    "paper": [
        ("loop_closing.place.descriptor.radius_meters", "radius",
         (0.8, 1.2, 1.6)),
        ("loop_closing.place.keypoint.detection_threshold", "threshold",
         (0.0025, 0.005)),
        ("loop_closing.place.descriptor.distance_weight", "distance weight",
         (0.002, 0.008)),
        ("loop_closing.recognition.match.correspondence.max_ratio", "ratio",
         (0.75, 0.85)),
    ],
    "shape_context": [
        ("shape_context.descriptor.radius_meters", "radius", (2., 3., 4.)),
        ("shape_context.keypoint.detection_threshold", "threshold",
         (0.05, 0.1)),
        ("shape_context.descriptor.num_angular_bins", "angular bins", (6, 12)),
        ("loop_closing.recognition.match.correspondence.max_ratio", "ratio",
         (0.75, 0.85)),
    ],
}
COLUMNS = ["key", "method", "map", "options", "recall_p1", "ap",
           "recall_p1_pose", "ap_pose"]


def points_of(method):
    """All combinations, the shipped one first."""
    names = [name for name, _, _ in GRIDS[method]]
    for values in itertools.product(*(v for _, _, v in GRIDS[method])):
        yield dict(zip(names, values))


def format_options(options):
    return " ".join(f"{name}={value:g}" for name, value in options.items())


def configuration(method, options):
    lines = [f"SDF_GLOBAL_CONSTRAINTS.{name} = {value!r}"
             for name, value in options.items()]
    return "\n".join([f'include "{method}.lua"', *lines,
                      "return SDF_GLOBAL_CONSTRAINTS", ""])


class Table:
    """What was measured, in a file that every result is appended to."""

    def __init__(self, path):
        self.path = path
        self.lock = threading.Lock()
        self.rows = {}
        if path.exists():
            for row in read_csv(path):
                # A run that was broken off may leave half a line.
                if None not in row.values() and set(row) == set(COLUMNS):
                    self.rows[row["key"]] = row
            self.write()

    def write(self):
        temporary = self.path.with_suffix(".tmp")
        with open(temporary, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(self.rows.values())
        os.replace(temporary, self.path)

    def add(self, row):
        with self.lock:
            self.rows[row["key"]] = row
            self.write()


def file_hash(path):
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest() if hasattr(
            hashlib, "file_digest") else hashlib.sha256(file.read()).hexdigest()


class Search:
    def __init__(self, arguments, work, table):
        self.arguments = arguments
        self.work = work
        self.table = table
        self.program = pathlib.Path(shutil.copy2(arguments.program, work))
        self.program_hash = file_hash(self.program)
        self.hashes = {}
        self.num_measured = 0
        for path in (SOURCE_DIR / "configuration_files").glob("*.lua"):
            shutil.copy2(path, work)
        self.shipped = hashlib.sha256(b"".join(
            path.read_bytes() for path in sorted(work.glob("*.lua")))).hexdigest()

    def key(self, method, name, options):
        paths = map_paths(self.arguments.data, name)
        for path in paths:
            if path not in self.hashes:
                self.hashes[path] = file_hash(path)
        text = "\n".join([self.program_hash, self.shipped, method,
                          *(self.hashes[p] for p in paths),
                          format_options(options), str(self.arguments.pairs),
                          str(self.arguments.seed),
                          str(self.arguments.min_overlap)])
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    def measure(self, key, method, name, options):
        map_path, truth_path = map_paths(self.arguments.data, name)
        (self.work / f"{key}.lua").write_text(configuration(method, options),
                                              encoding="utf-8")
        numbers = self.work / f"{key}.csv"
        command = [self.program, "evaluate", "--input", map_path, "--truth",
                   truth_path, "--random_pairs", self.arguments.pairs,
                   "--pair_seed", self.arguments.seed, "--methods", method,
                   "--min_overlaps", self.arguments.min_overlap,
                   "--configuration_directory", self.work,
                   "--configuration_basename", f"{key}.lua", "--threads", 1,
                   "--csv", numbers]
        result = subprocess.run(list(map(str, command)), capture_output=True,
                                text=True, check=False)
        if result.returncode != 0:
            raise Failure(result.stderr.strip() or "evaluate failed")
        values = {row["quantity"]: row["value"] for row in read_csv(numbers)
                  if row["subject"].startswith(f"{method} ")}
        self.table.add({"key": key, "method": method, "map": name,
                        "options": format_options(options),
                        **{c: values.get(c, "") for c in COLUMNS[4:]}})

    def run(self, jobs):
        """`jobs`: (method, map, options). Returns their rows."""
        keys = [self.key(*job) for job in jobs]
        missing = {key: job for key, job in zip(keys, jobs)
                   if key not in self.table.rows}
        with concurrent.futures.ThreadPoolExecutor(self.arguments.jobs) as pool:
            futures = {pool.submit(self.measure, key, *job): job
                       for key, job in missing.items()}
            try:
                for n, future in enumerate(
                        concurrent.futures.as_completed(futures), 1):
                    future.result()
                    method, name, options = futures[future]
                    print(f"{n} of {len(futures)}: {method} on {name}, "
                          f"{format_options(options)}", file=sys.stderr,
                          flush=True)
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise
        self.num_measured += len(missing)
        return [self.table.rows[key] for key in keys]


def map_paths(data, name):
    for stem in (name, f"{name}_open_loop"):
        if (data / f"{stem}.pbstream").exists():
            return data / f"{stem}.pbstream", data / f"{name}.truth.csv"
    raise Failure(f"there is no map {name} in {data}")


def rank(row):
    """Recall first; then what tells equal ones apart."""
    return tuple(float(row[c] or 0.)
                 for c in ("recall_p1", "ap", "recall_p1_pose", "ap_pose"))


def cell(text):
    return f"{float(text):.3f}" if text else "-"


def short_options(method, row):
    values = dict(part.split("=") for part in row["options"].split())
    return [values[name] for name, _, _ in GRIDS[method]]


def report(arguments, tuned, tried, num_points):
    command = shlex.join(["scripts/grid_search.py", *sys.argv[1:]])
    lines = [
        "# Grid search", "",
        f"Made by `{command}` on {datetime.date.today()}, commit {commit_name()}. Recall "
        f"at precision 1 of {arguments.pairs} random pairs (seed "
        f"{arguments.seed}; a match from an overlap of "
        f"{arguments.min_overlap:g} on), by the paper's judgement: the pair, "
        "not the pose. Parameters are chosen on one map by it, ties by average "
        "precision, and then measured on the others; the shipped ones beside.",
        ""]
    for method, rows in tuned.items():
        names = [short for _, short, _ in GRIDS[method]]
        lines += [f"## {method} on {arguments.tune}", "",
                  f"{len(rows)} of {num_points[method]} combinations; the best "
                  "ten, and the shipped one.", "",
                  "| " + " | ".join(names) + " | recall at precision 1 | average "
                  "precision | recall with right poses |",
                  "| --- " * (len(names) + 3) + "|"]
        best = sorted(rows, key=rank, reverse=True)[:10]
        shipped = rows[0]
        for row in best + ([shipped] if shipped not in best else []):
            mark = " (shipped)" if row is shipped else ""
            lines.append("| " + " | ".join(short_options(method, row))
                         + f" | {cell(row['recall_p1'])}{mark} | "
                         f"{cell(row['ap'])} | {cell(row['recall_p1_pose'])} |")
        lines.append("")
    lines += ["## On the other maps", "",
              "| map | method | parameters | recall at precision 1 | average "
              "precision | recall with right poses |", "| --- " * 6 + "|"]
    for which, row in tried:
        lines.append(f"| {row['map']} | {row['method']} | {which} | "
                     f"{cell(row['recall_p1'])} | {cell(row['ap'])} | "
                     f"{cell(row['recall_p1_pose'])} |")
    return "\n".join(lines) + "\n"


def search(arguments):
    output = arguments.output
    output.parent.mkdir(parents=True, exist_ok=True)
    table = Table(output.with_suffix(".csv"))
    methods = [m for m in arguments.methods.split(",") if m]
    for method in methods:
        if method not in GRIDS:
            raise Failure(f"there is no grid for method {method!r}; there are "
                          f"{', '.join(GRIDS)}")
    others = [m for m in arguments.report_on.split(",") if m]
    for name in [arguments.tune, *others]:
        map_paths(arguments.data, name)
    with tempfile.TemporaryDirectory() as directory:
        runner = Search(arguments, pathlib.Path(directory), table)
        tuned, num_points = {}, {}
        for method in methods:
            points = list(points_of(method))
            num_points[method] = len(points)
            # The shipped parameters, and as many others as are wanted.
            others_of = points[1:]
            if arguments.max_points and len(points) > arguments.max_points:
                others_of = random.Random(arguments.seed).sample(
                    others_of, arguments.max_points - 1)
            tuned[method] = runner.run(
                [(method, arguments.tune, p) for p in points[:1] + others_of])
        jobs, names = [], []
        for name in others:
            for method, rows in tuned.items():
                best = max(rows, key=rank)
                for which, row in (("tuned", best), ("shipped", rows[0])):
                    options = {k: float(v) for k, v in (
                        part.split("=") for part in row["options"].split())}
                    for k, value in options.items():
                        if "num_" in k:
                            options[k] = int(value)
                    jobs.append((method, name, options))
                    names.append(which)
        tried = list(zip(names, runner.run(jobs)))
    output.write_text(report(arguments, tuned, tried, num_points),
                      encoding="utf-8")
    print(f"{runner.num_measured} measured: {output}")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--data", type=pathlib.Path,
                        default=DATA_DIR, help="where maps and truths are")
    parser.add_argument("--tune", default="willow_1", help="map to tune on")
    parser.add_argument("--report_on", default="willow_2,aces,intel",
                        help="maps to report on, separated by commas")
    parser.add_argument("--methods", default=",".join(GRIDS))
    parser.add_argument("--pairs", type=int, default=300,
                        help="random pairs of a map")
    parser.add_argument("--seed", type=int, default=42)
    parser.add_argument("--min_overlap", type=float, default=0.5)
    parser.add_argument("--max_points", type=int, default=0,
                        help="combinations of a method, drawn by the seed; "
                        "0: all")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1,
                        help="runs at a time, of one thread each")
    parser.add_argument("--program", type=pathlib.Path,
                        default=PROGRAM)
    parser.add_argument("--output", type=pathlib.Path,
                        default=SOURCE_DIR / "docs" / "results"
                        / "grid_search.md")
    arguments = parser.parse_args()
    if arguments.jobs < 1 or arguments.pairs < 1 or arguments.max_points < 0:
        parser.error("--jobs and --pairs must be positive, --max_points not "
                     "negative")
    try:
        check_program(arguments.program)
        search(arguments)
    except (Failure, OSError, ValueError, KeyError) as failure:
        print(f"grid_search.py: {failure}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
