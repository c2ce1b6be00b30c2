#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Draws memory and latencies of a long day of the live searcher.

usage: measure_day.py PROGRAM PICTURE.png [--submaps N] [--seed N] [--csv FILE]
                      [--alone] [--beside NAME=FILE ...]

PROGRAM is measure_day of test/benchmark. With --csv, its table is kept there,
or taken from there if the file exists. With --alone, it runs Cartographer
without the searcher. --beside draws tables that were kept before into the same
picture. Needs matplotlib.
"""

import argparse
import csv
import io
import pathlib
import subprocess
import sys


def rows_of(text):
    rows = [{name: float(value) for name, value in row.items()}
            for row in csv.DictReader(io.StringIO(text))]
    # For each drive: how many of its submaps are described depends on trimmers.
    num_submaps = 0
    for row in rows:
        row["worker_seconds"] = (1e-3 * row["worker_ms_per_submap"]
                                 * (row["submaps"] - num_submaps))
        num_submaps = row["submaps"]
    return rows


def table_of(arguments):
    if arguments.csv and arguments.csv.exists():
        return arguments.csv.read_text()
    command = [arguments.program, str(arguments.submaps), str(arguments.seed)]
    if arguments.alone:
        command.append("alone")
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    # Cartographer shows the progress of its optimisations there, too.
    table = "".join(line + "\n" for line in done.stdout.split("\n")
                    if "," in line and "Optimizing" not in line)
    if arguments.csv:
        arguments.csv.write_text(table)
    return table


def median(values):
    return sorted(values)[len(values) // 2]


def print_summary(rows):
    """The first and the last tenth; what grows differs."""
    tenth = max(1, len(rows) // 10)
    print("column,first_tenth,last_tenth")
    for column in ("places", "resident_mb", "scan_mean_ms", "scan_max_ms", "scan_mean_cpu_ms",
                   "callback_mean_us", "worker_seconds"):
        values = [row[column] for row in rows]
        print(f"{column},{median(values[:tenth]):.4g},{median(values[-tenth:]):.4g}")
    for column in ("hours", "submaps", "trajectories", "closures", "localized", "kidnaps", "deletions",
                   "saves"):
        print(f"{column},,{rows[-1][column]:.0f}")


def draw(runs, path):
    """Each run a colour, its name in the first plot."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(4, 1, sharex=True, figsize=(8, 9))
    for axis, column, label in (
            (axes[0], "resident_mb", "resident memory [MB]"),
            (axes[1], "places", "places in the index"),
            (axes[2], "scan_mean_cpu_ms", "a scan, CPU of the\nsensor thread [ms]"),
            (axes[3], "worker_seconds", "a drive, CPU of\nthe worker [s]")):
        for name, rows in runs.items():
            # The last line is of the end, without scans.
            shown = rows[:-1] if column != "resident_mb" else rows
            axis.plot([row["hours"] for row in shown], [row[column] for row in shown],
                      linewidth=1, label=name)
        axis.set_ylabel(label)
        axis.set_ylim(bottom=0)
        axis.grid(alpha=0.3)
    axes[0].legend()
    axes[-1].set_xlabel("hours of driving")
    figure.tight_layout()
    figure.savefig(path, dpi=100)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("picture", type=pathlib.Path)
    parser.add_argument("--submaps", type=int, default=10000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--csv", type=pathlib.Path)
    parser.add_argument("--alone", action="store_true")
    parser.add_argument("--beside", nargs="*", default=[], metavar="NAME=FILE")
    arguments = parser.parse_args()
    rows = rows_of(table_of(arguments))
    print_summary(rows)
    runs = {"Cartographer alone" if arguments.alone else "with the searcher": rows}
    for beside in arguments.beside:
        name, _, path = beside.partition("=")
        runs[name] = rows_of(pathlib.Path(path).read_text())
    draw(runs, arguments.picture)
    return 0


if __name__ == "__main__":
    sys.exit(main())
