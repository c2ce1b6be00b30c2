#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Measures relocalize and merge on real maps, and writes the tables as Markdown.

usage: measure_sessions.py [--program build/cartographer_sdf] [--data ../shared/data]
                           [--work DIRECTORY] [--output FILE] [--threads N] [PART ...]

Parts: whole, merges, windows, buildings, halves, twins, sessions; all if none is named.
What the directory of --work holds already is not measured again. The maps are no
part of the project; see CONTRIBUTING.md.
"""

import argparse
import csv
import json
import math
import os
import pathlib
import platform
import subprocess
import sys
import tempfile

from measuring import compose, inverse

HERE = pathlib.Path(__file__).resolve().parent
# Wrong: a pose that is off by more where the submaps meet.
WRONG_METERS, WRONG_DEGREES = 1., 10.
NUM_STARTS = 20
# Maps that show the same building, or two that look alike; each pair is asked in both orders.
PAIRS = [("willow_1", "willow_2"), ("tsc_2016", "tsc_2017"), ("labc_bare1", "labc_furn"),
         ("labc_bare1", "labc_d3a"), ("labc_furn", "labc_d3a"), ("fhw_1", "fhw_2"),
         ("officec_R", "officec_L"), ("field/twins3_1", "field/twins3_2"),
         ("field/floor_4", "field/floor_6"), ("tinyslam_exp1", "tinyslam_exp2"),
         ("tinyslam_exp1", "tinyslam_exp3"), ("tinyslam_exp1", "tinyslam_exp4"),
         ("tinyslam_exp2", "tinyslam_exp3"), ("tinyslam_exp3", "tinyslam_exp4"),
         ("field/hall_office_1", "field/hall_office_2"),
         ("field/hall_office_1", "field/hall_office_3"),
         ("field/hall_office_2", "field/hall_office_3"), ("field/track_hall_1", "field/track_hall_2"),
         ("field/track_moved_1", "field/track_moved_2"), ("field/arena_2", "user_map_arena"),
         ("field/bare_corner", "field/hall_office_2"), ("field/bare_corner", "field/arena_2"),
         ("field/cells_10cm", "field/cells_20cm")]
MERGES = [("tsc_2016", "tsc_2017"), ("labc_bare1", "labc_d3a"), ("fhw_1", "fhw_2"),
          ("field/hall_office_1", "field/hall_office_2", "field/hall_office_3"),
          ("field/track_hall_1", "field/track_hall_2"),
          ("field/track_moved_1", "field/track_moved_2"),
          ("tinyslam_exp1", "tinyslam_exp2", "tinyslam_exp3", "tinyslam_exp4"),
          ("officec_R", "officec_L"), ("officec_L", "officec_R"),
          ("field/arena_2", "field/bare_corner"), ("field/bare_corner", "field/arena_2")]


def read_truth(path):
    """(kind, index) -> pose in the world; the maps have one trajectory each."""
    with open(path, newline="") as stream:
        return {(row["kind"], int(row["index"])): tuple(float(row[k]) for k in ("x", "y", "yaw"))
                for row in csv.DictReader(stream)}


def quantile(values, fraction):
    values = sorted(values)
    return values[min(len(values) - 1, int(fraction * len(values)))] if values else float("nan")


class Measurement:
    def __init__(self, arguments):
        self.program, self.data = arguments.program, pathlib.Path(arguments.data)
        self.work, self.threads = pathlib.Path(arguments.work), arguments.threads
        self.lines = []

    def say(self, line=""):
        self.lines.append(line)
        print(line, flush=True)

    def map(self, name):
        made = self.work / (name + ".pbstream")
        return str(made if made.exists() else self.data / (name + ".pbstream"))

    def truth(self, name):
        return read_truth(self.data / (name + ".truth.csv"))

    def has_truth(self, *names):
        return all((self.data / (name + ".truth.csv")).exists() for name in names)

    def run(self, *arguments, may_fail=False):
        done = subprocess.run([self.program, *arguments, "--threads", str(self.threads)],
                              capture_output=True, text=True)
        if done.returncode != 0 and not may_fail:
            sys.exit("%s: %s" % (" ".join(arguments), done.stderr.strip()))
        return done

    def relocalize(self, map_name, query_name, *more):
        name = "_".join([map_name, query_name] + [m.strip("-") for m in more]).replace("/", "_")
        result = self.work / (name + ".json")
        if not result.exists():
            self.run("relocalize", "--map", self.map(map_name), "--query", self.map(query_name),
                     "--places", str(self.work / (map_name.replace("/", "_") + ".places")),
                     "--result", str(result), *more)
        return json.loads(result.read_text())

    def errors(self, result, reference_truth, query_truth, kind):
        """Of the agreeing matches: metres and degrees where the submaps meet."""
        errors = []
        for closure in result["closures"]:
            reference = reference_truth.get(("submap", closure["reference_index"]))
            query = query_truth.get((kind, closure["query_index"]))
            if reference is None or query is None:
                continue
            found = closure["x"], closure["y"], closure["yaw"]
            error = compose(inverse(compose(inverse(reference), query)), found)
            errors.append((math.hypot(error[0], error[1]),
                           abs(math.degrees(math.remainder(error[2], 2 * math.pi)))))
        return errors


def is_wrong(errors):
    """Whether an answer is: its typical match is."""
    return bool(errors) and (quantile([e[0] for e in errors], 0.5) > WRONG_METERS or
                             quantile([e[1] for e in errors], 0.5) > WRONG_DEGREES)


def measure_whole(m):
    m.say("## Whole sessions\n")
    m.say("`relocalize --map A --query B`. Errors are those of the agreeing matches against the truth, in the "
          "query submap's frame, where both maps have one.\n")
    m.say("| query in map | answer | pose [m, deg] | agreeing | contradicting | score | runner-up "
          "| error: median | 90 % | max | ms after loading |")
    m.say("| --- " * 11 + "|")
    for reference, query in [pair for a, b in PAIRS for pair in ((a, b), (b, a))]:
        result = m.relocalize(reference, query)
        errors = []
        if m.has_truth(reference, query):
            errors = m.errors(result, m.truth(reference), m.truth(query), "submap")
        meters, degrees = [e[0] for e in errors], [e[1] for e in errors]
        answer, pose = result["verdict"], ""
        if result["localized"]:
            answer = "WRONG" if is_wrong(errors) else "right" if errors else "no truth"
            pose = "%.2f, %.2f, %.1f" % (result["T_map_query"]["x"], result["T_map_query"]["y"],
                                         math.degrees(result["T_map_query"]["yaw"]))
        quantiles = ["%.3f m, %.2f deg" % (quantile(meters, q), quantile(degrees, q))
                     if errors and result["localized"] else "" for q in (0.5, 0.9, 1.)]
        scores = ["" if result[name] is None else "%.1f" % result[name]
                  for name in ("score", "runner_up_score")]
        m.say("| %s in %s | %s | %s | %d | %d | %s | %s | %.0f |" % (
            query, reference, answer, pose, result["agreeing"], result["contradicting"],
            " | ".join(scores), " | ".join(quantiles), sum(result["milliseconds"].values())))
    m.say()


def measure_merges(m):
    m.say("## Merges\n")
    m.say("| maps | merged | left out | contradicting of overlapping pairs |")
    m.say("| --- | --- | --- | --- |")
    for names in MERGES:
        result = m.work / ("merge_" + "_".join(names).replace("/", "_") + ".json")
        m.run("merge", "--inputs", ",".join(map(m.map, names)), "--output",
              str(m.work / "merged.pbstream"), "--result", str(result), may_fail=True)
        found = json.loads(result.read_text())
        left_out = [name for name, session in zip(names, found["sessions"]) if session["left_out"]]
        m.say("| %s | %s | %s | %d of %d |" % (
            ", ".join(names), "yes" if found["merged"] else "no: " + found["reason"].replace(
                str(m.data) + "/", ""), ", ".join(left_out), found["contradicting_pairs"],
            found["overlapping_pairs"]))
    m.say()


def measure_windows_of(m, reference, query, seconds, truths, submap_map=None):
    results = m.relocalize(reference, query, "--first_seconds", str(seconds),
                           "--num_starts", str(NUM_STARTS))
    right, wrong, verdicts, errors, milliseconds = 0, 0, {}, [], []
    for entry in results["starts"]:
        result = entry["result"]
        milliseconds.append(sum(result["milliseconds"].values()))
        if not result["localized"]:
            verdicts[result["verdict"]] = verdicts.get(result["verdict"], 0) + 1
            continue
        own = m.errors(result, *truths, "node") if truths else []
        # Of different buildings every answer is wrong.
        if not truths or is_wrong(own):
            wrong += 1
        else:
            right += 1
            errors += own
    meters, degrees = [e[0] for e in errors], [e[1] for e in errors]
    refusals = ", ".join("%d %s" % (n, v) for v, n in sorted(verdicts.items()))
    m.say("| %s in %s | %d s | %d | %d | %s | %.3f m, %.2f deg | %.3f m, %.2f deg | %.0f |" % (
        query, reference, seconds, right, wrong, refusals or "none", quantile(meters, 0.5),
        quantile(degrees, 0.5), quantile(meters, 0.9), quantile(degrees, 0.9),
        quantile(milliseconds, 0.5)))


WINDOW_HEADER = ("| query in map | from | right | wrong | refused | error: median | 90 % | ms after loading |\n"
                 "| --- | --- | --- | --- | --- | --- | --- | --- |")


def measure_windows(m):
    m.say("## The first seconds\n")
    m.say("`relocalize --first_seconds N --num_starts %d`: places made of the scans of that many windows, evenly "
          "spaced.\n" % NUM_STARTS)
    m.say(WINDOW_HEADER)
    for reference, query in (("willow_1", "willow_2"), ("willow_2", "willow_1")):
        for seconds in (30, 60, 120):
            measure_windows_of(m, reference, query, seconds, (m.truth(reference), m.truth(query)))
    m.say()


def measure_buildings(m):
    m.say("## Different buildings\n")
    m.say("Whole maps, and windows of 30 s and 120 s. Every answer but a refusal is wrong.\n")
    m.say("| query in map | verdict | score | reason |")
    m.say("| --- | --- | --- | --- |")
    names = ["intel_open_loop", "aces_open_loop", "mit_killian_open_loop", "willow_1", "user_map_arena",
             "user_map_two_sessions", "user_map_odometry"]
    wrong = 0
    for k, reference in enumerate(names):
        for query in names[k + 1:]:
            result = m.relocalize(reference, query)
            wrong += result["localized"]
            m.say("| %s in %s | %s%s | %s | %s |" % (
                query, reference, "WRONG: " if result["localized"] else "", result["verdict"],
                result["score"], result["reason"]))
    m.say("\n%d wrong answers.\n" % wrong)
    m.say(WINDOW_HEADER)
    for reference, query in (("mit_killian_open_loop", "willow_2"), ("mit_killian_open_loop", "intel_open_loop"),
                             ("mit_killian_open_loop", "aces_open_loop"), ("intel_open_loop", "willow_2"),
                             ("willow_1", "aces_open_loop"), ("aces_open_loop", "willow_2")):
        for seconds in (30, 120):
            measure_windows_of(m, reference, query, seconds, None)
    m.say()


def split(m, name, at, turn):
    """Halves by time; the truth of the merged map; its path."""
    first, second = m.work / (name + "_first.pbstream"), m.work / (name + "_second.pbstream")
    done = subprocess.run([sys.executable, str(HERE / "split_map.py"), m.map(name), str(first), str(second),
                           "--at", str(at), "--turn", str(turn), "--shift", "12", "-5"],
                          check=True, capture_output=True, text=True)
    first_node = int(done.stdout.split(":")[1])
    rows = ["kind,trajectory,index,x,y,yaw"]
    stem = name.replace("_open_loop", "")
    for (kind, index), pose in m.truth(stem).items():
        boundary = at if kind == "submap" else first_node
        if (kind, index) != ("submap", at):
            rows.append("%s,%d,%d,%.9f,%.9f,%.9f" % (kind, int(index >= boundary), index, *pose))
    truth = m.work / (name + "_halves.truth.csv")
    truth.write_text("\n".join(rows) + "\n")
    return first, second, truth


def measure_halves(m):
    m.say("## A map cut in halves by time, one turned, merged again\n")
    m.say("`split_map.py --at N --turn DEGREES`, `merge`, `evaluate`. Node poses against the truth after a rigid "
          "alignment.\n")
    for name, at, turn in (("intel_open_loop", 48, 77.3), ("intel_open_loop", 30, -151.9)):
        first, second, truth = split(m, name, at, turn)
        for inputs in ((first, second), (second, first)):
            merged = m.work / "merged.pbstream"
            # The truth's trajectories are those of the first order.
            done = m.run("merge", "--inputs", ",".join(map(str, inputs)), "--output", str(merged),
                         may_fail=True)
            m.say("%s, cut at submap %d, turned by %.1f degrees, %s first:\n" % (
                name, at, turn, "the first half" if inputs[0] == first else "the second half"))
            m.say("```\n%s%s" % (done.stdout.replace(str(m.work) + "/", ""), done.stderr))
            if done.returncode == 0:
                own_truth = truth
                if inputs[0] != first:
                    swapped = []
                    for row in truth.read_text().splitlines():
                        cells = row.split(",")
                        if cells[1] in "01":
                            cells[1] = str(1 - int(cells[1]))
                        swapped.append(",".join(cells))
                    own_truth = m.work / "swapped.truth.csv"
                    own_truth.write_text("\n".join(swapped) + "\n")
                done = subprocess.run([m.program, "evaluate", "--input", str(merged), "--truth",
                                       str(own_truth)], capture_output=True, text=True)
                m.say(done.stdout + done.stderr)
            m.say("```\n")


def measure_twins(m):
    m.say("## A building of look-alikes\n")
    m.say("MIT Killian Court cut in halves by time: its second half in the first, windows. Where the second half "
          "leads to new corridors, look-alikes tempt.\n")
    name, at = "mit_killian_open_loop", 71
    first, second, _ = split(m, name, at, 123.4)
    m.say(WINDOW_HEADER)
    truth = m.truth("mit_killian")
    for seconds in (30, 60, 120):
        measure_windows_of(m, first.stem, second.stem, seconds, (truth, truth))
    m.say()


def measure_sessions(m):
    m.say("## user_map_two_sessions, separated and merged again\n")
    first, second = m.work / "sessions_0.pbstream", m.work / "sessions_1.pbstream"
    subprocess.run([sys.executable, str(HERE / "split_map.py"), m.map("user_map_two_sessions"), str(first),
                    str(second), "--trajectories", "0", "1", "--turn", "77.3", "--shift", "12", "-5"],
                   check=True)
    done = m.run("merge", "--inputs", "%s,%s" % (first, second), "--output",
                 str(m.work / "sessions.pbstream"), may_fail=True)
    m.say("```\n%s%s```\n" % (done.stdout.replace(str(m.work) + "/", ""), done.stderr))


PARTS = {"whole": measure_whole, "merges": measure_merges, "windows": measure_windows, "buildings": measure_buildings,
         "halves": measure_halves, "twins": measure_twins, "sessions": measure_sessions}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART")
    parser.add_argument("--program", default=str(HERE.parent / "build" / "cartographer_sdf"))
    parser.add_argument("--data", default=str(HERE.parent.parent / "shared" / "data"))
    parser.add_argument("--work")
    parser.add_argument("--output")
    parser.add_argument("--threads", type=int, default=0)
    arguments = parser.parse_args()
    unknown = set(arguments.parts) - set(PARTS)
    if unknown:
        parser.error("no part: " + ", ".join(sorted(unknown)))
    with tempfile.TemporaryDirectory() as temporary:
        arguments.work = arguments.work or temporary
        os.makedirs(arguments.work, exist_ok=True)
        m = Measurement(arguments)
        commit = subprocess.run(["git", "-C", str(HERE), "rev-parse", "--short", "HEAD"],
                                capture_output=True, text=True).stdout.strip()
        m.say("# Sessions: relocalise and merge\n")
        m.say("Made by `scripts/measure_sessions.py` at commit %s, %s, %d processors.\n" % (
            commit, platform.machine(), os.cpu_count()))
        for name in arguments.parts or PARTS:
            PARTS[name](m)
        if arguments.output:
            pathlib.Path(arguments.output).write_text("\n".join(m.lines))
    return 0


if __name__ == "__main__":
    sys.exit(main())
