#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Measures relocalize --scan on real maps, and writes the tables as Markdown.

usage: measure_scan_localization.py [--program build/cartographer_sdf] [--data ../shared/data]
                                    [--work DIRECTORY] [--output FILE] [--starts N] [SET ...]
       measure_scan_localization.py --learn [...]

Each start is a single scan, cut from a node of a query: at most as wide and as
far as the set says. Maps get their loops closed first. What the directory of
--work holds already is not measured again. --learn prints the weights of the
probabilities that fit the measured scans best (needs numpy). The maps are no
part of the project; see CONTRIBUTING.md.
"""

import argparse
import collections
import json
import math
import pathlib
import subprocess
import sys
import tempfile

import measuring
import split_map
from measuring import compose, inverse

# Right, and wrong: a pose that is off by more. Between lies what maps bend.
RIGHT_METERS, RIGHT_DEGREES, WRONG_METERS, WRONG_DEGREES = .5, 10., 1., 15.
MIN_POINTS = 20
IN_MAP_METERS = 2.
CERTAIN = .99

# kind is "own" (its own building), "stranger" (another one) or "symmetric".
Set = collections.namedtuple("Set", "name map query kind degrees range", defaults=("own", 360., 1e3))

FULL = [
    Set("willow_2 in willow_1", "willow_1", "willow_2"),
    Set("willow_1 in willow_2", "willow_2", "willow_1"),
    Set("intel, 2nd half in 1st", "intel.a", "intel.b"),
    Set("intel, 1st half in 2nd", "intel.b", "intel.a"),
    Set("killian, 2nd half in 1st", "killian.a", "killian.b"),
    Set("killian, 1st half in 2nd", "killian.b", "killian.a"),
    Set("tsc_2017 in tsc_2016", "tsc_2016", "tsc_2017"),
    Set("labc_furn in labc_bare1", "labc_bare1", "labc_furn"),
    Set("labc_d3a in labc_bare1", "labc_bare1", "labc_d3a"),
    Set("fhw_2 in fhw_1", "fhw_1", "fhw_2"),
]
NARROW = [s._replace(name=s.name + ", 180 degrees, 8 m", degrees=180., range=8.)
          for s in FULL if s.name.startswith(("willow", "tsc", "labc_furn"))]
SYMMETRIC = [Set("two-fold ring", "two_fold", "two_fold_drive", "symmetric"),
             Set("four-fold ring", "four_fold", "four_fold_drive", "symmetric")]
STRANGERS = [Set("%s in %s" % (q, m), m, q, "stranger") for q, m in (
    ("willow_2", "intel.a"), ("willow_2", "tsc_2016"), ("willow_2", "killian"),
    ("willow_2", "labc_bare1"), ("willow_1", "fhw_1"), ("willow_1", "aces"),
    ("intel", "willow_1"), ("intel", "tsc_2016"), ("intel", "killian"),
    ("killian", "willow_1"), ("killian", "aces"), ("killian", "intel"),
    ("aces", "killian"), ("aces", "willow_1"), ("labc_furn", "willow_1"),
    ("labc_d3a", "tsc_2016"), ("tsc_2017", "willow_2"), ("tsc_2017", "labc_bare1"),
    ("fr079", "intel"), ("fr079", "willow_1"))]
STRANGERS += [Set(s.name + ", 180 degrees, 8 m", s.map, s.query, s.kind, 180., 8.)
              for s in STRANGERS[:2]]
LARGE = [Set("large office", "large_1", "large_2")]
TWINS = [Set("officec_L in officec_R", "officec_R", "officec_L", "stranger"),
         Set("officec_R in officec_L", "officec_L", "officec_R", "stranger")]
# name: (file, submap to split it at)
HALVES = {"intel": ("intel_open_loop", 48), "killian": ("mit_killian_open_loop", 70)}
FILES = {"intel": "intel_open_loop", "killian": "mit_killian_open_loop", "aces": "aces_open_loop"}
TRUTHS = {"intel.a": "intel", "intel.b": "intel", "killian.a": "mit_killian",
          "killian.b": "mit_killian"}
FOLDS = {"two_fold": 2, "four_fold": 4}
# Drives through a simulated office of 22,000 m2.
SIMULATED = {"large_%d" % seed: ("--plan_width", 200, "--plan_height", 110, "--length", length, "--seed", seed)
             for seed, length in ((1, 5000), (2, 600))}


def error(a, b):
    """Metres and degrees."""
    return (math.hypot(a[0] - b[0], a[1] - b[1]),
            abs(math.degrees(math.remainder(a[2] - b[2], 2 * math.pi))))


def read_truth(path):
    """index of a node -> pose in the world; the maps have one trajectory each."""
    return {int(row["index"]): tuple(float(row[k]) for k in ("x", "y", "yaw"))
            for row in measuring.read_csv(path) if row["kind"] == "node"}


# --- What a .pbstream says of nodes. ------------------------------------------
def yaw_of(quaternion):
    x, y, z, w = quaternion
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def planar(pose):
    contents = split_map.fields(pose)
    p = split_map.read_doubles(split_map.get(contents, 1, b""), 3)
    return p[0], p[1], yaw_of(split_map.read_doubles(split_map.get(contents, 2, b""), 4))


def signed(value):
    value &= 0xFFFFFFFF
    return value - (1 << 32) if value >= 1 << 31 else value


def decompress(cloud):
    """[(x, y)] of a CompressedPointCloud [m]."""
    data, at, values = split_map.get(split_map.fields(cloud), 3, b""), 0, []
    while at < len(data):
        value, at = split_map.read_varint(data, at)
        values.append(signed(value))
    points, k = [], 0
    while k < len(values):
        count, x, y = values[k:k + 3]
        for value in values[k + 4:k + 4 + count]:
            points.append((.001 * (x * 1024 + (value & 1023)),
                           .001 * (y * 1024 + (value >> 10 & 1023))))
        k += 4 + count
    return points


def read_nodes(path):
    """Poses of nodes in the map frame, and their clouds, both of the tracking frame."""
    records = split_map.read_records(path)
    next(records)
    poses, clouds = {}, {}
    for record in records:
        (number, _, value), = split_map.fields(record)
        if number == split_map.POSE_GRAPH:
            for n, _, trajectory in split_map.fields(value):
                if n != split_map.TRAJECTORY:
                    continue
                for kind, _, element in split_map.fields(trajectory):
                    if kind == 1:
                        node = split_map.fields(element)
                        poses[split_map.get(node, 7, 0)] = planar(split_map.get(node, 5, b""))
        elif number == split_map.NODE:
            node = split_map.fields(value)
            data = split_map.fields(split_map.get(node, 5, b""))
            yaw = yaw_of(split_map.read_doubles(split_map.get(data, 2, b""), 4))
            c, s = math.cos(yaw), math.sin(yaw)
            index = split_map.read_id(split_map.get(node, 1, b""))[1]
            clouds[index] = [(c * x + s * y, -s * x + c * y)
                             for x, y in decompress(split_map.get(data, 3, b""))]
    return poses, clouds


# --- Symmetric buildings. -----------------------------------------------------
def draw_plan(folds):
    """Rows of 0 (wall) and 254 (free), from the top: a ring corridor with rooms, which
    looks the same after each 1 / folds of a turn."""
    side = 520
    plan = [[0] * side for _ in range(side)]

    def turned(i, j, turns):
        for _ in range(turns):
            i, j = j, side - 1 - i
        return i, j

    def fill(value, x0, y0, x1, y1):
        for turn in range(0, 4, 4 // folds):
            for i in range(x0, x1):
                for j in range(y0, y1):
                    a, b = turned(i, j, turn)
                    plan[b][a] = value

    def side_of_ring(rooms, desk):
        fill(254, 110, 110, side - 110, 150)
        at = 114
        for k, width in enumerate(rooms):
            fill(254, at, 20, at + width, 104)
            fill(254, at + width // 3, 100, at + width // 3 + 18, 112)
            fill(0, at + 8 + 5 * k, 30, at + 8 + 5 * k + desk, 44)
            at += width + 4
    side_of_ring((60, 90, 70, 60), 22)
    if folds == 2:
        # The other two sides, which differ from the first.
        fill(254, 110, 110, 150, side - 110)
        fill(254, 20, 130, 104, 230)
        fill(254, 100, 170, 112, 188)
        fill(0, 40, 150, 60, 190)
        fill(254, 20, 250, 104, 400)
        fill(254, 100, 300, 112, 318)
    return plan


def write_plan(plan, path):
    with open(path.with_suffix(".pgm"), "wb") as stream:
        stream.write(b"P5\n%d %d\n255\n" % (len(plan[0]), len(plan)))
        for row in plan:
            stream.write(bytes(row))
    path.with_suffix(".yaml").write_text(
        "image: %s.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n" % path.name)


class Measurement:
    def __init__(self, arguments):
        self.program, self.data = arguments.program, pathlib.Path(arguments.data)
        self.work, self.starts = pathlib.Path(arguments.work), arguments.starts
        self.nodes_of = {}

    def run(self, *arguments):
        done = subprocess.run([str(a) for a in (self.program, *arguments)], capture_output=True,
                              text=True, check=False)
        if done.returncode != 0:
            raise measuring.Failure(done.stderr.strip())
        return done.stdout

    def made(self, name, suffix, make):
        path = self.work / (name + suffix)
        if not path.exists():
            print("making %s" % path.name, flush=True)
            make(path)
        return path

    def open(self, name):
        """The map as it was recorded."""
        if name not in SIMULATED:
            return self.data / (name + ".pbstream")
        return self.made(name, ".open.pbstream", lambda path: self.run(
            "simulate", *SIMULATED[name], "--output", path, "--truth", self.truth(name)))

    def truth(self, name):
        folder = self.work if name in SIMULATED else self.data
        return folder / (TRUTHS.get(name, name) + ".truth.csv")

    def closed(self, name):
        """The map with its loops closed."""
        return self.made(name, ".pbstream", lambda path: self.run(
            "close_loops", "--input", self.open(name), "--output", path))

    def half(self, name):
        whole, part = name.split(".")
        file, at = HALVES[whole]

        def make(_):
            halves = [self.work / ("%s.%s.pbstream" % (whole, k)) for k in "ab"]
            subprocess.run([sys.executable, measuring.SOURCE_DIR / "scripts" / "split_map.py",
                            self.closed(file), *halves, "--at", str(at)], check=True,
                           stdout=subprocess.DEVNULL)
        return self.made("%s.%s" % (whole, part), ".pbstream", make)

    def map(self, name):
        if name in FOLDS:
            return self.made(name, ".yaml",
                             lambda path: write_plan(draw_plan(FOLDS[name]), path.with_suffix("")))
        return self.half(name) if "." in name else self.closed(FILES.get(name, name))

    def query(self, name):
        """The map that scans are cut from, and its truth."""
        if name.endswith("_drive"):
            self.map(name[:-6])
            truth = self.work / (name + ".truth.csv")
            return self.made(name, ".pbstream", lambda path: self.run(
                "simulate", "--map", self.work / (name[:-6] + ".pgm"), "--output", path,
                "--truth", truth, "--lidar_range", 30)), truth
        path = self.half(name) if "." in name else self.open(FILES.get(name, name))
        return path, self.truth(name)

    def nodes(self, path):
        if path not in self.nodes_of:
            self.nodes_of[path] = read_nodes(path)
        return self.nodes_of[path]

    def scans(self, s):
        """index of a node -> points, of the starts of a set."""
        path, truth = self.query(s.query)
        known = read_truth(truth) if s.kind != "stranger" else None
        scans = {}
        for index, points in sorted(self.nodes(path)[1].items()):
            cut = [p for p in points if math.hypot(*p) <= s.range
                   and abs(math.atan2(p[1], p[0])) <= math.radians(s.degrees / 2)]
            if len(cut) >= MIN_POINTS and (known is None or index in known):
                scans[index] = cut
        indices = list(scans)
        count = min(self.starts, len(indices))
        return {indices[(2 * k + 1) * len(indices) // (2 * count)]:
                scans[indices[(2 * k + 1) * len(indices) // (2 * count)]] for k in range(count)}

    def localize(self, s):
        """[(index, result)]"""
        name = s.name.replace(" ", "_").replace(",", "")
        result = self.work / ("%s.%d.json" % (name, self.starts))
        if not result.exists():
            paths = []
            with tempfile.TemporaryDirectory() as directory:
                for index, points in self.scans(s).items():
                    paths.append(pathlib.Path(directory) / ("%d.json" % index))
                    paths[-1].write_text(json.dumps(
                        {"points": [[round(x, 4), round(y, 4)] for x, y in points]}))
                self.run("relocalize", "--map", self.map(s.map), "--scan",
                         ",".join(map(str, paths)), "--result", result)
        return [(int(pathlib.Path(r["scan"]).stem), r) for r in json.loads(result.read_text())["scans"]]

    def right_poses(self, s, index):
        """Where the node is in the map: one pose, or all that look the same."""
        world = read_truth_once(self.query(s.query)[1])[index]
        if s.kind == "symmetric":
            middle = (260 * .05, 260 * .05, 0.)
            turns = [(0., 0., 2 * math.pi * k / FOLDS[s.map]) for k in range(FOLDS[s.map])]
            return [compose(compose(middle, t), compose(inverse(middle), world)) for t in turns]
        poses, truth, nearest = self.nearest_node(s, world)
        return [compose(poses[nearest], compose(inverse(truth[nearest]), world))]

    def nearest_node(self, s, world):
        """(poses in the map, true poses, the index of the node of the map nearest to a true pose)"""
        truth = read_truth_once(self.truth(s.map))
        poses = self.nodes(self.map(s.map))[0]
        return poses, truth, min((i for i in poses if i in truth), key=lambda i: math.hypot(
            truth[i][0] - world[0], truth[i][1] - world[1]))

    def is_in_map(self, s, index):
        """Whether the robot that made the map came near the place of a node."""
        world = read_truth_once(self.query(s.query)[1])[index]
        _, truth, nearest = self.nearest_node(s, world)
        return math.hypot(truth[nearest][0] - world[0], truth[nearest][1] - world[1]) < IN_MAP_METERS


TRUTH_CACHE = {}


def read_truth_once(path):
    if path not in TRUTH_CACHE:
        TRUTH_CACHE[path] = read_truth(path)
    return TRUTH_CACHE[path]


def pose_of(candidate):
    return tuple(candidate["T_map_robot"][k] for k in ("x", "y", "yaw"))


def is_right(candidate, poses):
    return any(e[0] < RIGHT_METERS and e[1] < RIGHT_DEGREES
               for e in (error(pose_of(candidate), p) for p in poses))


def is_wrong(candidate, poses):
    return all(e[0] > WRONG_METERS or e[1] > WRONG_DEGREES
               for e in (error(pose_of(candidate), p) for p in poses))


def judge(measurement, s):
    """[(result, index of the first right candidate or None, whether the best is wrong)]"""
    rows = []
    for index, result in measurement.localize(s):
        candidates = result["candidates"]
        poses = [] if s.kind == "stranger" else measurement.right_poses(s, index)
        right = next((k for k, c in enumerate(candidates) if is_right(c, poses)), None)
        named = [any(is_right(c, [p]) for c in candidates) for p in poses]
        rows.append({"index": index, "result": result, "right": right,
                     "in_map": s.kind == "own" and measurement.is_in_map(s, index),
                     "wrong": bool(candidates) and is_wrong(candidates[0], poses),
                     "all_named": all(named)})
    return rows


def is_certain(row):
    return row["result"]["localized"]


def fraction(rows, test):
    return "%.0f %%" % (100. * sum(map(test, rows)) / len(rows)) if rows else "-"


def median(values):
    values = sorted(values)
    return values[len(values) // 2] if values else float("nan")


def verdicts(rows):
    counts = collections.Counter(row["result"]["verdict"] for row in rows)
    return ", ".join("%d %s" % (count, name) for name, count in counts.most_common())


def own_table(title, target, judged):
    lines = ["## %s\n" % title, "Target: %s.\n" % target,
             "| scans in map | starts | certain and right | certain and wrong | best candidate right "
             "| a candidate right | in the map | of these: certain and right | best candidate right "
             "| CPU median [ms] | verdicts |",
             "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    table = []
    for s, rows in judged:
        certain = [row for row in rows if is_certain(row)]
        inside = [row for row in rows if row["in_map"]]
        is_certain_and_right = lambda r: is_certain(r) and r["right"] == 0
        table.append((sum(row["right"] == 0 for row in certain) / max(1, len(rows)),
                      "| %s | %d | %s | %d | %s | %s | %d | %s | %s | %.0f | %s |" % (
                          s.name, len(rows), fraction(rows, is_certain_and_right),
                          sum(row["wrong"] for row in certain), fraction(rows, lambda r: r["right"] == 0),
                          fraction(rows, lambda r: r["right"] is not None), len(inside),
                          fraction(inside, is_certain_and_right), fraction(inside, lambda r: r["right"] == 0),
                          median([r["result"]["cpu_milliseconds"] for r in rows]), verdicts(rows))))
    return lines + [line for _, line in sorted(table)] + [""]


def symmetric_table(judged):
    lines = ["## Symmetric buildings\n",
             "Target: none certain, 99 % with a right candidate, 100 ms. All poses that look the same "
             "count as right.\n",
             "| building | starts | certain | a candidate right | all of them named | CPU median [ms] "
             "| verdicts |", "| --- | --- | --- | --- | --- | --- | --- |"]
    for s, rows in judged:
        lines.append("| %s | %d | %d | %s | %s | %.0f | %s |" % (
            s.name, len(rows), sum(map(is_certain, rows)),
            fraction(rows, lambda r: r["right"] is not None), fraction(rows, lambda r: r["all_named"]),
            median([r["result"]["cpu_milliseconds"] for r in rows]), verdicts(rows)))
    return lines + [""]


def stranger_table(title, text, judged):
    lines = ["## %s\n" % title, text + "\n",
             "| scans in map | starts | certain (all wrong) | most certain | verdicts |",
             "| --- | --- | --- | --- | --- |"]
    table = []
    for s, rows in judged:
        most = max((r["result"]["candidates"][0]["probability"] for r in rows
                    if r["result"]["candidates"]), default=0.)
        table.append((-most, "| %s | %d | %d | %.3f | %s |" % (
            s.name, len(rows), sum(map(is_certain, rows)), most, verdicts(rows))))
    return lines + [line for _, line in sorted(table)] + [""]


def reliability_table(judged):
    """Of the most probable candidates, symmetric buildings left out: there several are right."""
    edges = (0., .2, .5, .8, .95, .99, .999, 1.)
    lines = ["## Reliability\n",
             "Of the best candidate of each start above, how probable it was said to be, and how often it "
             "was right. Starts where it is off by 0.5 to 1 m are left out. Own: scans in their own building.\n",
             "| probability | own: starts | mean probability | right | with strangers: starts "
             "| mean probability | right |", "| --- | --- | --- | --- | --- | --- | --- |"]
    points = []
    for s, rows in judged:
        for row in rows:
            if s.kind == "symmetric" or not row["result"]["candidates"]:
                continue
            if row["right"] == 0 or row["wrong"]:
                points.append((row["result"]["candidates"][0]["probability"], row["right"] == 0,
                               s.kind == "own"))
    for low, high in zip(edges, edges[1:]):
        cells = []
        for chosen in ([p for p in points if p[2]], points):
            inside = [p for p in chosen if low <= p[0] < high or (high == 1. and p[0] == 1.)]
            cells += ["%d" % len(inside)] + (
                ["%.3f" % (sum(p[k] for p in inside) / len(inside)) for k in (0, 1)]
                if inside else ["-", "-"])
        lines.append("| [%g, %g) | %s |" % (low, high, " | ".join(cells)))
    return lines + [""]


# --- Learning. ----------------------------------------------------------------
def candidate_terms(c):
    return [c["fit"], c["at_wall"] - c["fit"], math.log(.03 + c["through_wall"]),
            math.log(.03 + c["in_free_space"]), c["in_unknown"]]


def presence_terms(candidates):
    best = candidates[0]
    chance = candidates[5]["fit"] if len(candidates) > 5 else .35
    return candidate_terms(best)[1:] + [best["beams"] / 360., best["fit"] - chance, 1.]


def learn(judged):
    """Maximum likelihood by Newton's method; each set counts the same."""
    import numpy as np
    samples = []
    for s, rows in judged:
        usable = [r for r in rows if len(r["result"]["candidates"]) > 0
                  and (r["right"] is not None or r["wrong"])]
        weight = 1. / max(1, len(usable))
        samples += [(r["result"]["candidates"], r["right"], weight) for r in usable]

    def descend(size, scale, derivatives):
        weights = np.zeros(size)
        for _ in range(60):
            gradient, hessian = derivatives(weights)
            gradient += 1e-4 * scale ** 2 * weights
            hessian += np.diag(1e-4 * scale ** 2 + 1e-9)
            step = np.linalg.solve(hessian, gradient)
            weights -= step * min(1., 5. / max(1e-9, np.abs(step * scale).max()))
        return weights

    chosen = [(np.array([candidate_terms(c) for c in cs]), right, w)
              for cs, right, w in samples if right is not None]
    total = sum(w for _, _, w in chosen)

    def candidate_derivatives(weights):
        gradient, hessian = np.zeros(5), np.zeros((5, 5))
        for terms, right, w in chosen:
            utility = terms @ weights
            p = np.exp(utility - utility.max())
            p /= p.sum()
            mean = p @ terms
            gradient += w / total * (mean - terms[right])
            hessian += w / total * ((terms - mean).T * p) @ (terms - mean)
        return gradient, hessian

    all_terms = np.concatenate([terms for terms, _, _ in chosen])
    candidate_weights = descend(5, all_terms.std(0), candidate_derivatives)
    ranked = [(sorted(cs, key=lambda c: -np.dot(candidate_terms(c), candidate_weights)), right, w)
              for cs, right, w in samples]
    terms = np.array([presence_terms(cs) for cs, _, _ in ranked])
    present = np.array([right is not None for _, right, _ in ranked], float)
    w = np.array([w for _, _, w in ranked])
    w /= w.sum()

    def presence_derivatives(weights):
        p = 1. / (1. + np.exp(-terms @ weights))
        return terms.T @ ((p - present) * w), (terms * (w * p * (1 - p))[:, None]).T @ terms

    scale = terms.std(0)
    presence_weights = descend(terms.shape[1], scale, presence_derivatives)
    for name, names, weights in (
            ("candidate_weights", "fit loose_fit log_through log_free in_unknown", candidate_weights),
            ("presence_weights", "loose_fit log_through log_free in_unknown num_beams lead bias",
             presence_weights)):
        print(name + ": " + ", ".join("%s = %.2f" % pair for pair in zip(names.split(), weights)))


def report(arguments, judged, measurement):
    by_kind = lambda sets: [(s, rows) for s, rows in judged if s in sets]
    lines = ["# Localising one scan\n",
             "Where in a map is a robot that stands still, by one scan ([guide](../scan_localization.md))? "
             "Written by\n", "```sh", "scripts/measure_scan_localization.py --starts %d" % arguments.starts,
             "```\n", "at commit %s on %s, one thread. CPU times are those of one scan after loading the map; "
             "other programs ran beside it. Right is a pose within 0.5 m and 10 degrees of the truth, wrong one "
             "beyond 1 m or 15 degrees. Every start counts, also where the map never was; in the map are those within "
             "%g m of a place from which the map was made.\n" % (
                 measuring.commit_name(), measuring.processor(), IN_MAP_METERS)]
    for title, target, sets in (
            ("One scan, as recorded", "50 % certain and right, none wrong, best candidate 85 %, 50 ms", FULL),
            ("One scan of 180 degrees and 8 m", "20 % certain and right, none wrong, best candidate 60 %, "
             "100 ms", NARROW),
            ("A simulated office of 22,000 m²", "as above", LARGE)):
        if by_kind(sets):
            lines += own_table(title, target, by_kind(sets))
    if by_kind(SYMMETRIC):
        lines += symmetric_table(by_kind(SYMMETRIC))
    if by_kind(STRANGERS):
        lines += stranger_table("Scans of other buildings", "Target: none certain; `nothing_alike` or "
                                "`uncertain`.", by_kind(STRANGERS))
    if by_kind(TWINS):
        lines += stranger_table(
            "Equal rooms of which the map has only one", "Two parts of one building share no room, but their "
            "rooms are equal: no single scan can tell. Left out of what was learned, and of the table below.",
            by_kind(TWINS))
    return lines + reliability_table([(s, rows) for s, rows in judged if s not in TWINS])


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=measuring.PROGRAM)
    parser.add_argument("--data", default=measuring.DATA_DIR)
    parser.add_argument("--work", default=pathlib.Path(tempfile.gettempdir()) / "scan_localization")
    parser.add_argument("--output")
    parser.add_argument("--starts", type=int, default=100)
    parser.add_argument("--learn", action="store_true")
    parser.add_argument("sets", nargs="*", metavar="SET", help="beginnings of names of sets; all but \"large office\", which takes long to make, if none")
    arguments = parser.parse_args()
    pathlib.Path(arguments.work).mkdir(parents=True, exist_ok=True)
    measurement = Measurement(arguments)
    try:
        measuring.check_program(arguments.program)
        judged = []
        sets = FULL + NARROW + SYMMETRIC + STRANGERS + TWINS
        if arguments.sets:
            sets = [s for s in sets + LARGE if s.name.startswith(tuple(arguments.sets))]
        for s in sets:
            print("%s: " % s.name, end="", flush=True)
            judged.append((s, judge(measurement, s)))
            print(verdicts(judged[-1][1]), flush=True)
    except measuring.Failure as failure:
        sys.exit("measure_scan_localization.py: %s" % failure)
    if arguments.learn:
        learn([(s, rows) for s, rows in judged if s not in TWINS])
        return
    text = "\n".join(report(arguments, judged, measurement))
    if arguments.output:
        pathlib.Path(arguments.output).write_text(text)
    else:
        print(text)


if __name__ == "__main__":
    main()
