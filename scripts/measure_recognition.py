#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

"""Measures `match` and `close_loops` on every map that has a truth.

Runs the program on all sets that the data directory holds and writes one table:
recall at precision 1, what is accepted, what of it is wrong, and the errors of
the closed maps. With --baseline, a second program (of another commit, say) runs
on the same sets in turn, so that both are measured on the same machine. The
maps are no part of the project; see CONTRIBUTING.md.
"""

import argparse
import concurrent.futures
import csv
import itertools
import json
import pathlib
import sys
import tempfile

from measuring import (BETWEEN, DATA_DIR, PROGRAM, WITHIN, Failure, numbers_of,
                       run)

# One map of each building: whatever is accepted between two of them is wrong.
BUILDINGS = (
    "intel_open_loop", "aces_open_loop", "mit_killian_open_loop", "willow_1",
    "fr079", "belgioioso", "fhw_1", "orebro", "freiburg_campus", "tsc_2016",
    "labc_furn", "officeb_bare", "tinyslam_exp1", "field/floor_4",
    "field/hall_office_1", "field/bare_corner", "field/arena_2",
    "field/track_hall_1")
STRANGERS = list(itertools.combinations(BUILDINGS, 2))


def accepted_positives(matches, labels):
    """How many positive pairs are accepted at the right pose."""
    def rows(path):
        with open(path, encoding="utf-8") as file:
            return {tuple(list(row.values())[:4]): row
                    for row in csv.DictReader(file)}
    truth = rows(labels)
    return sum(row["accepted"] == "1" and key in truth and
               truth[key]["positive"] == "1" and truth[key]["verdict"] == "right"
               for key, row in rows(matches).items())


def measure_match(program, data, entry, flags):
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        query = ["--query", data / entry.query] if entry.query else []
        truth = ["--query_truth", data / entry.query_truth] if entry.query else []
        _, seconds = run(program, "match", "--threads", 1, "--input",
                         data / entry.map, *query, "--output",
                         work / "matches.csv", *flags)
        run(program, "evaluate", "--input", data / entry.map, "--truth",
            data / entry.truth, *query, *truth, "--matches",
            work / "matches.csv", "--csv", work / "numbers.csv", "--labels",
            work / "labels.csv")
        numbers = numbers_of(work / "numbers.csv")
        accepted = accepted_positives(work / "matches.csv", work / "labels.csv")
    positives = numbers["matches", "positives"]
    return {"pairs": numbers["matches", "pairs"], "positives": positives,
            "recall_p1": numbers["matches", "recall_p1"],
            "accepted_recall": accepted / positives if positives else 0.,
            "accepted_wrong": numbers["accepted", "wrong"],
            "answers": numbers["matches", "answers"],
            "wrong": numbers["matches", "wrong"], "cpu_seconds": seconds}


def count_submaps(program, path):
    output, _ = run(program, "info", path, "--result", "-")
    return json.loads(output[output.index("{"):])["counts"]["submaps"]


def measure_strangers(program, data, names, flags):
    num_pairs = 1
    for name in names:
        num_pairs *= count_submaps(program, data / f"{name}.pbstream")
    with tempfile.TemporaryDirectory() as work:
        path = pathlib.Path(work) / "matches.csv"
        _, seconds = run(program, "match", "--threads", 1, "--input",
                         data / f"{names[0]}.pbstream", "--query",
                         data / f"{names[1]}.pbstream", "--output", path, *flags)
        with open(path, encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    return {"pairs": num_pairs, "answers": len(rows),
            "accepted": sum(row["accepted"] in ("1", "true") for row in rows),
            "highest_score": max((float(row["score"]) for row in rows),
                                 default=float("nan")),
            "cpu_seconds": seconds}


def measure_close_loops(program, data, entry):
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        _, seconds = run(program, "close_loops", "--threads", 1, "--input",
                         data / entry.map, "--output", work / "closed.pbstream",
                         "--closures", work / "closures.csv")
        relations = (["--relations", data / entry.relations]
                     if entry.relations else [])
        result = {"cpu_seconds": seconds}
        for name, path in (("before", data / entry.map),
                           ("after", work / "closed.pbstream")):
            run(program, "evaluate", "--input", path, "--truth",
                data / entry.truth, *relations, "--csv", work / "numbers.csv")
            numbers = numbers_of(work / "numbers.csv")
            result[f"nodes_{name}"] = numbers.get(("nodes", "mean_m"))
            if relations:
                result[f"loops_{name}"] = numbers[("loop relations", "mean_m")]
        run(program, "evaluate", "--input", data / entry.map, "--truth",
            data / entry.truth, "--matches", work / "closures.csv", "--csv",
            work / "numbers.csv")
        numbers = numbers_of(work / "numbers.csv")
        result["closures"] = sum(1 for _ in open(work / "closures.csv",
                                                 encoding="utf-8")) - 1
        result["wrong"] = numbers["accepted", "wrong"]
    return result


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--program", type=pathlib.Path,
                        default=PROGRAM)
    parser.add_argument("--baseline", type=pathlib.Path,
                        help="another program to run on the same sets")
    parser.add_argument("--data", type=pathlib.Path, default=DATA_DIR)
    parser.add_argument("--jobs", type=int, default=1,
                        help="sets that are measured at once")
    parser.add_argument("--only", default="",
                        help="names of sets, separated by commas")
    parser.add_argument("--skip", default="",
                        help="of match, close_loops and strangers, by commas")
    parser.add_argument("--flags", default="", help="further flags of match")
    parser.add_argument("--output", type=pathlib.Path, required=True,
                        help="the JSON file for all numbers")
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    if not arguments.data.is_dir():
        sys.exit(f"measure_recognition.py: no maps at {arguments.data}")
    only = [name for name in arguments.only.split(",") if name]
    skip = arguments.skip.split(",")
    programs = {"program": arguments.program}
    if arguments.baseline:
        programs["baseline"] = arguments.baseline
    flags = arguments.flags.split()
    tasks = []
    for entry in WITHIN + BETWEEN:
        if only and entry.name not in only:
            continue
        if not (arguments.data / entry.map).exists():
            continue
        for label, program in programs.items():
            if "match" not in skip:
                tasks.append((("match", entry.name, label), measure_match,
                              (program, arguments.data, entry, flags)))
            if "close_loops" not in skip and not entry.query:
                tasks.append((("close_loops", entry.name, label),
                              measure_close_loops,
                              (program, arguments.data, entry)))
    if "strangers" not in skip and not only:
        for names in STRANGERS:
            if not all((arguments.data / f"{name}.pbstream").exists()
                       for name in names):
                continue
            for label, program in programs.items():
                tasks.append((("strangers", " x ".join(names), label),
                              measure_strangers,
                              (program, arguments.data, names, flags)))
    results = {}
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        futures = [(key, pool.submit(function, *values))
                   for key, function, values in tasks]
        for key, future in futures:
            results.setdefault(key[0], {}).setdefault(key[1], {})[key[2]] = (
                future.result())
            print(*key, {name: round(value, 4) if value is not None else None
                         for name, value in future.result().items()},
                  flush=True)
            arguments.output.write_text(json.dumps(results, indent=1) + "\n",
                                        encoding="utf-8")


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit(f"measure_recognition.py: {failure}")
