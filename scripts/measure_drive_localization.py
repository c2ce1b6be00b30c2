#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Measures relocalize --scan on beginnings of drives, and writes the tables as Markdown.

usage: measure_drive_localization.py [--program build/cartographer_sdf] [--data ../shared/data]
                                     [--work DIRECTORY] [--output FILE] [--starts N] [SET ...]

The sets are those of measure_scan_localization.py. A drive is the scans of a
map's nodes with the poses of local SLAM as odometry, for 10 s from each start.
What the directory of --work holds already is not measured again. The maps are
no part of the project; see CONTRIBUTING.md.
"""

import argparse
import json
import pathlib
import sys
import tempfile

import measure_scan_localization as scans
import measuring
import split_map

TICKS_PER_SECOND = 1e7
CHECKED_SECONDS = (5., 10.)


def node_times(path):
    """[(seconds since the first node with a scan, index)] of the nodes with scans."""
    times = []
    records = split_map.read_records(path)
    next(records)
    for record in records:
        (number, _, value), = split_map.fields(record)
        if number != split_map.NODE:
            continue
        node = split_map.fields(value)
        data = split_map.fields(split_map.get(node, 5, b""))
        if scans.decompress(split_map.get(data, 3, b"")):
            times.append((split_map.get(data, 1, 0),
                          split_map.read_id(split_map.get(node, 1, b""))[1]))
    times.sort()
    return [((t - times[0][0]) / TICKS_PER_SECOND, index) for t, index in times]


class Drives(scans.Measurement):
    def __init__(self, arguments):
        super().__init__(arguments)
        self.times_of = {}

    def localize_drives(self, s):
        name = s.name.replace(" ", "_").replace(",", "")
        result = self.work / ("%s.drive.%d.json" % (name, self.starts))
        if not result.exists():
            self.run("relocalize", "--map", self.map(s.map), "--scan", self.query(s.query)[0],
                     "--first_seconds", max(CHECKED_SECONDS), "--num_starts", self.starts,
                     "--result", result)
        return json.loads(result.read_text())["scans"]

    def times(self, s):
        path = self.query(s.query)[0]
        if path not in self.times_of:
            self.times_of[path] = node_times(path)
        return self.times_of[path]

    def first_scan_at(self, s, seconds):
        """When the first scan was taken from then on; a history counts from there."""
        return min(time for time, _ in self.times(s) if time > seconds - 1e-6)

    def node_at(self, s, seconds):
        """The index of the node whose scan was taken then."""
        return min(self.times(s), key=lambda entry: abs(entry[0] - seconds))[1]

    def right_poses_at(self, s, seconds):
        """None where the truth does not know."""
        if s.kind == "stranger":
            return []
        index = self.node_at(s, seconds)
        if index not in scans.read_truth_once(self.query(s.query)[1]):
            return None
        return self.right_poses(s, index)

    def was_in_map(self, s, seconds):
        index = self.node_at(s, seconds)
        return s.kind == "own" and self.is_in_map(s, index)


def pose(json_pose):
    return scans.pose_of({"T_map_robot": json_pose})


def judge_step(measurement, s, start, step):
    """What is right of a step: (located, answer is right, answer is wrong, best candidate is right);
    None where the truth does not know."""
    poses = measurement.right_poses_at(s, start + step["seconds"])
    if poses is None:
        return None
    located = step["T_map_robot"] is not None
    best = step["T_map_robot"] or step["best_T_map_robot"]
    is_right = lambda p: p is not None and scans.is_right({"T_map_robot": p}, poses)
    is_wrong = lambda p: p is not None and scans.is_wrong({"T_map_robot": p}, poses)
    return located, located and is_right(best), located and is_wrong(best), is_right(best)


def judge_drive(measurement, s, result):
    """{seconds: (certain and right, ever certain and wrong, best right, CPU [ms], metres, in the map)}"""
    start = measurement.first_scan_at(s, result["start_seconds"])
    judged, last, wrong = {}, None, False
    steps = list(result["history"])
    for limit in CHECKED_SECONDS:
        while steps and steps[0]["seconds"] <= limit:
            step = steps.pop(0)
            rights = judge_step(measurement, s, start, step)
            if rights is None:
                continue
            wrong = wrong or rights[2]
            last = (rights, step)
        if last is not None:
            rights, step = last
            judged[limit] = (rights[1] and not wrong, wrong, rights[3], step["cpu_milliseconds"],
                             step["meters"], measurement.was_in_map(s, start + step["seconds"]))
    return judged


def located_after(results):
    """Median seconds and metres of the drives that were located."""
    first = [next((h for h in r["history"] if h["state"] == "located"), None) for r in results]
    first = [h for h in first if h is not None]
    return (scans.median([h["seconds"] for h in first]), scans.median([h["meters"] for h in first]))


def own_table(measurement, judged, limit):
    lines = ["| drives in map | starts | certain and right | certain and wrong | best candidate right "
             "| in the map | of these: certain and right | best candidate right "
             "| driven, median [m] | CPU median [ms] |",
             "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    table = []
    for s, results in judged:
        rows = [d[limit] for d in (judge_drive(measurement, s, r) for r in results) if limit in d]
        count = len(rows)
        if not count:
            continue
        right = sum(r[0] for r in rows) / count
        inside = [r for r in rows if r[5]]
        table.append((right, "| %s | %d | %s | %d | %s | %d | %s | %s | %.1f | %.0f |" % (
            s.name, count, scans.fraction(rows, lambda r: r[0]), sum(r[1] for r in rows),
            scans.fraction(rows, lambda r: r[2]), len(inside), scans.fraction(inside, lambda r: r[0]),
            scans.fraction(inside, lambda r: r[2]),
            scans.median([r[4] for r in rows]), scans.median([r[3] for r in rows]))))
    return lines + [line for _, line in sorted(table)] + [""]


def certain_table(judged, name):
    """Of drives that must not be certain."""
    lines = ["| %s | starts | certain | most certain | CPU median [ms] |" % name,
             "| --- | --- | --- | --- | --- |"]
    table = []
    for s, results in judged:
        steps = [h for r in results for h in r["history"]]
        most = max((h["best_probability"] or 0. for h in steps), default=0.)
        certain = sum(any(h["state"] == "located" for h in r["history"]) for r in results)
        table.append((-certain, -most, "| %s | %d | %d | %.3f | %.0f |" % (
            s.name, len(results), certain, most,
            scans.median([r["cpu_milliseconds"] for r in results]))))
    return lines + [line for _, _, line in sorted(table)] + [""]


def report(arguments, judged, measurement):
    of = lambda sets: [(s, results) for s, results in judged if s in sets]
    lines = ["# Localising a robot that drives\n",
             "Where in a map is a robot, by its scans and odometry while it drives "
             "([guide](../scan_localization.md))? Written by\n", "```sh",
             "scripts/measure_drive_localization.py --starts %d" % arguments.starts, "```\n",
             "at commit %s on %s, one thread. CPU times are those of all scans so far after loading the map; "
             "other programs ran beside it. Right is a pose within 0.5 m and 10 degrees of the truth, wrong "
             "one beyond 1 m or 15 degrees; a drive counts as wrong if it ever was certain of a wrong pose. "
             "Every start counts, also where the map never was; in the map are the drives that end within %g m of "
             "a place from which the map was made.\n" % (
                 measuring.commit_name(), measuring.processor(), scans.IN_MAP_METERS)]
    for limit, target in zip(CHECKED_SECONDS, ("80 % certain and right, none wrong, best candidate 95 %, "
                                               "100 ms", "95 %, none, 99 %, 100 ms")):
        lines += ["## After %g s\n" % limit, "Target: %s.\n" % target]
        lines += own_table(measurement, of(scans.FULL), limit)
    lines += ["Of the drives that were located within 10 s, the median came after\n"]
    lines += ["- %s: %.1f s and %.1f m" % ((s.name,) + located_after(results))
              for s, results in of(scans.FULL)] + [""]
    if of(scans.SYMMETRIC):
        lines += ["## Symmetric buildings\n", "Target: none certain.\n"]
        lines += certain_table(of(scans.SYMMETRIC), "building")
    if of(scans.STRANGERS):
        lines += ["## Drives through other buildings\n", "Target: none certain, in 10 s.\n"]
        lines += certain_table(of(scans.STRANGERS), "drives in map")
    if of(scans.TWINS):
        lines += ["## Equal rooms of which the map has only one\n",
                  "Two parts of one building share no room, but their rooms are equal: all that is certain "
                  "is wrong.\n"]
        lines += certain_table(of(scans.TWINS), "drives in map")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=measuring.PROGRAM)
    parser.add_argument("--data", default=measuring.DATA_DIR)
    parser.add_argument("--work", default=pathlib.Path(tempfile.gettempdir()) / "scan_localization")
    parser.add_argument("--output")
    parser.add_argument("--starts", type=int, default=100)
    parser.add_argument("sets", nargs="*", metavar="SET", help="beginnings of names of sets; all if none")
    arguments = parser.parse_args()
    pathlib.Path(arguments.work).mkdir(parents=True, exist_ok=True)
    measurement = Drives(arguments)
    # Narrow scans are cut for measure_scan_localization.py alone.
    sets = [s for s in scans.FULL + scans.SYMMETRIC + scans.STRANGERS + scans.TWINS if s.degrees == 360.]
    try:
        measuring.check_program(arguments.program)
        judged = []
        for s in sets:
            if arguments.sets and not s.name.startswith(tuple(arguments.sets)):
                continue
            judged.append((s, measurement.localize_drives(s)))
            print("%s: %d located" % (s.name, sum(r["localized"] for r in judged[-1][1])), flush=True)
    except measuring.Failure as failure:
        sys.exit("measure_drive_localization.py: %s" % failure)
    text = "\n".join(report(arguments, judged, measurement))
    if arguments.output:
        pathlib.Path(arguments.output).write_text(text)
    else:
        print(text)


if __name__ == "__main__":
    main()
