#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Measures audit: how many wrong constraints it finds, and how many right ones it doubts.

Good maps (close_loops of the open loop ones, the stock one, simulated ones) are
spoilt by falsify with wrong constraints of each kind, and audited. What is right
is told by falsify for what it added, and by the true poses for what was there: a
constraint puts its node less than 0.5 m from the truth (right) or more than 1 m or
10 degrees (wrong). Writes docs/results/audit.md.

usage: measure_audit.py [--build DIR] [--data DIR] [--work DIR] [--maps NAME,...] [--output FILE]
"""

import argparse
import collections
import datetime
import math
import pathlib
import resource
import subprocess
import sys

from measuring import (DATA_DIR, SOURCE_DIR, commit_name, compose, inverse,
                       read_csv)

KINDS = ["corridor", "door", "half_turn", "twin", "row", "random"]
# Pairs of submaps of each kind, and seeds.
RUNS = [(1, 1), (1, 2), (4, 1), (10, 1)]
RIGHT_METERS, WRONG_METERS, WRONG_RADIANS = 0.5, 1.0, math.radians(10.0)
# Name, map to start from, truth, whether its loops are to be closed first.
MAPS = {
    "intel": ("intel_stock.pbstream", "intel.truth.csv", False),
    "aces": ("aces_open_loop.pbstream", "aces.truth.csv", True),
    "killian": ("mit_killian_open_loop.pbstream", "mit_killian.truth.csv", True),
    "willow_1": ("willow_1.pbstream", "willow_1.truth.csv", True),
    "willow_2": ("willow_2.pbstream", "willow_2.truth.csv", True),
    "office_1": (None, None, True),
    "office_2": (None, None, True),
}
USER_MAPS = ["user_map_arena", "user_map_odometry", "user_map_two_sessions"]


def angle(a):
    return abs(math.atan2(math.sin(a), math.cos(a)))


def read_truth(path):
    """Poses by (kind, trajectory, index)."""
    return {(row["kind"], int(row["trajectory"]), int(row["index"])):
            (float(row["x"]), float(row["y"]), float(row["yaw"])) for row in read_csv(path)}


def label(row, truth):
    """right, near, wrong, or None where there is no truth.

    The position of the node is that of its constraint whatever its gravity
    alignment; its rotation is that of the group's submaps.
    """
    def pose(kind, prefix):
        if not row[prefix + "_index"]:
            return None
        return truth.get((kind, int(row[prefix + "_trajectory"]), int(row[prefix + "_index"])))
    submap, node = pose("submap", "submap"), pose("node", "node")
    reference, query = pose("submap", "reference"), pose("submap", "query")
    if None in (submap, node, reference, query):
        return None
    true = compose(inverse(submap), node)
    distance = math.hypot(true[0] - float(row["x"]), true[1] - float(row["y"]))
    turn = angle(query[2] - reference[2] - float(row["group_yaw"]))
    if distance > WRONG_METERS or turn > WRONG_RADIANS:
        return "wrong"
    return "right" if distance < RIGHT_METERS else "near"


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Program:
    def __init__(self, path):
        self.path = path

    def __call__(self, *arguments):
        began = processor_seconds()
        result = subprocess.run([self.path, *map(str, arguments)], capture_output=True, text=True,
                                check=False)
        if result.returncode != 0:
            sys.exit(f"{' '.join(map(str, arguments))}: {result.stderr}")
        return result.stdout, processor_seconds() - began


def node_error(program, map_path, truth_path, work):
    """Mean error of the nodes after a rigid alignment [m]."""
    table = work / "nodes.csv"
    program("evaluate", "--input", map_path, "--truth", truth_path, "--csv", table)
    for line in table.read_text(encoding="utf-8").splitlines():
        if line.startswith("nodes,mean_m,"):
            return float(line.split(",")[2])
    return None


def audit(program, map_path, work):
    output, table = work / "audited.pbstream", work / "constraints.csv"
    text, seconds = program("audit", "--input", map_path, "--output", output, "--constraints", table)
    return read_csv(table), output, text, seconds


def base_map(program, name, data, work):
    """The good map and its truth; none where the data are missing."""
    source, truth, close = MAPS[name]
    if source is None:
        source, truth = work / f"{name}.open.pbstream", work / f"{name}.truth.csv"
        program("simulate", "--output", source, "--truth", truth, "--seed", name[-1], "--plan_seed",
                name[-1])
    else:
        source, truth = data / source, data / truth
    if not source.is_file() or not truth.is_file():
        return None
    if not close:
        return source, truth
    closed = work / f"{name}.closed.pbstream"
    if not closed.is_file():
        program("close_loops", "--input", source, "--output", closed)
    return closed, truth


def ratio(part, whole):
    return f"{part} of {whole}" if whole else "-"


def measure(program, name, data, work, report):
    base = base_map(program, name, data, work)
    if base is None:
        report["skipped"].append(name)
        return
    map_path, truth_path = base
    truth = read_truth(truth_path)
    rows, audited, _, seconds = audit(program, map_path, work)
    clean = collections.Counter((label(row, truth), row["doubtful"] == "1") for row in rows)
    verdicts = collections.Counter(row["verdict"] for row in rows if row["doubtful"] == "1")
    good_error = node_error(program, map_path, truth_path, work)
    def cell(kind):
        return ratio(clean[(kind, True)], clean[(kind, True)] + clean[(kind, False)])
    report["clean"].append(
        f"| {name} | {len(rows)} | {cell('right')} | {cell('near')} | {cell('wrong')} | "
        f"{cell(None)} | {', '.join(f'{v} {k}' for k, v in sorted(verdicts.items())) or '-'} | "
        f"{good_error:.3f} | {node_error(program, audited, truth_path, work):.3f} | "
        f"{seconds:.0f} |")
    doubted_before = {int(row["constraint"]) for row in rows if row["doubtful"] == "1"}
    for pairs, seed in RUNS:
        spoilt, wrong_path = work / "spoilt.pbstream", work / "wrong.csv"
        program("falsify", "--input", map_path, "--output", spoilt, "--wrong_constraints",
                wrong_path, "--pairs", pairs, "--seed", seed)
        kinds = {int(row["constraint"]): row["kind"] for row in read_csv(wrong_path)}
        rows, audited, _, seconds = audit(program, spoilt, work)
        found, added = collections.Counter(), collections.Counter()
        right = newly_doubted = 0
        for row in rows:
            number = int(row["constraint"])
            doubtful = row["doubtful"] == "1"
            if number in kinds:
                added[kinds[number]] += 1
                found[kinds[number]] += doubtful
                if not doubtful:
                    report["missed"].append(
                        f"- {name}, {pairs} pairs, seed {seed}: {kinds[number]}, submaps "
                        f"{row['reference_index']} and {row['query_index']}, {row['verdict']}; "
                        f"score {float(row['score']):.1f}, cycles for {float(row['support']):.0f}"
                        f" and against {float(row['contradiction']):.0f}, off by "
                        f"{float(row['error_after']):.2f} m from the audited map")
            elif label(row, truth) == "right":
                right += 1
                newly_doubted += doubtful and number not in doubted_before
        for kind in KINDS:
            report["kinds"][kind][0] += found[kind]
            report["kinds"][kind][1] += added[kind]
        total, hit = sum(added.values()), sum(found.values())
        report["totals"] += collections.Counter(found=hit, added=total, newly=newly_doubted)
        precision = hit / (hit + newly_doubted) if hit + newly_doubted else 1.0
        report["spoilt"].append(
            f"| {name} | {pairs}, {seed} | {total} | {hit / total if total else 1.0:.3f} | "
            + " | ".join(f"{found[kind]}/{added[kind]}" for kind in KINDS)
            + f" | {newly_doubted} of {right} | {precision:.3f} | {good_error:.3f} | "
            f"{node_error(program, spoilt, truth_path, work):.3f} | "
            f"{node_error(program, audited, truth_path, work):.3f} | {seconds:.0f} |")
        print(report["spoilt"][-1], flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=pathlib.Path, default=SOURCE_DIR / "build")
    parser.add_argument("--data", type=pathlib.Path, default=DATA_DIR)
    parser.add_argument("--work", type=pathlib.Path, required=True,
                        help="directory for maps; closed ones that are there are used again")
    parser.add_argument("--maps", default=",".join(MAPS))
    today = datetime.date.today().isoformat()
    parser.add_argument("--output", type=pathlib.Path,
                        default=SOURCE_DIR / "docs/results/audit.md")
    arguments = parser.parse_args()
    program = Program(arguments.build / "cartographer_sdf")
    arguments.work.mkdir(parents=True, exist_ok=True)
    report = {"clean": [], "spoilt": [], "missed": [], "skipped": [], "user": [],
              "kinds": {kind: [0, 0] for kind in KINDS}, "totals": collections.Counter()}
    for name in arguments.maps.split(","):
        if name not in MAPS:
            parser.error(f"there is no map {name}")
        measure(program, name, arguments.data, arguments.work, report)
    for name in USER_MAPS:
        path = arguments.data / f"{name}.pbstream"
        if not path.is_file():
            report["skipped"].append(name)
            continue
        rows, _, _, seconds = audit(program, path, arguments.work)
        doubtful = sum(row["doubtful"] == "1" for row in rows)
        report["user"].append(f"| {name} | {len(rows)} | {doubtful} | {seconds:.0f} |")

    lines = [
        "# audit: wrong constraints found, right ones doubted", "",
        f"Made by `scripts/measure_audit.py` on {today}, commit {commit_name()}; options as shipped.",
        "Seconds are processor time of the whole process: what others do does not count.", "",
        "## Maps as they are", "",
        "Of the constraints that are right, near and wrong by the true poses, and without one: how "
        "many are doubted. Nodes: mean error [m] before and after.", "",
        "| map | constraints | right, doubted | near, doubted | wrong, doubted | no truth, doubted "
        "| verdicts | nodes before | after | CPU s |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |", *report["clean"], "",
        "Maps that users saved; without a truth:", "",
        "| map | constraints | doubted | CPU s |", "| --- | --- | --- | --- |", *report["user"], "",
        "## Maps with wrong constraints", "",
        "Per kind the wrong constraints that were found, of those that were added; then the right "
        "ones (by the truth) that are doubted now and were not before. Precision counts these. "
        "Nodes: mean error [m] of the map as it was, spoilt, and audited.", "",
        "| map | pairs per kind, seed | added | recall | " + " | ".join(KINDS)
        + " | right, newly doubted | precision | nodes good | spoilt | audited | CPU s |",
        "| --- | --- | --- | --- | " + "--- | " * len(KINDS) + "--- | --- | --- | --- | --- | --- |",
        *report["spoilt"], "",
        "| kind | found | added |", "| --- | --- | --- |",
        *(f"| {kind} | {found} | {added} |" for kind, (found, added) in report["kinds"].items()),
        f"| all | {report['totals']['found']} | {report['totals']['added']} |", "",
        f"{report['totals']['newly']} right constraints were doubted only because of wrong ones.",
        ""]
    if report["missed"]:
        lines += ["Missed:", "", *report["missed"], ""]
    if report["skipped"]:
        lines += ["Not there: " + ", ".join(report["skipped"]) + ".", ""]
    arguments.output.parent.mkdir(parents=True, exist_ok=True)
    arguments.output.write_text("\n".join(lines), encoding="utf-8")
    print(arguments.output)


if __name__ == "__main__":
    main()
